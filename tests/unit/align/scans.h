#pragma once
/// Scans of a room and of a wood, for alignment.

#include <raycloud/core/memory_stream.h>
#include <raycloud/exec/random.h>
#include <raycloud/exec/stream.h>
#include <raycloud/synth/scenes.h>
#include <raycloud/synth/simulate.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

namespace ray::test {

inline constexpr double kDegree = std::numbers::pi / 180.0;

/// A room that was scanned twice is another cloud for each seed.
inline RayCloud room_scan(std::uint64_t seed, std::uint64_t rays = 60'000) {
  static const Scene scene = make_scene(SceneKind::room, 1);
  return read_all({}, *simulate(scene, {.rays = rays, .seed = seed}));
}

/// A room of 8 m by 5 m and 3 m, seen from its middle, 1 cm of noise: the walls at x = 0 and y = 0 whole, the
/// others in part; a table; the ground outside slopes away.
inline RayCloud plain_room(std::uint64_t seed, std::size_t rays = 120'000) {
  const RandomStream random(seed, "room");
  RayCloud cloud;
  cloud.resize(rays);
  for (std::size_t i = 0; i < rays; ++i) {
    const double u = random.uniform(i, 0), v = random.uniform(i, 1),
                 noise = 0.035 * (random.uniform(i, 2) - 0.5);
    Eigen::Vector3d& end = cloud.ends[i];
    switch (random.below(8, i, 3)) {
      case 0:
        end = {8.0 * u, noise, 3.0 * v};
        break;
      case 1:
        end = {noise, 5.0 * u, 3.0 * v};
        break;
      case 2:
        end = {4.0 * u, 5.0 + noise, 3.0 * v};
        break;
      case 3:
        end = {8.0 + noise, 2.0 * u, 3.0 * v};
        break;
      case 4:
        end = {8.0 * u, 5.0 * v, 3.0 + noise};
        break;
      case 5:
        end = {3.0 + 2.0 * u, 2.0 + 2.0 * v, 0.8 + noise};
        break;
      case 6:
        end = {8.0 + 6.0 * u, 5.0 * v, -2.0 * u + noise};
        break;
      default:
        end = {8.0 * u, 5.0 * v, noise};
    }
    cloud.starts[i] = {4.0, 2.5, 1.5};
    cloud.times[i] = 1e-3 * static_cast<double>(i);
    cloud.bounded[i] = 1;
  }
  return cloud;
}

inline Pose moved_by(double yaw_deg, const Eigen::Vector3d& shift) {
  Pose pose = rotation_pose({0.0, 0.0, yaw_deg * kDegree});
  pose.translation = shift;
  return pose;
}

/// p ↦ a (b p).
inline Pose after(const Pose& a, const Pose& b) {
  return {a.rotation * b.rotation, a * b.translation};
}

inline double angle_of(const Eigen::Matrix3d& rotation) {
  return Eigen::AngleAxisd(rotation).angle();
}

/// A level square of 20 m, scanned from above; `hills` m high.
inline RayCloud field_scan(double hills, std::uint64_t seed, std::size_t rays = 40'000) {
  const RandomStream random(seed, "field");
  RayCloud cloud;
  cloud.resize(rays);
  for (std::size_t i = 0; i < rays; ++i) {
    const double x = 20.0 * random.uniform(i, 0), y = 20.0 * random.uniform(i, 1);
    cloud.ends[i] = {x, y,
                     hills * std::sin(0.9 * x) * std::cos(0.7 * y) + 0.02 * (random.uniform(i, 2) - 0.5)};
    cloud.starts[i] = {10.0, 10.0, 5.0};
    cloud.times[i] = 1e-3 * static_cast<double>(i);
    cloud.bounded[i] = 1;
  }
  return cloud;
}

/// A street of 500 m along x, another scan for each seed: the ground, and house fronts on both sides at
/// changing distances, with the side walls that this leaves. Half a centimetre of noise.
inline RayCloud long_street(std::uint64_t seed, std::size_t rays = 200'000) {
  constexpr double kHouse = 12.5, kHeight = 6.0, kHalf = 250.0;
  const RandomStream random(seed, "long street"), houses(1, "houses");
  const auto front = [&](int house, double side) {
    return side * (6.0 + 10.0 * houses.uniform(static_cast<std::uint64_t>(house + 100), side > 0.0 ? 1 : 0));
  };
  RayCloud cloud;
  cloud.resize(rays);
  for (std::size_t i = 0; i < rays; ++i) {
    const double x = kHalf * (2.0 * random.uniform(i, 0) - 1.0), v = random.uniform(i, 1),
                 noise = 0.0173 * (random.uniform(i, 2) - 0.5),
                 side = random.below(2, i, 3) == 0 ? -1.0 : 1.0;
    const int house = static_cast<int>(std::floor(x / kHouse));
    double from = x + 8.0 * (random.uniform(i, 6) - 0.5);
    Eigen::Vector3d& end = cloud.ends[i];
    switch (random.below(5, i, 4)) {
      case 0:
      case 1:
        end = {x, 6.0 * (2.0 * v - 1.0), noise};
        break;
      case 2: {
        const double a = front(house - 1, side), b = front(house, side), u = random.uniform(i, 5);
        end = {house * kHouse + noise, a + (b - a) * u, kHeight * v};
        from = house * kHouse + (std::abs(b) > std::abs(a) ? 4.0 : -4.0) * random.uniform(i, 6);
        break;
      }
      default:
        end = {x, front(house, side) + noise, kHeight * v};
    }
    cloud.starts[i] = {from, 0.0, 1.6};
    cloud.times[i] = 1e-3 * static_cast<double>(i);
    cloud.bounded[i] = 1;
  }
  return cloud;
}

}  // namespace ray::test
