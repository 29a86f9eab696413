#include "decimated.h"
#include "support/random_cloud.h"

#include <raycloud/core/error.h>
#include <raycloud/core/memory_stream.h>
#include <raycloud/filter/decimate.h>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <limits>
#include <set>
#include <tuple>

namespace ray {
namespace {

using test::expect_however_it_runs;
using test::random_cloud;
using test::same_bits;
using test::thinned;

auto by_width(double width) {
  return [width](const Context& context, RaySource& source, RaySink& sink) {
    return decimate_voxels(context, source, sink, {width});
  };
}

auto by_number(std::uint64_t n) {
  return [n](const Context& context, RaySource& source, RaySink& sink) {
    return decimate_every(context, source, sink, n);
  };
}

RayCloud first_in_each_cube(RayCloud cloud, double width) {
  std::set<std::tuple<double, double, double>> seen;
  std::vector<std::uint8_t> mask;
  for (const Eigen::Vector3d& end : cloud.ends) {
    const Eigen::Vector3d cube = (end / width).array().floor();
    mask.push_back(seen.emplace(cube.x(), cube.y(), cube.z()).second ? 1 : 0);
  }
  cloud.select(mask);
  return cloud;
}

RC_GTEST_PROP(DecimateVoxels, KeepsTheFirstRayOfEveryCubeAndAllItsColumns, ()) {
  RayCloud cloud = random_cloud(
      *rc::gen::arbitrary<std::uint64_t>(),
      {.rays = *rc::gen::inRange<std::size_t>(0, 400),
       .centre = *rc::gen::element(Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(500000, 6900000, 100)),
       .half_extent = *rc::gen::element(0.5, 5.0, 200.0),
       .extras = test::schema_of_every_type()});
  const double width = *rc::gen::element(0.1, 1.0, 2.5, 0.001);
  for (std::size_t i = 0; i < cloud.size(); i += 3) {  // some exactly on borders
    cloud.ends[i] = (cloud.ends[i] / width).array().round() * width;
  }
  expect_however_it_runs(cloud, first_in_each_cube(cloud, width), by_width(width));
}

RC_GTEST_PROP(DecimateVoxels, TwiceIsOnce, ()) {
  const RayCloud cloud =
      random_cloud(*rc::gen::arbitrary<std::uint64_t>(), {.rays = 300, .half_extent = 2.0});
  const RayCloud once = thinned(cloud, {.threads = 2}, 64, by_width(0.7));
  RC_ASSERT(once.size() < cloud.size());
  RC_ASSERT(same_bits(thinned(once, {.threads = 2}, 64, by_width(0.7)), once));
}

TEST(DecimateVoxels, EndsOfUnboundedRaysCountAsAnyOther) {
  RayCloud cloud = random_cloud(1, {.rays = 3});
  cloud.ends = {{0.1, 0.1, 0.1}, {0.2, 0.2, 0.2}, {-0.1, 0.1, 0.1}};
  cloud.bounded = {0, 1, 0};
  const RayCloud out = thinned(cloud, {.threads = 1}, 10, by_width(1.0));
  ASSERT_EQ(out.size(), 2U);
  EXPECT_EQ(out.ends[0], cloud.ends[0]);
  EXPECT_EQ(out.ends[1], cloud.ends[2]);
}

RC_GTEST_PROP(DecimateEvery, KeepsRaysWhoseNumberIsAMultiple, ()) {
  const RayCloud cloud =
      random_cloud(*rc::gen::arbitrary<std::uint64_t>(),
                   {.rays = *rc::gen::inRange<std::size_t>(0, 200), .extras = test::schema_of_every_type()});
  const auto n = *rc::gen::element<std::uint64_t>(1, 2, 3, 10, 199, 1000, ~std::uint64_t{0});
  RayCloud expected = cloud;
  std::vector<std::uint8_t> mask(cloud.size());
  for (std::size_t i = 0; i < mask.size(); i++)
    mask[i] = i % n == 0 ? 1 : 0;
  expected.select(mask);
  expect_however_it_runs(cloud, expected, by_number(n));
}

TEST(DecimateEvery, CountsValidRaysOnly) {
  RayCloud cloud = random_cloud(2, {.rays = 10});
  cloud.times[0] = std::numeric_limits<double>::quiet_NaN();
  cloud.ends[4].x() = std::numeric_limits<double>::infinity();
  for (const std::size_t chunk : {1UL, 3UL, 100UL}) {
    const RayCloud out = thinned(cloud, {.threads = 2}, chunk, by_number(3));  // of 1 2 3 5 6 7 8 9
    ASSERT_EQ(out.size(), 3U);
    EXPECT_EQ(out.ends[0], cloud.ends[1]);
    EXPECT_EQ(out.ends[1], cloud.ends[5]);
    EXPECT_EQ(out.ends[2], cloud.ends[8]);
  }
}

TEST(Decimate, RefusesWidthsAndNumbersThatMakeNoSense) {
  for (const double width : {0.0, -0.1, std::nan(""), HUGE_VAL}) {
    EXPECT_EQ(code_of(by_width(width)), ErrorCode::usage) << width;
  }
  EXPECT_EQ(code_of(by_number(0)), ErrorCode::usage);
  EXPECT_EQ(code_of(by_width(1e-300)), ErrorCode::out_of_range);
}

}  // namespace
}  // namespace ray
