#include <raycloud/exec/random.h>
#include <raycloud/spatial/point_sample.h>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <numeric>

namespace ray {
namespace {

std::vector<Eigen::Vector3d> float_points(std::uint64_t seed, std::size_t count) {
  const RandomStream random(seed, "sample");
  std::vector<Eigen::Vector3d> points(count);
  for (std::size_t i = 0; i < count; i++) {
    points[i] = Eigen::Vector3d(random.uniform(i, 0), random.uniform(i, 1), random.uniform(i, 2))
                    .cast<float>()
                    .cast<double>();
  }
  return points;
}

std::vector<Eigen::Vector3d> sample_of(std::span<const Eigen::Vector3d> points, std::size_t capacity,
                                       std::size_t chunk) {
  PointSample sample(capacity);
  const std::vector<std::uint8_t> mask(points.size(), 1);
  for (std::size_t begin = 0; begin < points.size(); begin += chunk) {
    const std::size_t count = std::min(chunk, points.size() - begin);
    sample.add(sample.candidates(points.subspan(begin, count), std::span(mask).subspan(begin, count)));
  }
  return sample.points();
}

RC_GTEST_PROP(PointSample, DependsOnThePointsOnly, ()) {
  std::vector<Eigen::Vector3d> points =
      float_points(*rc::gen::arbitrary<std::uint64_t>(), *rc::gen::inRange<std::size_t>(0, 3000));
  const auto capacity = *rc::gen::inRange<std::size_t>(1, 1500);
  const auto expected = sample_of(points, capacity, 1000000);
  RC_ASSERT(expected.size() <= capacity);
  if (points.size() <= capacity) RC_ASSERT(expected == points);
  RC_ASSERT(sample_of(points, capacity, 1) == expected);
  RC_ASSERT(sample_of(points, capacity, 77) == expected);
  std::reverse(points.begin(), points.end());
  auto reversed = sample_of(points, capacity, 13);
  std::reverse(reversed.begin(), reversed.end());
  RC_ASSERT(reversed == expected);
}

TEST(PointSample, IsEven) {
  const auto sample = sample_of(float_points(7, 200000), 10000, 1000);
  EXPECT_GT(sample.size(), 4000U);
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& point : sample)
    mean += point / static_cast<double>(sample.size());
  EXPECT_LT((mean - Eigen::Vector3d::Constant(0.5)).norm(), 0.03);
}

TEST(PointSample, LeavesOutWhatTheMaskDoes) {
  const std::vector<Eigen::Vector3d> points = {{1, 2, 3}, {4, 5, 6}, {7, 8, 9}};
  const std::vector<std::uint8_t> mask = {0, 1, 0};
  PointSample sample(10);
  sample.add(sample.candidates(points, mask));
  EXPECT_EQ(sample.points(), std::vector<Eigen::Vector3d>{Eigen::Vector3d(4, 5, 6)});
}

TEST(PointSample, CopiesOfOnePointStayWithinTheCapacity) {
  const std::vector<Eigen::Vector3d> points(1000, Eigen::Vector3d(1, 2, 3));
  EXPECT_LE(sample_of(points, 10, 100).size(), 10U);
}

}  // namespace
}  // namespace ray
