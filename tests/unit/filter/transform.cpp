#include "support/random_cloud.h"

#include <raycloud/core/error.h>
#include <raycloud/core/memory_stream.h>
#include <raycloud/filter/transform.h>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>

namespace ray {
namespace {

using test::random_cloud;
using test::same_bits;

RayCloud moved(const RayCloud& cloud, const Pose& pose, Seconds shift = {}, unsigned threads = 1,
               std::size_t chunk_rays = 100) {
  MemorySource source(cloud, chunk_rays);
  MemorySink sink(source.info().extras);
  const StreamCounts counts = transform_cloud({.threads = threads}, source, sink, pose, shift);
  EXPECT_EQ(counts.rays_out, cloud.size());
  return sink.cloud();
}

RayCloud cloud_to_move() {
  return random_cloud(
      *rc::gen::arbitrary<std::uint64_t>(),
      {.rays = *rc::gen::inRange<std::size_t>(0, 300),
       .centre = *rc::gen::element(Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(500000, 6900000, 100)),
       .extras = test::schema_of_every_type()});
}

Eigen::Vector3d any_vector(int most) {
  const auto component = [&] { return *rc::gen::inRange(-1000, 1000) * most / 1000.0; };
  return {component(), component(), component()};
}

double largest_difference(const RayCloud& a, const RayCloud& b) {
  double largest = 0.0;
  for (std::size_t i = 0; i < a.size(); i++) {
    largest = std::max({largest, (a.starts[i] - b.starts[i]).norm(), (a.ends[i] - b.ends[i]).norm()});
  }
  return largest;
}

/// Everything that a move in space must not touch.
bool same_but_for_place(const RayCloud& a, const RayCloud& b) {
  RayCloud placed = a;
  placed.starts = b.starts;
  placed.ends = b.ends;
  return same_bits(placed, b);
}

RC_GTEST_PROP(TransformCloud, ThereAndBackIsTheSameToRounding, ()) {
  const RayCloud cloud = cloud_to_move();
  const Eigen::Vector3d v = any_vector(6);
  const RayCloud turned = moved(moved(cloud, rotation_pose(v)), rotation_pose(-v));
  RC_ASSERT(largest_difference(turned, cloud) < 2e-8);
  RC_ASSERT(same_but_for_place(turned, cloud));
  const Eigen::Vector3d offset = any_vector(10000);
  const RayCloud pushed = moved(moved(cloud, translation_pose(offset)), translation_pose(-offset));
  RC_ASSERT(largest_difference(pushed, cloud) < 1e-8);
  RC_ASSERT(same_but_for_place(pushed, cloud));
}

RC_GTEST_PROP(TransformCloud, IsTheProductOfEveryPointInAnyChunks, ()) {
  const RayCloud cloud = cloud_to_move();
  Pose pose = rotation_pose(any_vector(3));
  pose.translation = any_vector(100);
  RayCloud expected = cloud;
  for (std::size_t i = 0; i < cloud.size(); i++) {
    expected.starts[i] = pose * cloud.starts[i];
    expected.ends[i] = pose * cloud.ends[i];
    expected.times[i] = cloud.times[i] + 12.5;
  }
  for (const unsigned threads : {1U, 2U, 3U, 8U}) {
    for (const std::size_t chunk : {1UL, 7UL, 1000000UL}) {
      RC_ASSERT(same_bits(moved(cloud, pose, {12.5}, threads, chunk), expected));
    }
  }
}

RC_GTEST_PROP(TransformCloud, KeepsDistances, ()) {
  const RayCloud cloud = cloud_to_move();
  const RayCloud turned = moved(cloud, rotation_pose(any_vector(6)));
  for (std::size_t i = 0; i < cloud.size(); i++) {
    const double before = (cloud.ends[i] - cloud.starts[i]).norm();
    RC_ASSERT(std::abs((turned.ends[i] - turned.starts[i]).norm() - before) < 1e-8);
  }
}

TEST(TransformCloud, TheIdentityKeepsEveryBit) {
  RayCloud cloud = random_cloud(1, {.rays = 50, .extras = test::schema_of_every_type()});
  cloud.ends[0] = {-0.0, 5e-324, -0.0};
  cloud.times[0] = -0.0;
  EXPECT_TRUE(same_bits(moved(cloud, {}), cloud));
  EXPECT_TRUE(same_bits(moved(cloud, rotation_pose({0, 0, 0}), {0.0}), cloud));
}

TEST(TransformCloud, AShiftInTimeLeavesThePlace) {
  const RayCloud cloud = random_cloud(2, {.rays = 50});
  const RayCloud later = moved(cloud, {}, {0.25});
  RayCloud expected = cloud;
  for (double& time : expected.times)
    time += 0.25;
  EXPECT_TRUE(same_bits(later, expected));
}

TEST(TransformCloud, RefusesNumbersThatAreNotFinite) {
  const RayCloud cloud = random_cloud(3, {.rays = 1});
  EXPECT_THROW(static_cast<void>(moved(cloud, translation_pose({0, 0, HUGE_VAL}))), Error);
  EXPECT_THROW(static_cast<void>(moved(cloud, {}, {std::nan("")})), Error);
}

}  // namespace
}  // namespace ray
