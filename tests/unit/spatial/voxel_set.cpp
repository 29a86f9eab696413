#include <raycloud/exec/random.h>
#include <raycloud/spatial/voxel_set.h>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <tuple>

namespace ray {
namespace {

std::vector<Eigen::Vector3d> random_points(const RandomStream& random, std::size_t count, double extent,
                                           const Eigen::Vector3d& centre) {
  std::vector<Eigen::Vector3d> points(count);
  for (std::size_t i = 0; i < count; i++) {
    for (int axis = 0; axis < 3; axis++) {
      points[i][axis] = centre[axis] + extent * (random.uniform(i, static_cast<std::uint64_t>(axis)) - 0.5);
    }
  }
  return points;
}

using Cube = std::tuple<double, double, double>;

Cube brute_force_cube(const Eigen::Vector3d& p, double width) {
  return {std::floor(p.x() / width), std::floor(p.y() / width), std::floor(p.z() / width)};
}

RC_GTEST_PROP(VoxelSet, SaysWhoWasFirstAsAnOrderedSetDoes, ()) {
  const RandomStream random(*rc::gen::arbitrary<std::uint64_t>(), "voxel set");
  const Eigen::Vector3d centre = *rc::gen::element(
      Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(500000, 6900000, 100), Eigen::Vector3d(-1048.576, 3e6, -7));
  const double extent = *rc::gen::element(0.01, 1.0, 30.0);
  const double width = *rc::gen::element(0.001, 0.1, 1.0);
  const auto points = random_points(random, *rc::gen::inRange<std::size_t>(0, 5000), extent, centre);
  const std::size_t batch = *rc::gen::element<std::size_t>(1, 100, 10000);
  VoxelSet set;
  std::set<Cube> oracle;
  for (std::size_t begin = 0; begin < points.size(); begin += batch) {
    const auto part = std::span(points).subspan(begin, std::min(batch, points.size() - begin));
    const std::vector<std::uint8_t> first_seen = set.insert(voxel_keys(part, {width}));
    RC_ASSERT(first_seen.size() == part.size());
    for (std::size_t i = 0; i < part.size(); i++) {
      RC_ASSERT((first_seen[i] != 0) == oracle.insert(brute_force_cube(part[i], width)).second);
    }
  }
  RC_ASSERT(set.size() == oracle.size());
}

TEST(VoxelSet, MillimetresOverAHundredKilometresAtAUtmNorthing) {
  const auto points = random_points(RandomStream(1, "utm"), 20000, 100000.0, {500000.0, 6900000.0, 0.0});
  VoxelSet set;
  const auto first = set.insert(voxel_keys(points, {0.001}));
  EXPECT_EQ(std::count(first.begin(), first.end(), 1), 20000);
  const auto again = set.insert(voxel_keys(points, {0.001}));
  EXPECT_EQ(std::count(again.begin(), again.end(), 1), 0);
  EXPECT_EQ(set.size(), points.size());
}

TEST(VoxelSet, HoldsNoMoreThanEighteenBytesACubeAtAnyTime) {
  VoxelSet set;
  for (std::uint64_t batch = 0; batch < 200; batch++) {
    const auto points = random_points(RandomStream(batch, "memory"), 5000, 1000.0, Eigen::Vector3d::Zero());
    static_cast<void>(set.insert(voxel_keys(points, {0.01})));
    if (set.size() > 100000) {
      EXPECT_LE(set.memory(), 18 * set.size()) << set.size();
    }
  }
}

/// A solid block of cubes: neighbours differ in few bits, which must not pile up.
TEST(VoxelSet, DenseBlocksStayExact) {
  std::vector<Eigen::Vector3d> points;
  for (int x = -40; x < 40; x++) {
    for (int y = -40; y < 40; y++) {
      for (int z = -40; z < 40; z++)
        points.emplace_back(x + 0.5, y + 0.5, z + 0.5);
    }
  }
  VoxelSet set;
  const auto first = set.insert(voxel_keys(points, {1.0}));
  EXPECT_EQ(std::count(first.begin(), first.end(), 1), 512000);
  EXPECT_EQ(set.size(), 512000U);
}

}  // namespace
}  // namespace ray
