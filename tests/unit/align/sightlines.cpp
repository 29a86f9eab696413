/// Surfaces in the way of rays.

#include "align/sightlines.h"

#include "scans.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace ray::align {
namespace {

constexpr double kWidth = 0.4;  // m

/// A wall of 4 m by 4 m at x = 0, seen from x = 3, 2 cm of noise.
PatchLevel wall() {
  constexpr std::size_t kRays = 8000;
  const RandomStream random(1, "wall");
  RayCloud cloud;
  cloud.resize(kRays);
  for (std::size_t i = 0; i < kRays; ++i) {
    cloud.ends[i] = {0.1 + 0.0693 * (random.uniform(i, 0) - 0.5), 4.0 * random.uniform(i, 1),
                     4.0 * random.uniform(i, 2)};
    cloud.starts[i] = {3.0, 2.0, 2.0};
    cloud.bounded[i] = 1;
  }
  MemorySource source(cloud);
  Survey survey = survey_ends({}, source);
  survey.origin.setZero();
  return {{}, gather_surfaces({}, source, survey, kWidth), 1, 5.0};
}

/// To places `behind` (m) the wall, or before it, all over it.
std::vector<Segment> rays_to(double behind) {
  std::vector<Segment> rays;
  for (int y = 0; y < 80; ++y)
    for (int z = 0; z < 80; ++z)
      rays.push_back(
          {{3.0F, 2.0F, 2.0F},
           {static_cast<float>(0.1 - behind), 0.05F * static_cast<float>(y), 0.05F * static_cast<float>(z)}});
  return rays;
}

double share_pierced(const PatchLevel& level, const std::vector<Segment>& rays) {
  const std::vector<std::uint8_t> pierced =
      pierced_patches({}, rays, {Eigen::Matrix3d::Identity(), Eigen::Vector3d::Zero()}, level);
  return static_cast<double>(std::count(pierced.begin(), pierced.end(), 1)) /
         static_cast<double>(pierced.size());
}

TEST(PiercedPatches, AreThoseThatRaysGoThrough) {
  const PatchLevel level = wall();
  EXPECT_GT(share_pierced(level, rays_to(0.25)), 0.9);
  EXPECT_GT(share_pierced(level, rays_to(1.0)), 0.4);
  EXPECT_EQ(share_pierced(level, rays_to(0.0)), 0.0);
  EXPECT_EQ(share_pierced(level, rays_to(0.06)), 0.0);
  EXPECT_EQ(share_pierced(level, rays_to(-0.5)), 0.0);
  EXPECT_EQ(share_pierced(level, {}), 0.0);
}

TEST(PiercedPatches, MoveWithThePose) {
  const PatchLevel level = wall();
  const std::vector<Segment> rays = rays_to(0.0);
  const std::vector<std::uint8_t> near =
                                      pierced_patches({}, rays, test::moved_by(0.0, {0.03, 0.0, 0.0}), level),
                                  through = pierced_patches({}, rays, test::moved_by(0.0, {-0.25, 0.0, 0.0}),
                                                            level);
  EXPECT_EQ(std::count(near.begin(), near.end(), 1), 0);
  EXPECT_GT(std::count(through.begin(), through.end(), 1), 80);
  for (const unsigned threads : {1U, 3U})
    EXPECT_EQ(pierced_patches({.threads = threads}, rays, test::moved_by(0.0, {-0.25, 0.0, 0.0}), level),
              through);
}

TEST(PiercedPatches, AreNoneOfFarOrEndlessRays) {
  const PatchLevel level = wall();
  EXPECT_EQ(share_pierced(level, {{{1e6F, 2.0F, 2.0F}, {-1e6F, 2.0F, 2.0F}}}), 0.0);
  EXPECT_EQ(share_pierced(level, {{{3.0F, 2.0F, 2.0F}, {3.0F, 2.0F, 2.0F}}}), 0.0);
}

}  // namespace
}  // namespace ray::align
