#include "point_sieve.h"

#include <algorithm>
#include <cmath>

namespace ray::plain {
namespace {

constexpr float kNowhere = std::numeric_limits<float>::infinity();

void end_list(SievedPoints& near) {
  std::fill_n(near.distance2.begin() + static_cast<std::ptrdiff_t>(near.size), kSieveLanes, kNowhere);
}

}  // namespace

void sieve_box(const SieveSource& source, const SieveBox& box, SievePoints& points) {
  std::size_t size = points.size;
  for (std::uint32_t i = 0; i < source.count; ++i) {
    std::array<float, 3> at;
    float distance2 = 0.0F;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      at[axis] = static_cast<float>(source.columns[axis][source.first + i] - box.middle[axis]);
      const float outside = std::max(std::abs(at[axis]) - box.half[axis], 0.0F);
      distance2 += outside * outside;
    }
    points.x[size] = at[0];
    points.y[size] = at[1];
    points.z[size] = at[2];
    points.place[size] = source.first + i;
    size += distance2 <= box.within2 ? 1 : 0;
  }
  points.size = size;
}

bool sieve_sphere(const SievePoints& points, const SieveSphere& sphere, SievedPoints& near) {
  constexpr std::size_t kStep = 32;  // first the distances, which a compiler makes lanes of, then the choice
  const auto [x, y, z] = sphere.middle;
  const auto [side_x, side_y, side_z] = sphere.side;
  std::size_t size = 0;
  bool is_doubtful = false;
  for (std::size_t begin = 0; begin < points.size; begin += kStep) {
    const std::size_t count = std::min(kStep, points.size - begin);
    std::array<float, kStep> distance2, along;
    for (std::size_t i = 0; i < count; ++i) {
      const float dx = points.x[begin + i] - x, dy = points.y[begin + i] - y, dz = points.z[begin + i] - z;
      distance2[i] = dx * dx + dy * dy + dz * dz;
    }
    for (std::size_t i = 0; i < count && sphere.has_side; ++i)
      along[i] = side_x * points.to_sensor_x[begin + i] + side_y * points.to_sensor_y[begin + i] +
                 side_z * points.to_sensor_z[begin + i];
    for (std::size_t i = 0; i < count; ++i) {
      const std::uint32_t place = points.place[begin + i];
      near.distance2[size] = distance2[i];
      near.place[size] = place;
      bool is_near = distance2[i] <= sphere.within2 && place != sphere.self;
      if (sphere.has_side) {
        is_near = is_near && along[i] >= -sphere.doubt;
        is_doubtful = is_doubtful || (is_near && along[i] <= sphere.doubt);
      }
      size += is_near ? 1 : 0;
    }
  }
  near.size = size;
  end_list(near);
  return is_doubtful;
}

void sieve_body(const SievePoints& points, const SieveBody& body, SievedPoints& near) {
  const auto [x, y, z] = body.centre;
  const auto [xx, xy, xz, yy, yz, zz] = body.shape;
  std::size_t size = 0;
  for (std::size_t i = 0; i < points.size; ++i) {
    const float dx = points.x[i] - x, dy = points.y[i] - y, dz = points.z[i] - z;
    const float value = dx * (xx * dx + xy * dy + xz * dz) + dy * (xy * dx + yy * dy + yz * dz) +
                        dz * (xz * dx + yz * dy + zz * dz);
    const float wrong = body.rounding * (dx * dx + dy * dy + dz * dz);
    near.distance2[size] = value + wrong;
    near.place[size] = points.place[i];
    size += value - wrong <= body.most ? 1 : 0;
  }
  near.size = size;
  end_list(near);
}

std::size_t sieve_count(const SievedPoints& near, float distance2) {
  std::int32_t count = 0;
  for (std::size_t i = 0; i < near.size; ++i)
    count += near.distance2[i] <= distance2 ? 1 : 0;
  return static_cast<std::size_t>(count);
}

void sieve_further(SievedPoints& near, float distance2) {
  std::size_t size = 0;
  for (std::size_t i = 0; i < near.size; ++i) {
    const float d = near.distance2[i];
    near.distance2[size] = d;
    near.place[size] = near.place[i];
    size += d <= distance2 ? 1 : 0;
  }
  near.size = size;
  end_list(near);
}

float sieve_least_sum(const SievePoints& points, const std::array<float, 3>& middle, const float* values,
                      std::size_t count) {
  float least = kNowhere;
  for (std::size_t i = 0; i < count; ++i) {
    const float dx = points.x[i] - middle[0], dy = points.y[i] - middle[1], dz = points.z[i] - middle[2];
    least = std::min(least, std::sqrt(dx * dx + dy * dy + dz * dz) + values[i]);
  }
  return least;
}

}  // namespace ray::plain
