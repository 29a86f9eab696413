#include <raycloud/core/error.h>
#include <raycloud/exec/random.h>
#include <raycloud/spatial/voxel_key.h>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <limits>
#include <map>
#include <tuple>

namespace ray {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

double coordinate_near_border(double width) {
  const auto cube = *rc::gen::inRange<std::int64_t>(-3000000, 3000000);
  const double border = static_cast<double>(cube) * width;
  const int side = *rc::gen::inRange(-1, 2);
  return side == 0 ? border : std::nextafter(border, side * kInfinity);
}

RC_GTEST_PROP(VoxelIndex, IsTheFloorOfTheQuotient, ()) {
  const double width = *rc::gen::element(0.1, 0.001, 0.04, 0.25, 1.0, 3.0, 1.0 / 3.0);
  const Eigen::Vector3d point(coordinate_near_border(width), coordinate_near_border(width),
                              coordinate_near_border(width));
  const VoxelIndex index = voxel_index(point, {width});
  RC_ASSERT(static_cast<double>(index.x) == std::floor(point.x() / width));
  RC_ASSERT(static_cast<double>(index.y) == std::floor(point.y() / width));
  RC_ASSERT(static_cast<double>(index.z) == std::floor(point.z() / width));
}

TEST(VoxelIndex, ACubeSpansFromItsNumberToTheNext) {
  EXPECT_EQ(voxel_index({-0.25, -0.0, 0.0}, {0.25}), (VoxelIndex{-1, 0, 0}));
  EXPECT_EQ(voxel_index({-1e-300, 0.25, 0.2499999}, {0.25}), (VoxelIndex{-1, 1, 0}));
  EXPECT_EQ(voxel_index({500000.0, 6900000.0, -0.0005}, {0.001}), (VoxelIndex{500000000, 6900000000, -1}));
}

TEST(VoxelIndex, RefusesWhatItCannotNumber) {
  for (const double far : {1e30, -1e30, kInfinity, std::numeric_limits<double>::quiet_NaN(), 0x1p62}) {
    try {
      static_cast<void>(voxel_index({0.0, far, 0.0}, {1.0}));
      FAIL() << far;
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::out_of_range);
    }
  }
  EXPECT_EQ(voxel_index({0.0, 0x1p61, 0.0}, {1.0}).y, std::int64_t{1} << 61);
}

/// Points on both sides of block borders, so that different blocks hold the same key.
RC_GTEST_PROP(VoxelKeys, AgreeExactlyWhereTheCubesDo, ()) {
  const RandomStream random(*rc::gen::arbitrary<std::uint64_t>(), "voxel keys");
  const std::int64_t block = std::int64_t{1} << 21;
  std::vector<Eigen::Vector3d> points;
  for (std::size_t i = 0; i < 300; i++) {
    const auto coordinate = [&](std::uint64_t draw) {
      const auto block_number = static_cast<std::int64_t>(random.below(4, i, draw)) - 2;
      const auto cube = static_cast<std::int64_t>(random.below(4, i, draw + 1)) - 2;
      return static_cast<double>(block_number * block + block / 2 + cube) + random.uniform(i, draw + 2);
    };
    points.emplace_back(coordinate(0), coordinate(3), coordinate(6));
  }
  const VoxelKeys keys = voxel_keys(points, {1.0});
  RC_ASSERT(keys.keys.size() == points.size());
  RC_ASSERT(keys.runs.back().end == points.size());
  std::map<std::pair<VoxelIndex, std::uint64_t>, VoxelIndex> cube_of;
  std::map<VoxelIndex, std::size_t> cubes;
  std::size_t run = 0;
  for (std::size_t i = 0; i < points.size(); i++) {
    while (keys.runs[run].end <= i)
      run++;
    const VoxelIndex cube = voxel_index(points[i], {1.0});
    const auto [at, is_new] = cube_of.try_emplace({keys.runs[run].block, keys.keys[i]}, cube);
    RC_ASSERT(at->second == cube);
    RC_ASSERT(keys.keys[i] != 0U);
    cubes[cube]++;
  }
  RC_ASSERT(cubes.size() == cube_of.size());
}

TEST(VoxelKeys, NoPointsGiveNoKeys) {
  const VoxelKeys keys = voxel_keys({}, {1.0});
  EXPECT_TRUE(keys.keys.empty());
  EXPECT_TRUE(keys.runs.empty());
}

}  // namespace
}  // namespace ray
