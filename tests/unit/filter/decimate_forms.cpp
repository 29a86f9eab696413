#include "decimated.h"
#include "support/random_cloud.h"

#include <raycloud/core/error.h>
#include <raycloud/filter/decimate.h>
#include <raycloud/spatial/crossed_cubes.h>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <tuple>

namespace ray {
namespace {

using test::expect_however_it_runs;
using test::random_cloud;
using test::same_bits;
using test::thinned;
using Cube = std::tuple<double, double, double>;

Cube cube_of(const Eigen::Vector3d& point, double width) {
  return {std::floor(point.x() / width), std::floor(point.y() / width), std::floor(point.z() / width)};
}

RayCloud any_cloud(std::size_t most_rays) {
  return random_cloud(
      *rc::gen::arbitrary<std::uint64_t>(),
      {.rays = *rc::gen::inRange<std::size_t>(0, most_rays),
       .centre = *rc::gen::element(Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(500000, 6900000, 100)),
       .half_extent = *rc::gen::element(0.5, 5.0, 50.0),
       .extras = test::schema_of_every_type()});
}

RC_GTEST_PROP(DecimateToCount, KeepsTheFirstFewRaysOfEveryCube, ()) {
  const RayCloud cloud = any_cloud(300);
  const double width = *rc::gen::element(0.1, 1.0, 40.0);
  const auto most = *rc::gen::element<std::uint64_t>(1, 2, 5, 64, 4294967295);
  RayCloud expected = cloud;
  std::map<Cube, std::uint64_t> counts;
  std::vector<std::uint8_t> mask;
  for (const Eigen::Vector3d& end : cloud.ends)
    mask.push_back(++counts[cube_of(end, width)] <= most ? 1 : 0);
  expected.select(mask);
  expect_however_it_runs(cloud, expected, [&](const Context& context, RaySource& source, RaySink& sink) {
    return decimate_to_count(context, source, sink, {width}, most);
  });
}

/// The cubes of a ray, one by one.
std::set<std::tuple<VoxelIndex, std::uint64_t, int>> path_of(const RayCloud& cloud, std::size_t i,
                                                             double width) {
  const CrossedCubes crossed = crossed_cubes({&cloud.starts[i], 1}, {&cloud.ends[i], 1}, {width},
                                             std::numeric_limits<std::size_t>::max());
  std::set<std::tuple<VoxelIndex, std::uint64_t, int>> cubes;
  std::size_t k = 0;
  for (const VoxelKeys::Run& run : crossed.bricks.runs) {
    for (; k < run.end; k++) {
      for (int bit = 0; bit < 64; bit++) {
        if ((crossed.cubes[k] >> bit & 1) != 0) cubes.emplace(run.block, crossed.bricks.keys[k], bit);
      }
    }
  }
  return cubes;
}

auto by_path(double width) {
  return [width](const Context& context, RaySource& source, RaySink& sink) {
    return decimate_paths(context, source, sink, {width});
  };
}

RC_GTEST_PROP(DecimatePaths, DropsRaysThatCrossNothingNew, ()) {
  RayCloud cloud = any_cloud(120);
  const double width = *rc::gen::element(0.3, 2.0, 20.0);
  const bool one_sensor = *rc::gen::arbitrary<bool>();
  for (std::size_t i = 0; one_sensor && i < cloud.size(); i++)
    cloud.starts[i] = cloud.ends[0];
  RayCloud expected = cloud;
  std::set<std::tuple<VoxelIndex, std::uint64_t, int>> crossed;
  std::vector<std::uint8_t> mask;
  for (std::size_t i = 0; i < cloud.size(); i++) {
    const std::size_t before = crossed.size();
    crossed.merge(path_of(cloud, i, width));
    mask.push_back(crossed.size() > before ? 1 : 0);
  }
  expected.select(mask);
  expect_however_it_runs(cloud, expected, by_path(width));
}

TEST(DecimatePaths, ARayWithinAnotherGoesAndALongerOneStays) {
  RayCloud cloud = random_cloud(1, {.rays = 4});
  for (Eigen::Vector3d& start : cloud.starts)
    start = {0.5, 0.5, 0.5};
  cloud.ends = {{5.5, 0.5, 0.5}, {3.5, 0.6, 0.4}, {9.5, 0.5, 0.5}, {0.5, 0.5, 0.5}};
  const RayCloud out = thinned(cloud, {.threads = 1}, 10, by_path(1.0));
  ASSERT_EQ(out.size(), 2U);
  EXPECT_EQ(out.ends[1], cloud.ends[2]);
}

TEST(DecimatePaths, MoreBricksThanAreHeldAtATime) {
  const RayCloud cloud = random_cloud(7, {.rays = 3000, .half_extent = 500.0});  // 100 bricks and more a ray
  const RayCloud expected = thinned(cloud, {.threads = 1}, 10, by_path(1.0));
  EXPECT_TRUE(same_bits(thinned(cloud, {.threads = 2}, 100000, by_path(1.0)), expected));
}

/// So many rays through few cubes that most bricks become full, looked at by every number of threads.
TEST(DecimatePaths, ADenseCloudHoweverItRuns) {
  RayCloud cloud = random_cloud(11, {.rays = 6000, .half_extent = 3.0});
  for (std::size_t i = 0; i < cloud.size(); i++)
    cloud.starts[i] = Eigen::Vector3d(-0.1, 0.1, 0.3) + 0.1 * cloud.starts[i % 50];
  RayCloud expected = cloud;
  std::set<std::tuple<VoxelIndex, std::uint64_t, int>> crossed;
  std::vector<std::uint8_t> mask;
  for (std::size_t i = 0; i < cloud.size(); i++) {
    const std::size_t before = crossed.size();
    crossed.merge(path_of(cloud, i, 0.25));
    mask.push_back(crossed.size() > before ? 1 : 0);
  }
  expected.select(mask);
  ASSERT_LT(expected.size(), cloud.size() / 2);
  for (const unsigned threads : {1U, 2U, 3U, 8U})
    EXPECT_TRUE(same_bits(thinned(cloud, {.threads = threads}, 100, by_path(0.25)), expected)) << threads;
  for (const std::size_t memory : {1U, 60000U, 300000U}) {
    const Context context{.threads = 2, .memory = memory};
    EXPECT_TRUE(same_bits(thinned(cloud, context, 500, by_path(0.25)), expected)) << memory;
  }
}

auto by_range(double per_metre) {
  return [per_metre](const Context& context, RaySource& source, RaySink& sink) {
    return decimate_by_range(context, source, sink, per_metre);
  };
}

/// As the header defines it, by looking at all rays kept before.
RayCloud thinned_by_range(RayCloud cloud, double per_metre) {
  struct Kept {
    Eigen::Vector3d end;
    double width;
  };
  std::vector<Kept> kept;
  std::vector<std::uint8_t> mask(cloud.size());
  for (std::size_t i = 0; i < cloud.size(); i++) {
    const double spacing = per_metre * (cloud.ends[i] - cloud.starts[i]).norm();
    const double width = std::exp2(std::floor(std::log2(spacing)));
    mask[i] = 1;
    if (spacing < std::exp2(-20)) continue;
    for (const Kept& other : kept) {
      if (other.width <= width && cube_of(other.end, width) == cube_of(cloud.ends[i], width)) mask[i] = 0;
    }
    if (mask[i] != 0) kept.push_back({cloud.ends[i], width});
  }
  cloud.select(mask);
  return cloud;
}

RC_GTEST_PROP(DecimateByRange, IsWhatItsDefinitionSays, ()) {
  const RayCloud cloud = any_cloud(200);
  const double per_metre = *rc::gen::element(0.001, 0.03, 0.3, 5.0);
  expect_however_it_runs(cloud, thinned_by_range(cloud, per_metre), by_range(per_metre));
}

TEST(DecimateByRange, RaysWithoutLengthStay) {
  RayCloud cloud = random_cloud(1, {.rays = 5});
  cloud.ends.assign(5, {1.0, 2.0, 3.0});
  cloud.starts = cloud.ends;
  EXPECT_TRUE(same_bits(thinned(cloud, {.threads = 2}, 2, by_range(0.03)), cloud));
}

TEST(Decimate, AMillionRaysInLittleMemory) {
  const RayCloud cloud = random_cloud(5, {.rays = 1000000, .half_extent = 30.0});
  const Context plenty{.threads = 2}, little{.threads = 2, .memory = 3000000};
  const auto by_width = [](const Context& context, RaySource& source, RaySink& sink) {
    return decimate_voxels(context, source, sink, {0.5});
  };
  EXPECT_TRUE(same_bits(thinned(cloud, plenty, 32768, by_width), thinned(cloud, little, 32768, by_width)));
  EXPECT_TRUE(same_bits(thinned(cloud, plenty, 32768, by_range(0.03)),
                        thinned(cloud, little, 32768, by_range(0.03))));
}

TEST(Decimate, EveryFormRefusesWhatMakesNoSense) {
  const auto to_count = [](double width, std::uint64_t most) {
    return [=](const Context& context, RaySource& source, RaySink& sink) {
      return decimate_to_count(context, source, sink, {width}, most);
    };
  };
  for (const double width : {0.0, -0.1, std::nan(""), HUGE_VAL}) {
    EXPECT_EQ(code_of(by_path(width)), ErrorCode::usage) << width;
    EXPECT_EQ(code_of(by_range(width)), ErrorCode::usage) << width;
    EXPECT_EQ(code_of(to_count(width, 3)), ErrorCode::usage) << width;
  }
  EXPECT_EQ(code_of(to_count(1.0, 0)), ErrorCode::usage);
  EXPECT_EQ(code_of(to_count(1.0, std::uint64_t{1} << 32)), ErrorCode::usage);
  EXPECT_EQ(code_of(to_count(1e-300, 1)), ErrorCode::out_of_range);
  EXPECT_EQ(code_of(by_path(1e-300)), ErrorCode::out_of_range);
  EXPECT_EQ(code_of(by_path(1e-9)), ErrorCode::out_of_range);
}

}  // namespace
}  // namespace ray
