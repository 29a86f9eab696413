/// The last fit: what noise does to normals must not pull along a surface.

#include "align/fine.h"

#include "scans.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace ray::align {
namespace {

/// A passage of 100 m along x, 4 m wide, 3 m high, with a wall across at each end; 2 cm of noise, 12 points
/// or so a patch.
RayCloud passage(std::uint64_t seed) {
  constexpr std::size_t kRays = 100'000, kAcross = 1500;
  const RandomStream random(seed, "passage");
  RayCloud cloud;
  cloud.resize(kRays);
  for (std::size_t i = 0; i < kRays; ++i) {
    const double u = random.uniform(i, 0), v = random.uniform(i, 1),
                 noise = 0.0693 * (random.uniform(i, 2) - 0.5);
    const bool is_across = i < kAcross;
    const std::uint64_t side = random.below(is_across ? 2 : 3, i, 3);
    const double x = 100.0 * u;
    cloud.ends[i] = is_across   ? Eigen::Vector3d(side == 0 ? noise : 100.0 + noise, 4.0 * u, 3.0 * v)
                    : side == 0 ? Eigen::Vector3d(x, 4.0 * v, noise)
                    : side == 1 ? Eigen::Vector3d(x, noise, 3.0 * v)
                                : Eigen::Vector3d(x, 4.0 + noise, 3.0 * v);
    cloud.starts[i] = {std::clamp(cloud.ends[i].x(), 2.0, 98.0), 2.0, 1.5};
    cloud.bounded[i] = 1;
  }
  return cloud;
}

PatchLevel level_of(const RayCloud& rays) {
  constexpr double kWidth = 0.4;  // m
  MemorySource source(rays);
  Survey survey = survey_ends({}, source);
  survey.origin.setZero();
  return {{}, gather_surfaces({}, source, survey, kWidth), 1, 5.0};
}

TEST(FitPatches, NoiseOfNormalsPullsNowhere) {
  const PatchLevel reference = level_of(passage(1));
  double most = 0.0;
  // The cubes of one cloud lie otherwise on those of the other for each shift.
  for (const double shift : {0.05, 0.1, 0.15, -0.05, -0.1, -0.15}) {
    RayCloud moved = passage(2);
    Pose away = rotation_pose({0.0, 0.0, 0.0});
    away.translation = {shift, 0.0, 0.0};
    moved.transform(away);
    Pose back = rotation_pose({0.0, 0.0, 0.0});
    back.translation = -away.translation;
    const PatchLevel level = level_of(moved);
    const FineFit fit = fit_patches(Context{}, level.patches(), reference, back, {0.1, 20});
    const Eigen::Vector3d middle(50.0 + shift, 2.0, 1.5);
    most = std::max(most, (fit.pose * middle - back * middle).norm());
  }
  EXPECT_LT(most, 0.006);
}

}  // namespace
}  // namespace ray::align
