/// A long map with a little bend onto one without: found, told from none, and taken out.

#include "scans.h"

#include <raycloud/align/clouds.h>
#include <raycloud/core/bend.h>

#include <gtest/gtest.h>

namespace ray {
namespace {

using namespace test;

CloudAlignment bent_onto(const RayCloud& rays, const RayCloud& reference, const AlignRule& rule,
                         const Context& context = {}) {
  MemorySource a(rays), b(reference);
  return align_clouds(context, a, b, rule);
}

/// The largest and the root mean square distance (m) of bounded ends from where they belong.
std::pair<double, double> distances(const RayCloud& rays, const RayCloud& truth) {
  double most = 0.0, squares = 0.0, count = 0.0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    if (rays.bounded[i] == 0) continue;
    const double distance = (rays.ends[i] - truth.ends[i]).norm();
    most = std::max(most, distance);
    squares += distance * distance, count += 1.0;
  }
  return {most, std::sqrt(squares / count)};
}

/// One metre at either end of 500 m, sideways, and a little upwards.
Bend one_metre() {
  Bend bend;
  bend.shifts.col(0) = Eigen::Vector3d(0.0, 1.0, 0.2) / (250.0 * 250.0);
  return bend;
}

TEST(AlignBent, AMetreIn500IsTakenOut) {
  RayCloud reference = long_street(1), truth = long_street(2), rays = truth;
  bend_rays(one_metre(), rays);
  rays.transform(moved_by(0.2, {0.5, -0.3, 0.1}));
  for (RayCloud* cloud : {&reference, &truth, &rays})
    cloud->transform(moved_by(0.0, {400'000.0, 5'000'000.0, 30.0}));
  const CloudAlignment found = bent_onto(rays, reference, {.local = true, .nonrigid = true});
  EXPECT_EQ(found.doubt, "");
  EXPECT_FALSE(found.bend.is_none());
  rays.transform(found.pose);
  EXPECT_GT(distances(rays, truth).first, 0.2);  // a rigid motion does not do
  bend_rays(found.bend, rays);
  const auto [most, usual] = distances(rays, truth);
  EXPECT_LT(most, 0.01);
  EXPECT_LT(usual, 0.003);
}

TEST(AlignBent, WhatIsNotBentStaysStraight) {
  const RayCloud reference = long_street(1);
  RayCloud rays = long_street(2);
  rays.transform(moved_by(0.2, {0.5, -0.3, 0.1}));
  const CloudAlignment rigid = bent_onto(rays, reference, {.local = true});
  const CloudAlignment found = bent_onto(rays, reference, {.local = true, .nonrigid = true});
  EXPECT_EQ(found.doubt, "");
  EXPECT_TRUE(found.bend.is_none());
  EXPECT_EQ(found.pose.rotation, rigid.pose.rotation);
  EXPECT_EQ(found.pose.translation, rigid.pose.translation);
  rays.transform(found.pose);
  EXPECT_LT(distances(rays, long_street(2)).first, 0.005);
  const CloudAlignment room = bent_onto(room_scan(2), room_scan(1), {.local = true, .nonrigid = true});
  EXPECT_TRUE(room.bend.is_none());
}

TEST(AlignBent, IsTheSameBitsForAnyThreads) {
  const RayCloud reference = long_street(1, 60'000);
  RayCloud rays = long_street(2, 60'000);
  bend_rays(one_metre(), rays);
  const CloudAlignment expected =
      bent_onto(rays, reference, {.local = true, .nonrigid = true}, {.threads = 1});
  const CloudAlignment found = bent_onto(rays, reference, {.local = true, .nonrigid = true}, {.threads = 8});
  EXPECT_FALSE(expected.bend.is_none());
  EXPECT_EQ(found.bend.shifts, expected.bend.shifts);
  EXPECT_EQ(found.bend.centre, expected.bend.centre);
  EXPECT_EQ(found.pose.translation, expected.pose.translation);
}

TEST(BendRays, StartsGoWithTheirEnds) {
  const RayCloud before = room_scan(1, 3000);
  RayCloud rays = before;
  bend_rays({}, rays);
  EXPECT_EQ(rays.ends, before.ends);
  Bend bend;
  bend.centre = {1.0, 2.0};
  bend.shifts << 1e-3, 2e-3, -1e-3, 0.0, 3e-3, 1e-3, 2e-3, -1e-3, 0.0;
  bend_rays(bend, rays);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const Eigen::Vector3d shift = rays.ends[i] - before.ends[i];
    EXPECT_TRUE((rays.starts[i] - before.starts[i]).isApprox(shift, 1e-9));
    const Eigen::Vector3d& at = before.bounded[i] != 0 ? before.ends[i] : before.starts[i];
    const double x = at.x() - 1.0, y = at.y() - 2.0;
    EXPECT_NEAR(shift.x(), 1e-3 * x * x + 2e-3 * y * y - 1e-3 * x * y, 1e-12);
  }
}

}  // namespace
}  // namespace ray
