/// Merging and comparing clouds that do not fit the memory, against all at once.

#include "support/random_cloud.h"
#include "volume/same_rays.h"

#include <raycloud/core/memory_stream.h>
#include <raycloud/exec/random.h>
#include <raycloud/exec/stream.h>
#include <raycloud/volume/compare_clouds.h>
#include <raycloud/volume/merge_clouds.h>
#include <raycloud/volume/three_way.h>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <array>
#include <cmath>

namespace ray {
namespace {

using namespace test;

/// A sensor goes along a way of 60 m, hundreds of times as long as its points are apart, and looks ahead and
/// down, at boards that stand across the way every 3 m: of those with that remainder by 3.
RayCloud scan_of_way(long remainder, double begin, std::size_t rays) {
  const RandomStream random(static_cast<std::uint64_t>(remainder + 1), "way");
  RayCloud cloud;
  cloud.resize(rays);
  for (std::size_t i = 0; i < rays; ++i) {
    const double at = 60.0 * static_cast<double>(i) / static_cast<double>(rays);
    const Eigen::Vector3d start(at, 0.0, 0.6);
    const Eigen::Vector3d way(1.0, 0.1 * random.uniform(i, 0) - 0.05, -0.4 - random.uniform(i, 1));
    const double noise = 0.004 * (random.uniform(i, 2) + random.uniform(i, 3) - 1.0);
    const double far = (0.6 + noise) / -way.z();
    const double next = 3.0 * std::ceil(at / 3.0);
    const bool on_board = std::lround(next / 3.0) % 3 == remainder && next - at < far;
    cloud.starts[i] = start;
    cloud.ends[i] = start + (on_board ? next - at + noise : far) * way;
    cloud.times[i] = begin + at;
    cloud.bounded[i] = random.uniform(i, 4) < 0.95 ? 1 : 0;
  }
  return cloud;
}

/// The third has some rays of the first too.
const std::vector<RayCloud>& scans_of_way() {
  static const std::vector<RayCloud> scans = [] {
    std::vector<RayCloud> clouds{scan_of_way(0, 0.0, 3000), scan_of_way(1, 500.0, 2500),
                                 scan_of_way(2, -200.0, 1500)};
    std::vector<std::uint32_t> rows;
    for (std::uint32_t row = 1000; row < 1800; ++row)
      rows.push_back(row);
    RayCloud some;
    some.assign_rows(clouds[0], rows);
    clouds[2].append(some);
    return clouds;
  }();
  return scans;
}

struct TwoHalves {
  RayCloud combined, differences;
};

TwoHalves merged_halves(std::span<const RayCloud> clouds, const MergeRule& rule, std::size_t memory,
                        std::size_t chunk_rays = 500) {
  std::vector<MemorySource> sources;
  std::vector<RaySource*> pointers;
  for (const RayCloud& cloud : clouds)
    sources.emplace_back(cloud, chunk_rays);
  for (MemorySource& source : sources)
    pointers.push_back(&source);
  MemorySink combined(schema_of(clouds.front())), differences(schema_of(clouds.front()));
  merge_clouds({.memory = memory}, pointers, combined, &differences, rule);
  return {combined.cloud(), differences.cloud()};
}

TEST(ConflictBlocks, mergeAsAllAtOnce) {
  const std::span<const RayCloud> scans(scans_of_way());
  const MergeRule rules[]{{.merge = CloudMerge::min, .rays = 3.0},
                          {.merge = CloudMerge::max, .rays = 3.0},
                          {.merge = CloudMerge::newest, .rays = 3.0},
                          {.merge = CloudMerge::order, .rays = 3.0},
                          {.merge = CloudMerge::oldest, .rays = 3.0, .paper = true}};
  for (const MergeRule& rule : rules) {
    const std::size_t clouds = rule.merge == CloudMerge::max ? 2 : 3;
    const TwoHalves whole = merged_halves(scans.first(clouds), rule, 0);
    EXPECT_GT(whole.differences.size(), 100U);
    const TwoHalves blocks = merged_halves(scans.first(clouds), rule, 100 << 10);
    EXPECT_TRUE(same_bits(blocks.combined, whole.combined)) << static_cast<int>(rule.merge);
    EXPECT_TRUE(same_bits(blocks.differences, whole.differences)) << static_cast<int>(rule.merge);
  }
}

/// With everything in everybody's reach, fewer rays than blocks, and some rays in several clouds.
RC_GTEST_PROP(ConflictBlocks, mergeAsAllAtOnceForFewRays, (std::uint64_t seed)) {
  const RayCloud all = random_cloud(seed, {.rays = 200, .half_extent = 2.0, .extras = {}});
  std::vector<RayCloud> clouds(*rc::gen::inRange<std::size_t>(1, 4));
  for (RayCloud& cloud : clouds)
    cloud.assign_rows(
        all, *rc::gen::container<std::vector<std::uint32_t>>(*rc::gen::inRange<std::size_t>(1, 150),
                                                             rc::gen::inRange<std::uint32_t>(0, 200)));
  const MergeRule rule{
      .merge = *rc::gen::element(CloudMerge::all, CloudMerge::min, CloudMerge::max, CloudMerge::order),
      .rays = *rc::gen::element(0.1, 1.0, 5.0),
      .paper = *rc::gen::element(false, true)};
  const TwoHalves whole = merged_halves(clouds, rule, 0);
  const TwoHalves blocks = merged_halves(clouds, rule, *rc::gen::inRange<std::size_t>(1000, 20000), 7);
  RC_ASSERT(same_bits(blocks.combined, whole.combined));
  RC_ASSERT(same_bits(blocks.differences, whole.differences));
}

CloudComparison compared(const RayCloud& first, const RayCloud& second, const DifferenceRule& rule,
                         std::size_t memory) {
  MemorySource a(first, 500), b(second, 500);
  return compare_clouds({.memory = memory}, a, b, rule);
}

void expect_same(const CloudComparison& blocks, const CloudComparison& whole) {
  EXPECT_EQ(blocks.distance, whole.distance);
  EXPECT_EQ(blocks.similarity, whole.similarity);
  for (std::size_t cloud = 0; cloud < 2; ++cloud) {
    EXPECT_EQ(blocks.clouds[cloud].differences, whole.clouds[cloud].differences);
    EXPECT_EQ(blocks.clouds[cloud].distances, whole.clouds[cloud].distances);
  }
  for (std::size_t kind = 0; kind < kDifferences; ++kind) {
    EXPECT_EQ(blocks.totals[kind].rays, whole.totals[kind].rays);
    EXPECT_EQ(blocks.totals[kind].area, whole.totals[kind].area);
    EXPECT_EQ(blocks.totals[kind].volume, whole.totals[kind].volume);
  }
}

TEST(ConflictBlocks, compareAsAllAtOnce) {
  const RayCloud &first = scans_of_way()[0], &second = scans_of_way()[1];
  for (const DifferenceRule& rule :
       {DifferenceRule{.rays = 3.0}, DifferenceRule{.distance = 0.4, .rays = 3.0}}) {
    const CloudComparison whole = compared(first, second, rule, 0);
    EXPECT_GT(whole.of(Difference::added).rays, 50U);
    EXPECT_GT(whole.of(Difference::removed).rays, 50U);
    // All but the ends in memory, and nothing.
    for (const std::size_t memory : {500UL << 10, 60UL << 10})
      expect_same(compared(first, second, rule, memory), whole);
  }
  const RayCloud none;
  expect_same(compared(first, none, {}, 60 << 10), compared(first, none, {}, 0));
}

/// Whether all rays of one key come together, however they are parted.
RC_GTEST_PROP(ConflictBlocks, sameRaysComeTogether, (std::uint64_t seed)) {
  const RayCloud all = random_cloud(seed, {.rays = 60, .extras = {}});
  std::vector<MemorySource> sources;
  std::vector<RayCloud> clouds(3);
  for (RayCloud& cloud : clouds) {
    cloud.assign_rows(
        all, *rc::gen::container<std::vector<std::uint32_t>>(*rc::gen::inRange<std::size_t>(1, 80),
                                                             rc::gen::inRange<std::uint32_t>(0, 60)));
    sources.emplace_back(cloud, 9);
  }
  const std::array<RaySource*, 3> pointers{&sources[0], &sources[1], &sources[2]};
  const auto leaders = [&](std::size_t memory) {
    const Context context{.memory = memory};
    NumberedRays numbered(context, pointers, {});
    return leaders_of(context, numbered);
  };
  RC_ASSERT(leaders(*rc::gen::inRange<std::size_t>(1, 5000)) == leaders(0));
}

TEST(ConflictBlocks, threeWaysAsAllAtOnce) {
  RayCloud base = scans_of_way()[0], one = base, two = base;
  one.append(scans_of_way()[1]);
  two.append(scans_of_way()[2]);
  std::vector<std::uint8_t> mask(two.size());
  for (std::size_t i = 0; i < mask.size(); ++i)
    mask[i] = i % 3 == 0 ? 0 : 1;
  two.select(mask);
  const auto result = [&](std::size_t memory) {
    const Context context{.memory = memory};
    MemorySource a(base, 500), b(one, 500), c(two, 500);
    const ThreeWay parts(context, {&a, &b, &c}, three_way_columns({}));
    MemorySink kept, combined, differences;
    stream_each(context, *parts.kept(), kept, [](const RayCloud&) {});
    const auto added1 = parts.added(0), added2 = parts.added(1);
    const std::array<RaySource*, 2> added{added1.get(), added2.get()};
    merge_clouds(context, added, combined, &differences, {.merge = CloudMerge::min, .rays = 3.0});
    return std::array{kept.cloud(), combined.cloud(), differences.cloud()};
  };
  const auto whole = result(0), blocks = result(60 << 10);
  for (std::size_t i = 0; i < whole.size(); ++i) {
    EXPECT_GT(whole[i].size(), 50U);
    EXPECT_TRUE(same_bits(whole[i], blocks[i])) << i;
  }
}

}  // namespace
}  // namespace ray
