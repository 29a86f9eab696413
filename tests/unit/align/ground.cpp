/// What may be up.

#include "align/ground.h"

#include "scans.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace ray::align {
namespace {

PatchLevel room_level(const RayCloud& rays) {
  constexpr double kWidth = 0.3;  // m
  MemorySource source(rays);
  return {{}, gather_surfaces({}, source, survey_ends({}, source), kWidth), 1, 5.0};
}

/// The floor faces up, the ceiling down, and walls across: however the scanner was held, up to 40 degrees.
TEST(MaybeUp, HasTheFloorOfARoomThatIsTilted) {
  for (const Eigen::Vector3d& held :
       {Eigen::Vector3d(0.0, 0.0, 0.0), Eigen::Vector3d(0.5, 0.4, 0.2), Eigen::Vector3d(-0.7, 0.0, 1.0)}) {
    RayCloud room = test::plain_room(3);
    const Pose pose = rotation_pose(held);
    room.transform(pose);
    const Eigen::Vector3d up = pose.rotation * Eigen::Vector3d::UnitZ();
    const std::vector<Eigen::Vector3d> found = maybe_up(room_level(room), 2);
    EXPECT_LE(found.size(), 2U);
    EXPECT_TRUE(std::any_of(found.begin(), found.end(), [&](const Eigen::Vector3d& one) {
      return one.dot(up) > std::cos(5.0 * test::kDegree);
    }));
  }
}

TEST(MaybeUp, IsNothingWhereNothingFacesUp) {
  RayCloud room = test::plain_room(3);
  room.transform(rotation_pose({0.5 * std::numbers::pi, 0.0, 0.0}));  // the floor is a wall
  RayCloud wall = room;
  std::vector<std::uint8_t> mask(wall.size());
  for (std::size_t i = 0; i < wall.size(); ++i)
    mask[i] = std::abs(wall.ends[i].y()) < 0.05 ? 1 : 0;
  wall.select(mask);
  EXPECT_TRUE(maybe_up(room_level(wall), 2).empty());
}

}  // namespace
}  // namespace ray::align
