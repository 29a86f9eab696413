/// Free space against looking at all rays and all ellipsoids.

#include "all_pairs.h"

#include <raycloud/exec/parallel.h>
#include <raycloud/volume/free_space.h>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

namespace ray {
namespace {

using namespace test;

const TimeScale kScale(kFirstTime, kLastTime);

std::vector<Evidence> counted(const Context& context, const Scene& scene, const CountRule& rule) {
  const EllipsoidTree tree = tree_of(context, scene.ellipsoids);
  std::vector<Evidence> evidence(tree.size());
  constexpr std::size_t kChunk = 37;
  const auto each = [&](const auto& add) {
    parallel_for(context, scene.rays.size(), kChunk, [&](std::size_t begin, std::size_t end) {
      RayCloud chunk;
      std::vector<std::uint32_t> rows;
      for (std::size_t i = begin; i < end; ++i)
        rows.push_back(static_cast<std::uint32_t>(i));
      chunk.assign_rows(scene.rays, rows);
      add(chunk);
    });
  };
  HitTimes times(tree.size());
  each([&](const RayCloud& rays) { times.add(tree, rays, kScale); });
  times.find_episodes(context, kScale.ticks(rule.look_time), evidence);
  each([&](const RayCloud& rays) { add_passes(tree, rays, rule, kScale, evidence); });
  std::vector<Evidence> by_index;
  for (std::size_t i = 0; i < tree.size(); ++i)
    by_index.push_back(evidence[tree.slot(i)]);
  return by_index;
}

/// Pauses between hits that are as long as the third longest, but not longer than a look, are not looked for.
std::vector<std::pair<double, double>> plain_episodes(std::vector<double> times, double look_time) {
  std::sort(times.begin(), times.end());
  std::vector<double> pauses;
  for (std::size_t i = 1; i < times.size(); ++i)
    pauses.push_back(times[i] - times[i - 1]);
  std::sort(pauses.rbegin(), pauses.rend());
  double least = look_time;
  if (pauses.size() > 3) least = std::max(least, pauses[3]);
  std::vector<std::pair<double, double>> episodes;
  for (const double time : times) {
    if (episodes.empty() || time - episodes.back().second > least)
      episodes.emplace_back(time, time);
    else
      episodes.back().second = time;
  }
  return episodes;
}

struct PlainCounts {
  std::size_t hits = 0, crossings = 0, within = 0;
  std::map<std::size_t, std::size_t> passes;  // 0: before; i: after episode i
};

PlainCounts plainly_counted(const Ellipsoid& ellipsoid, const RayCloud& rays, const CountRule& rule) {
  PlainCounts sum;
  const Ball ball(ellipsoid);
  std::vector<double> times;
  for (std::size_t i = 0; i < rays.size(); ++i)
    if (is_hit(ball, rays, i)) times.push_back(rays.times[i]);
  sum.hits = times.size();
  const auto episodes = plain_episodes(times, rule.look_time);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const PlainCrossing crossing = plain_crossing(ball, rays, i, rule.guard);
    if (crossing.crosses) ++sum.crossings;
    if (!crossing.proves_empty) continue;
    std::size_t run = 0;
    bool within = false;
    for (const auto& [first, last] : episodes) {
      within = within || (rays.times[i] >= first && rays.times[i] <= last);
      if (rays.times[i] > last) ++run;
    }
    ++(within ? sum.within : sum.passes[run]);
  }
  // The run after the last episode has the last number.
  if (episodes.size() < Evidence::kEpisodes && sum.passes.contains(episodes.size())) {
    sum.passes[Evidence::kEpisodes] = sum.passes[episodes.size()];
    sum.passes.erase(episodes.size());
  }
  return sum;
}

void expect_same_counts(const std::vector<Evidence>& fast, const Scene& scene, const CountRule& rule) {
  std::size_t crossings = 0;
  for (std::size_t i = 0; i < fast.size(); ++i) {
    const PlainCounts plain = plainly_counted(scene.ellipsoids[i], scene.rays, rule);
    ASSERT_EQ(fast[i].hits, plain.hits) << i;
    ASSERT_EQ(fast[i].crossings, plain.crossings) << i;
    if (plain.hits == 0) continue;
    ASSERT_EQ(fast[i].within, plain.within) << i;
    for (std::size_t run = 0; run < Evidence::kRuns; ++run)
      ASSERT_EQ(fast[i].passes[run], plain.passes.contains(run) ? plain.passes.at(run) : 0U)
          << i << " " << run;
    crossings += plain.crossings;
  }
  if (fast.size() > 100) {
    ASSERT_GT(crossings, 200U);  // enough to tell
  }
}

TEST(FreeSpace, countsWhatAllPairsCount) {
  std::uint64_t seed = 0;
  for (const double far : {0.0, 300.0, 5e5}) {
    const Scene scene = random_scene(++seed, 500, 700, far);
    for (const PassGuard& guard : {PassGuard{}, kEveryPass}) {
      const CountRule rule{.guard = guard};
      expect_same_counts(counted({}, scene, rule), scene, rule);
    }
  }
}

RC_GTEST_PROP(FreeSpace, countsWhatAllPairsCountForAnyNumbers, (std::uint64_t seed)) {
  const auto ellipsoids = *rc::gen::inRange<std::size_t>(0, 80);
  const auto rays = *rc::gen::inRange<std::size_t>(0, 80);
  const Scene scene = random_scene(seed, ellipsoids, rays, 0.0);
  expect_same_counts(counted({}, scene, {}), scene, {});
}

TEST(FreeSpace, doesNotDependOnThreads) {
  const Scene scene = random_scene(9, 2000, 3000, 0.0);
  const std::vector<Evidence> one = counted({.threads = 1}, scene, {});
  for (const unsigned threads : {2U, 3U, 8U}) {
    const std::vector<Evidence> many = counted({.threads = threads}, scene, {});
    ASSERT_EQ(one, many);
  }
}

TEST(FreeSpace, treeKeepsEllipsoidsBitForBit) {
  const Scene scene = random_scene(4, 500, 0, 5e5);
  const EllipsoidTree tree = tree_of({}, scene.ellipsoids);
  for (std::size_t i = 0; i < tree.size(); ++i) {
    const Ellipsoid kept = tree.at_slot(tree.slot(i));
    EXPECT_EQ(kept.centre, scene.ellipsoids[i].centre);
    EXPECT_EQ(kept.shape, scene.ellipsoids[i].shape);
    EXPECT_EQ(kept.normal, scene.ellipsoids[i].normal);
  }
}

TEST(FreeSpace, manyInOnePlace) {
  Scene scene = random_scene(5, 1, 300, 0.0);
  scene.ellipsoids.resize(100, scene.ellipsoids.front());
  expect_same_counts(counted({}, scene, {}), scene, {});
}

}  // namespace
}  // namespace ray
