/// A room to its own axes: wherever it was and however it was turned.

#include "scans.h"

#include <raycloud/align/axes.h>
#include <raycloud/core/error.h>

#include <gtest/gtest.h>

namespace ray {
namespace {

using namespace test;

AxesAlignment aligned(const RayCloud& rays, const AxesRule& rule = {}, const Context& context = {},
                      std::size_t chunk_rays = 32768) {
  MemorySource source(rays, chunk_rays);
  return align_to_axes(context, source, rule);
}

/// How far a transform moves the points of a cloud, at most.
double furthest(const RayCloud& rays, const Pose& pose) {
  double most = 0.0;
  for (std::size_t i = 0; i < rays.size(); i += 97)
    if (rays.bounded[i] != 0) most = std::max(most, (pose * rays.ends[i] - rays.ends[i]).norm());
  return most;
}

TEST(Axes, WallsAreAlongTheAxesAndTheirCornerIsTheOrigin) {
  const RayCloud rays = plain_room(1);
  const Pose found = aligned(rays).pose;
  EXPECT_LT(angle_of(found.rotation), 0.05 * kDegree);
  EXPECT_LT(found.translation.norm(), 0.01);
}

TEST(Axes, DoNotDependOnWhereTheCloudWas) {
  const RayCloud rays = plain_room(1);
  const RandomStream random(1, "places");
  for (std::uint64_t i = 0; i < 12; ++i) {
    const double yaw = i == 0 ? -178.0 : 360.0 * random.uniform(i, 0);
    const Pose moved =
        moved_by(yaw, {1e3 * random.uniform(i, 1), -5e6 * random.uniform(i, 2), 99.0 * random.uniform(i, 3)});
    RayCloud elsewhere = rays;
    elsewhere.transform(moved);
    const Pose found = after(aligned(elsewhere).pose, moved);
    // Walls of 5 and 8 m that cut cubes at a small angle; those of a building are longer.
    EXPECT_LT(angle_of(found.rotation), 0.1 * kDegree) << yaw;
    EXPECT_LT(furthest(rays, found), 0.02) << yaw;
  }
}

TEST(Axes, AreTheSameBitsForAnyThreadsAndChunks) {
  const RayCloud rays = room_scan(2, 20'000);
  const Pose expected = aligned(rays).pose;
  for (const unsigned threads : {1U, 2U, 8U})
    for (const std::size_t chunk : {std::size_t{7}, std::size_t{1'000'000}}) {
      const Pose found = aligned(rays, {}, {.threads = threads}, chunk).pose;
      EXPECT_EQ(found.rotation, expected.rotation);
      EXPECT_EQ(found.translation, expected.translation);
    }
}

TEST(Axes, AreLevelled) {
  const RayCloud rays = plain_room(1);
  Pose moved = moved_by(30.0, {5, 6, 7});
  moved.rotation = rotation_pose({5.0 * kDegree, -6.0 * kDegree, 0.0}).rotation * moved.rotation;
  RayCloud tilted = rays;
  tilted.transform(moved);
  const Pose found = after(aligned(tilted, {.level = true}).pose, moved);
  EXPECT_LT(angle_of(found.rotation), 0.1 * kDegree);
  EXPECT_LT(furthest(rays, found), 0.02);
}

TEST(Axes, AreRefusedWithoutWalls) {
  const auto refused = [](const RayCloud& rays, const AxesRule& rule = {}) {
    try {
      static_cast<void>(aligned(rays, rule));
    } catch (const Error& error) {
      return error.code() == ErrorCode::no_data;
    }
    return false;
  };
  RayCloud none = room_scan(1, 1000);
  std::fill(none.bounded.begin(), none.bounded.end(), std::uint8_t{0});
  EXPECT_TRUE(refused(none));
  none.resize(0);
  EXPECT_TRUE(refused(none));
  EXPECT_TRUE(refused(field_scan(0.0, 1)));
  EXPECT_TRUE(refused(field_scan(0.0, 1), {.level = true}));
  EXPECT_TRUE(refused(field_scan(0.5, 1)));
  RayCloud one = field_scan(0.0, 1, 1);
  EXPECT_TRUE(refused(one));
  RayCloud line = field_scan(0.0, 1);
  for (Eigen::Vector3d& end : line.ends)
    end.y() = 3.0;
  EXPECT_TRUE(refused(line));
  RayCloud place = field_scan(0.0, 1);
  std::fill(place.ends.begin(), place.ends.end(), Eigen::Vector3d(1, 2, 3));
  EXPECT_TRUE(refused(place));
}

}  // namespace
}  // namespace ray
