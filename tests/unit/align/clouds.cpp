/// One cloud onto another: a room scanned twice, from anywhere; and what must be refused.

#include "scans.h"

#include <raycloud/align/clouds.h>
#include <raycloud/core/error.h>

#include <gtest/gtest.h>

namespace ray {
namespace {

using namespace test;

CloudAlignment aligned_with(const RayCloud& rays, const RayCloud& reference, const AlignRule& rule = {},
                            const Context& context = {}, std::size_t chunk_rays = 32768) {
  MemorySource a(rays, chunk_rays), b(reference, chunk_rays);
  return align_clouds(context, a, b, rule);
}

/// Whether a pose undoes a motion, within an angle (rad) and a distance (m) at the points of the cloud.
void expect_undone(const Pose& pose, const Pose& moved, const RayCloud& rays, double turn, double shift) {
  const Pose whole = after(pose, moved);
  EXPECT_LT(angle_of(whole.rotation), turn);
  double most = 0.0;
  for (std::size_t i = 0; i < rays.size(); i += 97)
    if (rays.bounded[i] != 0 && rays.ends[i].norm() < 10.0)
      most = std::max(most, (whole * rays.ends[i] - rays.ends[i]).norm());
  EXPECT_LT(most, shift);
}

TEST(AlignClouds, ARoomFromAnywhere) {
  const RayCloud reference = room_scan(1);
  for (const double yaw : {33.0, 180.0}) {
    RayCloud rays = room_scan(2);
    const Pose moved = moved_by(yaw, {400'000.0 + 3.0 * yaw, 5'000'000.0 - yaw, 12.0});
    rays.transform(moved);
    const CloudAlignment found = aligned_with(rays, reference);
    EXPECT_EQ(found.doubt, "") << yaw;
    expect_undone(found.pose, moved, room_scan(1), 0.1 * kDegree, 0.03);
    EXPECT_GT(found.overlap, 0.5);
    EXPECT_GT(found.reference_overlap, 0.5);
    EXPECT_LT(found.rmse, 0.05);
    EXPECT_TRUE((found.covariance.diagonal().array() > 0.0).all());
  }
}

TEST(AlignClouds, IsTheSameBitsForAnyThreadsAndChunks) {
  const RayCloud reference = room_scan(1, 20'000);
  RayCloud rays = room_scan(2, 20'000);
  rays.transform(moved_by(70.0, {3, 2, 1}));
  const CloudAlignment expected = aligned_with(rays, reference, {}, {.threads = 1}, 7);
  const CloudAlignment found = aligned_with(rays, reference, {}, {.threads = 8}, 1'000'000);
  EXPECT_EQ(found.pose.rotation, expected.pose.rotation);
  EXPECT_EQ(found.pose.translation, expected.pose.translation);
  EXPECT_EQ(found.covariance, expected.covariance);
  EXPECT_EQ(found.overlap, expected.overlap);
  EXPECT_EQ(found.doubt, expected.doubt);
}

TEST(AlignClouds, LocallyWhereTheyNearlyAre) {
  const RayCloud reference = room_scan(1);
  RayCloud rays = room_scan(2);
  Pose moved = moved_by(2.0, {0.2, -0.15, 0.1});
  moved.rotation = rotation_pose({0.03, -0.02, 0.0}).rotation * moved.rotation;
  rays.transform(moved);
  const CloudAlignment found = aligned_with(rays, reference, {.local = true});
  EXPECT_EQ(found.doubt, "");
  expect_undone(found.pose, moved, room_scan(1), 0.1 * kDegree, 0.03);
}

TEST(AlignClouds, OfVeryDifferentDensity) {
  const RayCloud reference = room_scan(1);
  RayCloud rays = room_scan(2, 6'000);
  const Pose moved = moved_by(200.0, {3.0, -2.0, 1.0});
  rays.transform(moved);
  const CloudAlignment found = aligned_with(rays, reference);
  // Right, or not trusted.
  if (found.doubt.empty()) expect_undone(found.pose, moved, room_scan(1), 0.5 * kDegree, 0.1);
}

TEST(AlignClouds, TiltedByTenDegrees) {
  const RayCloud reference = room_scan(1);
  RayCloud rays = room_scan(2);
  Pose moved = moved_by(25.0, {1.0, -2.0, 0.5});
  moved.rotation = rotation_pose({0.14, -0.1, 0.0}).rotation * moved.rotation;
  rays.transform(moved);
  const CloudAlignment found = aligned_with(rays, reference);
  EXPECT_EQ(found.doubt, "");
  expect_undone(found.pose, moved, room_scan(1), 0.05 * kDegree, 0.01);
}

Pose tilted_by_ten_degrees() {
  Pose moved = moved_by(25.0, {10.0, -20.0, 0.5});
  moved.rotation = rotation_pose({0.14, -0.1, 0.0}).rotation * moved.rotation;
  return moved;
}

/// A scanner in the hand, held one way and then another.
TEST(AlignClouds, HeldAskew) {
  RayCloud reference = room_scan(1), rays = room_scan(2);
  const Pose held = rotation_pose({-0.2, 0.15, 0.0});
  reference.transform(held);
  Pose moved = moved_by(100.0, {1.0, -2.0, 0.5});
  moved.rotation = rotation_pose({0.3, 0.35, 0.0}).rotation * moved.rotation;
  rays.transform(moved);
  const CloudAlignment found = aligned_with(rays, reference);
  EXPECT_EQ(found.doubt, "");
  const Eigen::Matrix3d upright = held.rotation.transpose();
  expect_undone({upright * found.pose.rotation, upright * found.pose.translation}, moved, room_scan(1),
                0.05 * kDegree, 0.01);
}

/// Storeys look alike: tilted, one lies on another long before the right one is found.
TEST(AlignClouds, ABuildingTiltedByTenDegrees) {
  RayCloud rays = building_scan(2);
  const Pose moved = tilted_by_ten_degrees();
  rays.transform(moved);
  const CloudAlignment found = aligned_with(rays, building_scan(1));
  EXPECT_EQ(found.doubt, "");
  expect_undone(found.pose, moved, building_scan(2), 0.05 * kDegree, 0.02);
}

TEST(AlignClouds, OntoATiltedBuilding) {
  const RayCloud rays = building_scan(2);
  RayCloud reference = building_scan(1);
  const Pose moved = tilted_by_ten_degrees();
  reference.transform(moved);
  const CloudAlignment found = aligned_with(rays, reference);
  EXPECT_EQ(found.doubt, "");
  const Eigen::Matrix3d back = found.pose.rotation.transpose();
  expect_undone({back, -(back * found.pose.translation)}, moved, rays, 0.05 * kDegree, 0.02);
}

TEST(AlignClouds, DoubtsWhatNothingTells) {
  const RayCloud room = room_scan(1, 30'000);
  // A flat field lies on another anywhere; a room does not lie on a field at all.
  EXPECT_NE(aligned_with(field_scan(0.0, 1), field_scan(0.0, 2)).doubt, "");
  EXPECT_NE(aligned_with(room, field_scan(0.0, 2)).doubt, "");
  EXPECT_NE(aligned_with(room, field_scan(0.5, 2)).doubt, "");
  EXPECT_NE(aligned_with(room, field_scan(0.5, 2), {.local = true}).doubt, "");
  // Far from each other, and told to look no further.
  RayCloud far = room_scan(2, 30'000);
  far.transform(moved_by(90.0, {50, 50, 0}));
  EXPECT_NE(aligned_with(far, room, {.local = true}).doubt, "");
  // A single line of a scan.
  RayCloud line = room;
  std::vector<std::uint8_t> mask(line.size());
  for (std::size_t i = 0; i < line.size(); ++i)
    mask[i] = std::abs(line.ends[i].z() - 1.0) < 0.01 ? 1 : 0;
  line.select(mask);
  EXPECT_NE(aligned_with(line, room).doubt, "");
}

/// The halves of a hall with a strip of 8 m in common. Turned by 180 degrees the walls of one lie on all of
/// the other's, and only the pillars tell that they must not.
TEST(AlignClouds, TheLessOverlapWhereNothingSpeaksAgainstIt) {
  const RayCloud west = part_of(hall_scan(1), -100.0, 4.0), reference = part_of(hall_scan(2), -4.0, 100.0);
  RayCloud rays = west;
  const Pose moved = moved_by(130.0, {30.0, -20.0, 2.0});
  rays.transform(moved);
  const CloudAlignment found = aligned_with(rays, reference);
  EXPECT_EQ(found.doubt, "");
  expect_undone(found.pose, moved, west, 0.2 * kDegree, 0.05);
  EXPECT_LT(found.overlap, 0.7);
}

/// The halves of the time in which a building was scanned, storey after storey, have little more than the
/// stairs in common; two storeys off nearly all of one lies on the other.
TEST(AlignClouds, DoubtsAnotherStorey) {
  RayCloud early = building_scan(1, 600'000);
  const double middle = 0.5 * (early.times.front() + early.times.back());
  std::vector<std::uint8_t> is_early(early.size());
  for (std::size_t i = 0; i < early.size(); ++i)
    is_early[i] = early.times[i] <= middle ? 1 : 0;
  RayCloud late = early;
  early.select(is_early);
  for (std::uint8_t& one : is_early)
    one = 1 - one;
  late.select(is_early);
  const RayCloud rays = early;
  const Pose moved = moved_by(130.0, {30.0, -20.0, 2.0});
  early.transform(moved);
  const CloudAlignment found = aligned_with(early, late);
  if (found.doubt.empty()) expect_undone(found.pose, moved, rays, 0.05 * kDegree, 0.02);
}

TEST(AlignClouds, NeedsSurfaces) {
  const RayCloud room = room_scan(1, 5000);
  RayCloud none = room;
  std::fill(none.bounded.begin(), none.bounded.end(), std::uint8_t{0});
  RayCloud place = room;
  std::fill(place.ends.begin(), place.ends.end(), Eigen::Vector3d(1, 2, 3));
  for (const RayCloud& nothing : {RayCloud(), none, place, field_scan(0.0, 1, 1)}) {
    EXPECT_THROW(static_cast<void>(aligned_with(nothing, room)), Error);
    EXPECT_THROW(static_cast<void>(aligned_with(room, nothing)), Error);
  }
}

}  // namespace
}  // namespace ray
