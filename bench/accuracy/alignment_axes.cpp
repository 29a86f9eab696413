// Buildings to their own axes: how true yaw, corner and ground are.

#include "tables.h"

#include <raycloud/align/axes.h>
#include <raycloud/core/memory_stream.h>
#include <raycloud/exec/random.h>
#include <raycloud/exec/stream.h>
#include <raycloud/synth/scenes.h>
#include <raycloud/synth/simulate.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

namespace bench {

void print_axes() {
  constexpr std::uint64_t kBuildings = 12;
  constexpr double kDegrees = std::numbers::pi / 180.0;
  constexpr double kHalfLength = 9.3, kHalfWidth = 5.8;  // m, of the outer walls
  std::printf(
      "\nA building to its own axes, from any yaw: the largest errors of %d buildings, each turned anew\n\n"
      "| | yaw, degrees | corner, m | ground, m | bar | |\n|---|---|---|---|---|---|\n",
      static_cast<int>(kBuildings));
  const ray::RandomStream random(7, "axes");
  for (const bool level : {false, true}) {
    double turn = 0.0, corner = 0.0, ground = 0.0;
    for (std::uint64_t seed = 1; seed <= kBuildings; ++seed) {
      const ray::Scene scene = make_scene(ray::SceneKind::building, seed);
      ray::RayCloud rays = read_all({}, *simulate(scene, {.rays = 1'000'000, .seed = seed}));
      const auto uniform = [&](std::uint64_t draw, double low, double high) {
        return low + (high - low) * random.uniform(seed, draw);
      };
      ray::Pose moved = ray::rotation_pose({0.0, 0.0, uniform(0, -3.1, 3.1)});
      if (level)
        moved.rotation =
            ray::rotation_pose({uniform(1, -0.1, 0.1), uniform(2, -0.1, 0.1), 0.0}).rotation * moved.rotation;
      moved.translation = {uniform(3, -100.0, 100.0), uniform(4, -100.0, 100.0), uniform(5, -10.0, 10.0)};
      rays.transform(moved);
      ray::MemorySource source(rays);
      const ray::Pose found = align_to_axes({}, source, {.level = level}).pose;
      const Eigen::Matrix3d whole = found.rotation * moved.rotation;
      const double yaw = std::atan2(whole(1, 0), whole(0, 0)),
                   quarter = std::remainder(yaw, std::numbers::pi / 2.0);
      turn = std::max(turn,
                      level ? Eigen::AngleAxisd(
                                  Eigen::Matrix3d(ray::rotation_pose({0, 0, quarter - yaw}).rotation * whole))
                                  .angle()
                            : std::abs(quarter));
      double nearest = 1e9;
      for (const double x : {-kHalfLength, kHalfLength})
        for (const double y : {-kHalfWidth, kHalfWidth})
          nearest = std::min(nearest, (found * (moved * Eigen::Vector3d(x, y, 0.0))).head<2>().norm());
      corner = std::max(corner, nearest);
      ground = std::max(ground, std::abs((found * (moved * Eigen::Vector3d(0.0, 0.0, -0.15))).z()));
    }
    std::printf(
        "| %s | %.4f | %.4f | %.4f | %s |\n", level ? "with roll and pitch, --level" : "yaw alone",
        turn / kDegrees, corner, ground,
        verdict("0.05 degrees, 1 cm", turn < 0.05 * kDegrees && corner < 0.01 && ground < 0.01).c_str());
    std::fflush(stdout);
  }
}

}  // namespace bench
