#pragma once
/// Scans of a room and of a wood, for alignment.

#include <raycloud/core/memory_stream.h>
#include <raycloud/exec/random.h>
#include <raycloud/exec/stream.h>
#include <raycloud/synth/scenes.h>
#include <raycloud/synth/simulate.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

namespace ray::test {

inline constexpr double kDegree = std::numbers::pi / 180.0;

/// A room that was scanned twice is another cloud for each seed.
inline RayCloud room_scan(std::uint64_t seed, std::uint64_t rays = 60'000) {
  static const Scene scene = make_scene(SceneKind::room, 1);
  return read_all({}, *simulate(scene, {.rays = rays, .seed = seed}));
}

/// A building of several storeys; another scan for each seed.
inline RayCloud building_scan(std::uint64_t seed, std::uint64_t rays = 150'000) {
  static const Scene scene = make_scene(SceneKind::building, 102);
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

/// A hall of 24 m by 8 m that looks the same when it is turned by 180 degrees, but for its pillars; another
/// scan for each seed.
inline RayCloud hall_scan(std::uint64_t seed, std::uint64_t rays = 120'000) {
  Scene scene;
  scene.kind = "hall";
  scene.seed = 1;
  const auto add_box = [&](SceneLabel label, const Eigen::Vector3d& low, const Eigen::Vector3d& high) {
    SceneObject object;
    object.id = static_cast<std::int32_t>(scene.objects.size());
    object.label = label;
    for (int i = 0; i < 8; ++i)
      object.mesh.vertices.emplace_back((i & 1) != 0 ? high.x() : low.x(), (i & 2) != 0 ? high.y() : low.y(),
                                        (i & 4) != 0 ? high.z() : low.z());
    object.mesh.faces = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                         {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
    scene.objects.push_back(std::move(object));
  };
  add_box(SceneLabel::floor, {-12.2, -4.2, -0.2}, {12.2, 4.2, 0.0});
  for (const double side : {-4.1, 4.1})
    add_box(SceneLabel::wall, {-12.2, side - 0.1, 0.0}, {12.2, side + 0.1, 3.0});
  for (const double side : {-12.1, 12.1})
    add_box(SceneLabel::wall, {side - 0.1, -4.0, 0.0}, {side + 0.1, 4.0, 3.0});
  for (const auto& [x, y] : {std::pair(-10.0, 2.0),
                             {-7.5, -2.5},
                             {-5.0, 3.0},
                             {-3.0, -2.0},
                             {-1.4, 2.2},
                             {0.3, -2.7},
                             {1.4, 3.1},
                             {4.0, 1.8},
                             {5.5, -3.0},
                             {8.5, 2.6},
                             {10.5, -1.9}})
    add_box(SceneLabel::wall, {x - 0.25, y - 0.25, 0.0}, {x + 0.25, y + 0.25, 2.8});
  for (int i = 0; i <= 440; ++i) {
    scene.path.times.push_back(0.1 * i);
    scene.path.positions.emplace_back(-11.0 + 0.05 * i, 0.1, 1.5);
  }
  return read_all({}, *simulate(scene, {.rays = rays, .seed = seed}));
}

/// The rays that begin and end at an x between two limits.
inline RayCloud part_of(RayCloud rays, double low, double high) {
  std::vector<std::uint8_t> mask(rays.size());
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const auto [least, most] = std::minmax({rays.starts[i].x(), rays.ends[i].x()});
    mask[i] = rays.bounded[i] != 0 && least > low && most < high ? 1 : 0;
  }
  rays.select(mask);
  return rays;
}

}  // namespace ray::test
