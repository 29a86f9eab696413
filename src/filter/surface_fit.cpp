#include "surface_fit.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <utility>

namespace ray {

/// Into the columns, from `at` on.
inline void SurfaceFit::take_some(std::span<const std::uint32_t, kAtOnce> places,
                                  const Eigen::Vector3d& point, std::size_t at) {
  using Floats [[gnu::vector_size(kAtOnce * sizeof(float))]] = float;
  const LocalPlane &a = planes_[places[0]], &b = planes_[places[1]], &c = planes_[places[2]],
                   &d = planes_[places[3]];
  const auto normal_and_height = [](const LocalPlane& plane) {
    static_assert(offsetof(LocalPlane, normal) == 0 && offsetof(LocalPlane, height) == 3 * sizeof(float));
    Floats values;
    std::memcpy(&values, &plane, sizeof(values));
    return values;
  };
  const Floats row_a = normal_and_height(a), row_b = normal_and_height(b), row_c = normal_and_height(c),
               row_d = normal_and_height(d);
  const Floats xy_ab = __builtin_shufflevector(row_a, row_b, 0, 4, 1, 5),
               xy_cd = __builtin_shufflevector(row_c, row_d, 0, 4, 1, 5),
               zh_ab = __builtin_shufflevector(row_a, row_b, 2, 6, 3, 7),
               zh_cd = __builtin_shufflevector(row_c, row_d, 2, 6, 3, 7);
  const Floats spread2{a.spread2, b.spread2, c.spread2, d.spread2};
  const Eigen::Vector3d at_a = tree_.point(places[0]), at_b = tree_.point(places[1]),
                        at_c = tree_.point(places[2]), at_d = tree_.point(places[3]);
  const auto offset = [&](int axis) {
    const double from = point[axis];
    return Floats{static_cast<float>(at_a[axis] - from), static_cast<float>(at_b[axis] - from),
                  static_cast<float>(at_c[axis] - from), static_cast<float>(at_d[axis] - from)};
  };
  const Floats offset_x = offset(0), offset_y = offset(1), offset_z = offset(2);
  const auto put = [&](const Floats& values, SeenPlanes::Column& column) {
    std::memcpy(&column[at], &values, sizeof(values));
  };
  put(__builtin_shufflevector(xy_ab, xy_cd, 0, 1, 4, 5), seen_.normal_x);
  put(__builtin_shufflevector(xy_ab, xy_cd, 2, 3, 6, 7), seen_.normal_y);
  put(__builtin_shufflevector(zh_ab, zh_cd, 0, 1, 4, 5), seen_.normal_z);
  put(__builtin_shufflevector(zh_ab, zh_cd, 2, 3, 6, 7), seen_.height);
  put(offset_x, seen_.offset_x), put(offset_y, seen_.offset_y), put(offset_z, seen_.offset_z);
  put(spread2, seen_.spread2);
}

/// The planes of the point and its neighbours.
void SurfaceFit::take(std::size_t place, std::span<const std::uint32_t> neighbours) {
  const std::size_t count = neighbours.size();
  const Eigen::Vector3d point = tree_.point(place);
  std::size_t first = 0;
  for (; first + kAtOnce <= count; first += kAtOnce)
    take_some(neighbours.subspan(first).first<kAtOnce>(), point, first);
  std::array<std::uint32_t, kAtOnce> last;
  last.fill(static_cast<std::uint32_t>(place));
  std::copy(neighbours.begin() + static_cast<std::ptrdiff_t>(first), neighbours.end(), last.begin());
  take_some(last, point, first);
  seen_.size = count + 1;
  // What fills up the last lanes has no normal, and so no weight.
  for (std::size_t i = seen_.size; i < first + kAtOnce || i % SeenPlanes::kLanes != 0; ++i)
    seen_.normal_x[i] = seen_.normal_y[i] = seen_.normal_z[i] = 0.0F;
}

void SurfaceFit::add(std::size_t place, std::span<const std::uint32_t> neighbours) {
  constexpr float kLeastUnit = 1e-9F;  // m
  constexpr std::uint32_t kExponent = 0x7f800000;
  assert(!is_full());
  const LocalPlane& own = planes_[place];
  take(place, neighbours);
  // A power of two, at most the reach.
  const auto unit =
      std::bit_cast<float>(std::bit_cast<std::uint32_t>(std::max(own.reach, kLeastUnit)) & kExponent);
  seen_.per_unit = 1.0F / unit;
  PlaneAxes axes;
  axes.n = own.normal;
  axes.u = axes.n.unitOrthogonal();
  axes.v = axes.n.cross(axes.u);
  sums_[count_] = {};
  add_planes(seen_, axes, sums_[count_]);
  heights_[count_] = {place, static_cast<double>(unit)};
  ++count_;
}

std::span<const SurfaceFit::Height> SurfaceFit::heights() {
  const std::array<double, kHeights> in_units = heights_by(sums_);
  for (std::size_t i = 0; i < count_; ++i)
    heights_[i].height *= in_units[i];
  return {heights_.data(), std::exchange(count_, 0)};
}

}  // namespace ray
