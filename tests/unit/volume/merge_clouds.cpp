/// Merging clouds: a wall, before which a board stands in one scan and not in the other.

#include "support/random_cloud.h"

#include <raycloud/core/error.h>
#include <raycloud/core/memory_stream.h>
#include <raycloud/exec/random.h>
#include <raycloud/volume/merge_clouds.h>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <string>

namespace ray {
namespace {

using namespace test;

struct Merged {
  RayCloud combined, differences;
  MergeCounts counts;
};

Merged merge(const std::vector<RayCloud>& clouds, const MergeRule& rule, const Context& context = {},
             std::size_t chunk_rays = 1000) {
  std::vector<MemorySource> sources;
  std::vector<RaySource*> pointers;
  for (const RayCloud& cloud : clouds)
    sources.emplace_back(cloud, chunk_rays);
  for (MemorySource& source : sources)
    pointers.push_back(&source);
  MemorySink combined(schema_of(clouds.front())), differences(schema_of(clouds.front()));
  const MergeCounts counts = merge_clouds(context, pointers, combined, &differences, rule);
  EXPECT_EQ(counts.combined, combined.cloud().size());
  EXPECT_EQ(counts.differences, differences.cloud().size());
  EXPECT_EQ(counts.combined + counts.differences + counts.repeated, counts.stream.rays_in);
  return {combined.cloud(), differences.cloud(), counts};
}

/// All bytes of each ray.
std::vector<std::string> rows_of_bytes(const RayCloud& cloud) {
  std::vector<std::string> rows(cloud.size());
  const auto add = [&](std::size_t i, const void* data, std::size_t bytes) {
    rows[i].append(static_cast<const char*>(data), bytes);
  };
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    add(i, cloud.starts[i].data(), sizeof cloud.starts[i]);
    add(i, cloud.ends[i].data(), sizeof cloud.ends[i]);
    add(i, &cloud.times[i], sizeof cloud.times[i]);
    add(i, &cloud.colours[i], sizeof cloud.colours[i]);
    add(i, &cloud.bounded[i], 1);
    for (const Column& column : cloud.extras)
      add(i, column.data() + i * column.stride(), column.stride());
  }
  return rows;
}

std::vector<std::string> sorted_rows(const RayCloud& cloud) {
  std::vector<std::string> rows = rows_of_bytes(cloud);
  std::sort(rows.begin(), rows.end());
  return rows;
}

enum Target : std::uint8_t { kBack, kBoard, kAbove };

struct Scan {
  bool board = false;
  std::uint64_t seed = 1;
  double begin = 0.0;  ///< s
  std::size_t rays = 20000;
  double gaps = 0.0;  ///< of the board: this share of the rays goes through
};

/// A sensor walks along x for a minute and looks at a wall in y = 8, over which there is the sky. The board,
/// 2 m wide, is in y = 4.
RayCloud scan_of_wall(const Scan& scan) {
  const RandomStream random(scan.seed, "scan");
  RayCloud cloud;
  cloud.set_schema({{"target", ScalarType::uint8}});
  cloud.resize(scan.rays);
  for (std::size_t i = 0; i < scan.rays; ++i) {
    const double time = 60.0 * static_cast<double>(i) / static_cast<double>(scan.rays);
    const Eigen::Vector3d start(-3.0 + 0.1 * time, 0.0, 1.0);
    const Eigen::Vector3d way(1.6 * random.uniform(i, 0) - 0.8, 1.0, random.uniform(i, 1) - 0.3);
    const Eigen::Vector3d at_board = start + 4.0 * way, at_wall = start + 8.0 * way;
    const bool on_board = scan.board && std::abs(at_board.x()) < 1.0 && at_board.z() > 0.2 &&
                          at_board.z() < 2.2 && random.uniform(i, 4) >= scan.gaps;
    const bool on_wall = at_wall.z() < 4.0;
    const double noise = 0.01 * (random.uniform(i, 2) + random.uniform(i, 3) - 1.0);
    cloud.starts[i] = start;
    cloud.ends[i] = start + (on_board ? 4.0 + noise : on_wall ? 8.0 + noise : 30.0) * way;
    cloud.times[i] = scan.begin + time;
    cloud.bounded[i] = on_board || on_wall ? 1 : 0;
    cloud.extras[0].values<std::uint8_t>()[i] = on_board ? kBoard : on_wall ? kBack : kAbove;
  }
  return cloud;
}

std::size_t count_on(const RayCloud& cloud, Target target) {
  const auto targets = cloud.extra("target")->values<std::uint8_t>();
  return static_cast<std::size_t>(std::count(targets.begin(), targets.end(), target));
}

/// How many rays go through the middle of the board, and how many go well beside it or end on it.
struct Through {
  std::size_t middle = 0, beside = 0;
};
Through through_board(const RayCloud& cloud) {
  Through through;
  const auto targets = cloud.extra("target")->values<std::uint8_t>();
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const Eigen::Vector3d way = cloud.ends[i] - cloud.starts[i];
    const Eigen::Vector3d at_board = cloud.starts[i] + 4.0 / way.y() * way;
    const double x = std::abs(at_board.x()), z = std::abs(at_board.z() - 1.2);
    if (targets[i] == kBoard || x > 1.2 || z > 1.2)
      ++through.beside;
    else if (x < 0.9 && z < 0.9)
      ++through.middle;
  }
  return through;
}

const RayCloud& without_board() {
  static const RayCloud cloud = scan_of_wall({});
  return cloud;
}
const RayCloud& with_board() {
  static const RayCloud cloud = scan_of_wall({.board = true, .seed = 2, .begin = 1000.0});
  return cloud;
}

/// The board is gone, nothing else is.
void expect_without(const Merged& merged) {
  const std::size_t all = count_on(with_board(), kBoard);
  EXPECT_GT(count_on(merged.differences, kBoard), 98 * all / 100);
  EXPECT_EQ(merged.differences.size(), count_on(merged.differences, kBoard));
}

/// The rays that saw through the board are gone, nothing else is.
void expect_with(const Merged& merged) {
  EXPECT_EQ(through_board(merged.differences).beside, 0U);
  EXPECT_LT(through_board(merged.combined).middle, through_board(without_board()).middle / 50);
}

TEST(MergeClouds, minHasTheUnionOfTheFreeSpace) {
  expect_without(merge({without_board(), with_board()}, {.merge = CloudMerge::min}));
}

TEST(MergeClouds, maxHasTheIntersectionOfTheFreeSpace) {
  expect_with(merge({without_board(), with_board()}, {.merge = CloudMerge::max}));
}

TEST(MergeClouds, oldestAndNewestGoByTheTimes) {
  for (const bool swapped : {false, true}) {
    std::vector<RayCloud> clouds{without_board(), with_board()};
    if (swapped) std::swap(clouds[0], clouds[1]);
    expect_without(merge(clouds, {.merge = CloudMerge::oldest}));
    expect_with(merge(clouds, {.merge = CloudMerge::newest}));
    for (RayCloud& cloud : clouds)
      for (double& time : cloud.times)
        time = -time;
    expect_with(merge(clouds, {.merge = CloudMerge::oldest}));
    expect_without(merge(clouds, {.merge = CloudMerge::newest}));
  }
}

TEST(MergeClouds, orderKeepsWhatTheEarlierCloudSays) {
  expect_without(merge({without_board(), with_board()}, {.merge = CloudMerge::order}));
  expect_with(merge({with_board(), without_board()}, {.merge = CloudMerge::order}));
  // The third sees no board either; whatever it says is heard after the first.
  const RayCloud third = scan_of_wall({.seed = 3});
  expect_without(merge({without_board(), with_board(), third}, {.merge = CloudMerge::order}));
  const Merged merged = merge({with_board(), without_board(), third}, {.merge = CloudMerge::order});
  EXPECT_EQ(count_on(merged.differences, kBoard), 0U);
  EXPECT_LT(through_board(merged.combined).middle, through_board(third).middle / 25);
}

TEST(MergeClouds, allKeepsEveryRay) {
  const Merged merged = merge({without_board(), with_board()}, {.merge = CloudMerge::all});
  EXPECT_EQ(merged.combined.size(), without_board().size() + with_board().size());
}

TEST(MergeClouds, whatBothSawStays) {
  const RayCloud again = scan_of_wall({.board = true, .seed = 5, .begin = 5000.0});
  for (const CloudMerge kind :
       {CloudMerge::min, CloudMerge::max, CloudMerge::oldest, CloudMerge::newest, CloudMerge::order})
    EXPECT_EQ(merge({with_board(), again}, {.merge = kind, .rays = 2.0}).differences.size(), 0U);
}

/// Figure 4b of the paper: of a porous thing more rays must tell that it is gone.
TEST(MergeClouds, aPorousThingNeedsMoreRays) {
  const auto gone = [](double gaps, std::size_t rays) {
    const RayCloud porous = scan_of_wall({.board = true, .seed = 7, .gaps = gaps});
    const RayCloud empty = scan_of_wall({.seed = 8, .rays = rays});
    const Merged merged = merge({porous, empty}, {.merge = CloudMerge::min});
    return static_cast<double>(count_on(merged.differences, kBoard)) /
           static_cast<double>(count_on(porous, kBoard));
  };
  EXPECT_GT(gone(0.0, 30000), 0.98);
  EXPECT_LT(gone(0.9, 30000), 0.2);
  EXPECT_GT(gone(0.9, 300000), 0.9);
  // And one that is still there, as porous as before, stays.
  const RayCloud first = scan_of_wall({.board = true, .seed = 7, .gaps = 0.8});
  const RayCloud second = scan_of_wall({.board = true, .seed = 8, .rays = 300000, .gaps = 0.8});
  const Merged merged = merge({first, second}, {.merge = CloudMerge::min});
  EXPECT_LT(count_on(merged.differences, kBoard), count_on(first, kBoard) / 100);
}

TEST(MergeClouds, timesAreNeededByOldestAndNewestOnly) {
  std::vector<RayCloud> clouds{without_board(), with_board()};
  for (RayCloud& cloud : clouds)
    std::fill(cloud.times.begin(), cloud.times.end(), 0.0);
  expect_without(merge(clouds, {.merge = CloudMerge::min}));
  expect_with(merge(clouds, {.merge = CloudMerge::max}));
  expect_without(merge(clouds, {.merge = CloudMerge::order}));
  EXPECT_THROW(merge(clouds, {.merge = CloudMerge::oldest}), Error);
  EXPECT_THROW(merge(clouds, {.merge = CloudMerge::newest}), Error);
  std::fill(clouds[1].times.begin(), clouds[1].times.end(), 1.0);
  expect_with(merge(clouds, {.merge = CloudMerge::newest}));
}

TEST(MergeClouds, aCloudWithItselfIsItself) {
  RayCloud cloud = scan_of_wall({.board = true, .seed = 4, .rays = 4000});
  cloud.append(scan_of_wall({.seed = 5, .rays = 4000}));  // contradicts itself
  std::vector<std::uint32_t> rows(200);
  std::iota(rows.begin(), rows.end(), 100);
  RayCloud twice;
  twice.assign_rows(cloud, rows);
  cloud.append(twice);
  for (const CloudMerge kind : {CloudMerge::all, CloudMerge::min, CloudMerge::max, CloudMerge::oldest,
                                CloudMerge::newest, CloudMerge::order})
    for (const std::size_t copies : {1U, 2U, 3U}) {
      const Merged merged = merge(std::vector<RayCloud>(copies, cloud), {.merge = kind, .rays = 0.5});
      EXPECT_TRUE(same_bits(merged.combined, cloud));
      EXPECT_EQ(merged.counts.repeated, (copies - 1) * cloud.size());
    }
}

TEST(MergeClouds, cloudsFarApartKeepEverything) {
  RayCloud far = with_board();
  far.transform({.translation = {500.0, 0.0, 0.0}});
  const Merged merged = merge({without_board(), far}, {.merge = CloudMerge::min, .rays = 1.0});
  EXPECT_EQ(merged.combined.size(), without_board().size() + far.size());
}

/// Few rays in a small box, many of them in several clouds, some twice in one.
std::vector<RayCloud> random_clouds(std::size_t count) {
  const RayCloud all =
      random_cloud(*rc::gen::arbitrary<std::uint64_t>(),
                   {.rays = 400, .half_extent = 2.0, .extras = {{"mine", ScalarType::int16}}});
  std::vector<RayCloud> clouds(count);
  for (RayCloud& cloud : clouds) {
    const auto rows = *rc::gen::container<std::vector<std::uint32_t>>(
        *rc::gen::inRange<std::size_t>(0, 300), rc::gen::inRange<std::uint32_t>(0, 400));
    cloud.set_schema(schema_of(all));
    if (!rows.empty()) cloud.assign_rows(all, rows);
    for (std::size_t i = 5; i < rows.size(); i += 50)  // which are left out as they are read
      cloud.times[i] = std::numeric_limits<double>::quiet_NaN();
  }
  return clouds;
}

/// One that these clouds allow.
MergeRule rule_for(const std::vector<RayCloud>& clouds) {
  MergeRule rule{.merge = *rc::gen::element(CloudMerge::all, CloudMerge::min, CloudMerge::max,
                                            CloudMerge::oldest, CloudMerge::newest, CloudMerge::order),
                 .rays = *rc::gen::element(0.1, 1.0, 5.0),
                 .paper = *rc::gen::element(false, true)};
  std::vector<double> times;
  for (const RayCloud& cloud : clouds)
    std::copy_if(cloud.times.begin(), cloud.times.end(), std::back_inserter(times),
                 [](double time) { return std::isfinite(time); });
  const bool one_time = std::adjacent_find(times.begin(), times.end(), std::not_equal_to<>()) == times.end();
  if (one_time) rule.merge = CloudMerge::min;
  return rule;
}

/// Both halves together have each ray as often as the cloud that has it most often, in the order of the
/// clouds; threads and chunks change nothing.
RC_GTEST_PROP(MergeClouds, everyDistinctRayOnceHoweverItRuns, ()) {
  std::vector<RayCloud> clouds = random_clouds(*rc::gen::inRange<std::size_t>(1, 4));
  const MergeRule rule = rule_for(clouds);
  const Merged merged = merge(clouds, rule);
  const std::vector<RayCloud> given = clouds;
  for (RayCloud& cloud : clouds)
    drop_not_finite(cloud);
  std::vector<std::string> wanted;
  for (const RayCloud& cloud : clouds) {
    std::vector<std::string> rows = sorted_rows(cloud), both;
    std::set_union(wanted.begin(), wanted.end(), rows.begin(), rows.end(), std::back_inserter(both));
    wanted = std::move(both);
  }
  RayCloud halves = merged.combined;
  halves.append(merged.differences);
  RC_ASSERT(sorted_rows(halves) == wanted);
  std::vector<std::string> in_order;
  for (const RayCloud& cloud : clouds)
    for (std::string& row : rows_of_bytes(cloud))
      in_order.push_back(std::move(row));
  auto next = in_order.begin();
  for (const std::string& row : rows_of_bytes(merged.combined)) {
    next = std::find(next, in_order.end(), row);
    RC_ASSERT(next != in_order.end());
    ++next;
  }
  for (const unsigned threads : {1U, 2U, 8U})
    for (const std::size_t chunk : {1UL, 7UL, 1000000UL}) {
      const Merged again = merge(given, rule, {.threads = threads}, chunk);
      RC_ASSERT(same_bits(again.combined, merged.combined));
      RC_ASSERT(same_bits(again.differences, merged.differences));
    }
}

RC_GTEST_PROP(MergeClouds, theOrderOfTheCloudsMattersForOrderOnly, ()) {
  std::vector<RayCloud> clouds = random_clouds(3);
  const MergeRule rule = rule_for(clouds);
  if (rule.merge == CloudMerge::order) return;
  const Merged merged = merge(clouds, rule);
  std::rotate(clouds.begin(), clouds.begin() + 1, clouds.end());
  if (*rc::gen::element(false, true)) std::swap(clouds[0], clouds[1]);
  const Merged other = merge(clouds, rule);
  RC_ASSERT(sorted_rows(other.combined) == sorted_rows(merged.combined));
  RC_ASSERT(sorted_rows(other.differences) == sorted_rows(merged.differences));
}

TEST(MergeClouds, orderOfWallScansDoesNotMatter) {
  const RayCloud third = scan_of_wall({.board = true, .seed = 6, .begin = -500.0, .gaps = 0.5});
  for (const CloudMerge kind : {CloudMerge::max, CloudMerge::newest}) {
    const Merged one = merge({without_board(), with_board(), third}, {.merge = kind});
    EXPECT_GT(one.differences.size(), 0U);
    const Merged other = merge({third, without_board(), with_board()}, {.merge = kind});
    EXPECT_EQ(sorted_rows(one.combined), sorted_rows(other.combined));
  }
}

TEST(MergeClouds, refusesWhatMakesNoSense) {
  for (const double n : {0.0, -3.0, std::numeric_limits<double>::quiet_NaN()})
    EXPECT_THROW(merge({without_board(), with_board()}, {.rays = n}), Error);
  MemorySink sink;
  EXPECT_THROW(merge_clouds({}, {}, sink, nullptr, {}), Error);
}

TEST(MergeClouds, emptyAndUnboundedClouds) {
  RayCloud none;
  none.set_schema(schema_of(with_board()));
  RayCloud sky = scan_of_wall({.rays = 500});
  std::fill(sky.bounded.begin(), sky.bounded.end(), std::uint8_t{0});
  for (const CloudMerge kind : {CloudMerge::min, CloudMerge::oldest, CloudMerge::order}) {
    EXPECT_EQ(merge({none, none}, {.merge = kind}).combined.size(), 0U);
    EXPECT_EQ(merge({none, sky, none}, {.merge = kind}).combined.size(), 500U);
  }
  // Unbounded rays see through a board as others do.
  RayCloud above = scan_of_wall({.seed = 3});
  for (std::size_t i = 0; i < above.size(); ++i) {
    above.bounded[i] = 0;
    above.ends[i] = 0.4 * above.starts[i] + 0.6 * above.ends[i];
  }
  expect_without(merge({above, with_board()}, {.merge = CloudMerge::order}));
}

}  // namespace
}  // namespace ray
