#include "support/random_cloud.h"

#include <raycloud/core/memory_stream.h>
#include <raycloud/filter/cloud_summary.h>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

namespace ray {
namespace {

using test::random_cloud;

CloudSummary summary_of(const RayCloud& cloud, unsigned threads = 2, std::size_t chunk_rays = 50) {
  MemorySource source(cloud, chunk_rays);
  return summarise_cloud({.threads = threads}, source);
}

/// Every figure, in one row, to compare bit by bit.
std::vector<double> figures(const CloudSummary& s) {
  std::vector<double> all;
  const auto add_count = [&](std::uint64_t n) { all.push_back(static_cast<double>(n)); };
  for (const std::uint64_t n : {s.rays, s.bounded, s.unbounded, s.zero_length, s.dropped, s.backward_steps}) {
    add_count(n);
  }
  for (const Bounds* bounds : {&s.starts, &s.ends, &s.bounded_ends}) {
    all.insert(all.end(), bounds->min.begin(), bounds->min.end());
    all.insert(all.end(), bounds->max.begin(), bounds->max.end());
  }
  all.insert(all.end(), {s.earliest_time, s.latest_time, s.mean_spacing.value, s.path_length.value});
  std::vector<Statistics> statistics = {s.bounded_lengths, s.red, s.green, s.blue, s.intensity};
  for (const ColumnSummary& extra : s.extras)
    statistics.push_back(extra.values);
  for (const Statistics& values : statistics) {
    add_count(values.count);
    all.insert(all.end(), {values.min, values.mean, values.max});
  }
  return all;
}

bool same_bits(const std::vector<double>& a, const std::vector<double>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0;
}

RayCloud any_cloud() {
  const auto seed = *rc::gen::arbitrary<std::uint64_t>();
  RayCloud cloud = random_cloud(
      seed, {.rays = *rc::gen::inRange<std::size_t>(0, 400), .extras = test::schema_of_every_type()});
  const RandomStream random(seed, "times");
  for (std::size_t i = 0; i < cloud.size(); i++) {
    if (random.below(4, i) == 0) cloud.times[i] = 30.0 * random.uniform(i, 1) - 10.0;
    if (random.below(9, i, 2) == 0) cloud.starts[i] = cloud.ends[i] = Eigen::Vector3d(-0.0, 0.0, -0.0);
  }
  return cloud;
}

RC_GTEST_PROP(SummariseCloud, IsTheSameBitsForAllThreadsAndChunks, ()) {
  const RayCloud cloud = any_cloud();
  const std::vector<double> expected = figures(summary_of(cloud, 1, 1000000));
  for (const unsigned threads : {1U, 2U, 3U, 8U}) {
    for (const std::size_t chunk : {1UL, 7UL, 1000000UL}) {
      RC_ASSERT(same_bits(figures(summary_of(cloud, threads, chunk)), expected));
    }
  }
}

struct Naive {
  std::vector<double> values;
  void check(const Statistics& statistics) const {
    RC_ASSERT(statistics.count == values.size());
    if (values.empty()) return;
    long double sum = 0.0L;
    for (const double value : values)
      sum += value;
    const double scale = std::max({1.0, std::abs(statistics.min), std::abs(statistics.max)});
    RC_ASSERT(std::abs(static_cast<double>(sum / static_cast<long double>(values.size())) - statistics.mean) <
              1e-12 * scale);
    RC_ASSERT(statistics.min == *std::min_element(values.begin(), values.end()));
    RC_ASSERT(statistics.max == *std::max_element(values.begin(), values.end()));
  }
};

RC_GTEST_PROP(SummariseCloud, AgreesWithTheDefinitions, ()) {
  const RayCloud cloud = any_cloud();
  const CloudSummary s = summary_of(cloud);
  Naive lengths;
  Naive red;
  Naive intensity;
  Bounds surfaces;
  std::uint64_t backward = 0;
  std::uint64_t zero = 0;
  for (std::size_t i = 0; i < cloud.size(); i++) {
    if (i > 0 && cloud.times[i] < cloud.times[i - 1]) backward++;
    if (cloud.starts[i] == cloud.ends[i]) zero++;
    if (cloud.bounded[i] == 0) continue;
    lengths.values.push_back((cloud.ends[i] - cloud.starts[i]).norm());
    red.values.push_back(cloud.colours[i].red);
    intensity.values.push_back(cloud.colours[i].intensity);
    surfaces.add(cloud.ends[i]);
  }
  RC_ASSERT(s.rays == cloud.size());
  RC_ASSERT(s.bounded == lengths.values.size());
  RC_ASSERT(s.bounded + s.unbounded == s.rays);
  RC_ASSERT(s.backward_steps == backward);
  RC_ASSERT(s.in_time_order() == std::is_sorted(cloud.times.begin(), cloud.times.end()));
  RC_ASSERT(s.zero_length == zero);
  RC_ASSERT(s.bounded_ends.min == surfaces.min);
  RC_ASSERT(s.bounded_ends.max == surfaces.max);
  lengths.check(s.bounded_lengths);
  red.check(s.red);
  intensity.check(s.intensity);
  RC_ASSERT(s.extras.size() == cloud.extras.size());
  for (std::size_t c = 0; c < cloud.extras.size(); c++) {
    Naive column;
    for (std::size_t i = 0; i < cloud.size(); i++)
      column.values.push_back(cloud.extras[c].as_double(i));
    column.check(s.extras[c].values);
    RC_ASSERT(s.extras[c].column == cloud.extras[c].info());
  }
}

/// A walk round a circle of 10 m at 1 m/s with 1 000 rays a second.
RayCloud walk() {
  RayCloud cloud = random_cloud(1, {.rays = 62832});
  for (std::size_t i = 0; i < cloud.size(); i++) {
    cloud.times[i] = static_cast<double>(i) * 0.001;
    const double angle = cloud.times[i] / 10.0;
    cloud.starts[i] = {10.0 * std::cos(angle), 10.0 * std::sin(angle), 2.0};
  }
  return cloud;
}

TEST(PathLength, OfAWalkRoundACircle) {
  EXPECT_NEAR(summary_of(walk()).path_length.value, 20.0 * std::numbers::pi, 0.01);
}

TEST(PathLength, IgnoresJitterAndTheOrderOfTheFile) {
  RayCloud cloud = walk();
  const RandomStream random(1, "jitter");
  for (std::size_t i = 0; i < cloud.size(); i++)
    cloud.starts[i].x() += 0.002 * (random.uniform(i) - 0.5);
  for (std::size_t i = 0; i < cloud.size(); i++) {
    const auto j = static_cast<std::size_t>(random.below(cloud.size(), i, 1));
    std::swap(cloud.starts[i], cloud.starts[j]);
    std::swap(cloud.times[i], cloud.times[j]);
  }
  EXPECT_NEAR(summary_of(cloud).path_length.value, 20.0 * std::numbers::pi, 0.02);
}

TEST(PathLength, OfMoreTimeThanItHasNodesForDoesNotDependOnTheChunks) {
  RayCloud cloud = random_cloud(1, {.rays = 150000});
  for (std::size_t i = 0; i < cloud.size(); i++) {
    cloud.times[i] = static_cast<double>(i) * 0.7;
    cloud.starts[i] = {cloud.times[i], 0.0, 0.0};
  }
  const double expected = cloud.times.back();
  const double length = summary_of(cloud, 1, 1000000).path_length.value;
  EXPECT_NEAR(length, expected, 1e-6);
  EXPECT_EQ(summary_of(cloud, 2, 1000).path_length.value, length);
}

TEST(SummariseCloud, NoRays) {
  const CloudSummary s = summary_of(random_cloud(1, {.rays = 0, .extras = {{"class", ScalarType::uint8}}}));
  EXPECT_EQ(s.rays, 0U);
  EXPECT_TRUE(s.starts.empty() && s.ends.empty() && s.bounded_ends.empty());
  EXPECT_EQ(s.earliest_time, 0.0);
  EXPECT_EQ(s.path_length.value, 0.0);
  EXPECT_EQ(s.mean_spacing.value, 0.0);
  ASSERT_EQ(s.extras.size(), 1U);
  EXPECT_EQ(s.extras[0].values, Statistics{});
}

TEST(SummariseCloud, OneRay) {
  RayCloud cloud = random_cloud(1, {.rays = 1});
  cloud.starts = {{1, 2, 3}};
  cloud.ends = {{4, 6, 3}};
  cloud.times = {-7.5};
  cloud.bounded = {1};
  const CloudSummary s = summary_of(cloud);
  EXPECT_EQ(s.bounded_lengths, (Statistics{1, 5.0, 5.0, 5.0}));
  EXPECT_EQ(s.earliest_time, -7.5);
  EXPECT_EQ(s.latest_time, -7.5);
  EXPECT_EQ(s.ends.min, cloud.ends[0]);
  EXPECT_EQ(s.path_length.value, 0.0);
}

TEST(SummariseCloud, CountsInvalidRowsAndLeavesNaNOutOfColumns) {
  RayCloud cloud = random_cloud(1, {.rays = 4, .extras = {{"range", ScalarType::float32}}});
  cloud.ends[1].y() = std::numeric_limits<double>::quiet_NaN();
  const auto range = cloud.extras[0].values<float>();
  range[0] = 2.0F;
  range[1] = 100.0F;
  range[2] = std::numeric_limits<float>::quiet_NaN();
  range[3] = 4.0F;
  const CloudSummary s = summary_of(cloud);
  EXPECT_EQ(s.dropped, 1U);
  EXPECT_EQ(s.rays, 3U);
  EXPECT_EQ(s.extras[0].values, (Statistics{2, 2.0, 3.0, 4.0}));
}

TEST(SummariseCloud, SpacingIsThatOfTheSurfaces) {
  RayCloud cloud = random_cloud(1, {.rays = 40000});
  for (std::size_t i = 0; i < cloud.size(); i++) {
    cloud.ends[i] = {0.05 * static_cast<double>(i % 200), 0.05 * static_cast<double>(i / 200), 1.0};
    cloud.bounded[i] = 1;
  }
  EXPECT_NEAR(summary_of(cloud).mean_spacing.value, 0.05, 0.025);
}

}  // namespace
}  // namespace ray
