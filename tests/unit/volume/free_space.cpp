/// Free space against looking at all rays and all ellipsoids.

#include "all_pairs.h"
#include "support/any_lanes.h"
#include "volume/cloud_ellipsoids.h"
#include "volume/ellipsoid_lanes.h"

#include <raycloud/core/memory_stream.h>
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
  const AnyLanes lanes;
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

/// Those that are set apart as crossed late are, and none is lost.
TEST(FreeSpace, leavesLateWhatItSays) {
  constexpr double kBeyond = 0.5;
  std::size_t lates = 0, others = 0;
  for (const double far : {0.0, 5e5}) {
    const Scene scene = random_scene(6, 1000, 2000, far);
    const EllipsoidTree tree = tree_of({}, scene.ellipsoids);
    std::vector<std::uint32_t> all, slots, late;
    for (std::size_t i = 0; i < scene.rays.size(); ++i) {
      const Eigen::Vector3d &start = scene.rays.starts[i], &end = scene.rays.ends[i];
      tree.near_line(start, end, all);
      tree.near_line(start, end, kBeyond, slots, late);
      for (const std::uint32_t slot : late) {
        const Chord chord = chord_of(tree.at_slot(slot), start, end);
        ASSERT_TRUE(chord.miss2 <= 1.0 && chord.enters > 0.0 && chord.leaves < 1.0);
        ASSERT_LT((1.0 - chord.leaves) * (end - start).norm(), kBeyond);
      }
      lates += late.size();
      others += slots.size();
      slots.insert(slots.end(), late.begin(), late.end());
      std::sort(slots.begin(), slots.end());
      std::sort(all.begin(), all.end());
      ASSERT_EQ(slots, all);
    }
  }
  EXPECT_GT(lates, 100U);
  EXPECT_GT(others, 1000U);
}

/// What a processor with wide lanes does is what the plain loops do.
TEST(FreeSpace, lanesDoWhatPlainLoopsDo) {
  std::size_t boxes_met = 0, perhaps = 0, late = 0;
  for (std::uint64_t i = 0; i < 20000; ++i) {
    const RandomStream random(i, "lanes");
    const auto uniform = [&](std::uint64_t lane, std::uint64_t draw) {
      return static_cast<float>(2.0 * random.uniform(lane, draw) - 1.0);
    };
    std::array<EightFloats, 3> min, max, centre;
    std::array<EightFloats, 6> shape;
    for (std::uint64_t lane = 0; lane < kEightLanes; ++lane) {
      for (std::uint64_t axis = 0; axis < 3; ++axis) {
        centre[axis][lane] = uniform(lane, axis);
        min[axis][lane] = 3.0F * uniform(lane, 3 + axis);
        max[axis][lane] = min[axis][lane] + 1.0F + uniform(lane, 6 + axis);
        shape[std::array{0U, 3U, 5U}[axis]][lane] = std::pow(10.0F, 1.0F + uniform(lane, 9 + axis));
        shape[std::array{1U, 2U, 4U}[axis]][lane] = 0.3F * uniform(lane, 12 + axis);
      }
    }
    const Eigen::Vector3f way = Eigen::Vector3f(uniform(8, 0), uniform(8, 1), uniform(8, 2)).normalized();
    const LineInBoxes in_boxes{{uniform(8, 3), uniform(8, 4), uniform(8, 5)},
                               {1.0F / way.x(), 1.0F / way.y(), 1.0F / way.z()},
                               4.0F};
    const float end = 1.0F + uniform(8, 6);
    const LineAtEllipsoids line{{0.3F * uniform(8, 7), 0.3F * uniform(8, 8), 0.3F * uniform(8, 9)},
                                {way.x(), way.y(), way.z()},
                                -1.0F,
                                end - (i % 3 == 0 ? 0.0F : 0.5F),
                                end};
    const std::uint32_t on_line = boxes_on_line(min, max, in_boxes);
    ASSERT_EQ(on_line, plain::boxes_on_line(min, max, in_boxes));
    const CrossedLanes wide = ellipsoids_on_line(centre, shape, line);
    const CrossedLanes plainly = plain::ellipsoids_on_line(centre, shape, line);
    ASSERT_EQ(wide.perhaps, plainly.perhaps);
    ASSERT_EQ(wide.late, plainly.late);
    boxes_met += on_line != 0 ? 1 : 0, perhaps += wide.perhaps != 0 ? 1 : 0, late += wide.late != 0 ? 1 : 0;
  }
  EXPECT_GT(std::min({boxes_met, perhaps, late}), 500U);
}

/// Points on two walls, in a bush, in a line, many in one place, and a few far from all.
RayCloud ends_of_all_kinds(std::size_t count, double far) {
  const RandomStream random(7, "ends");
  RayCloud rays;
  rays.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    const auto uniform = [&](std::uint64_t draw) { return 2.0 * random.uniform(i, draw) - 1.0; };
    Eigen::Vector3d end(uniform(0), uniform(1), 0.01 * uniform(2));
    if (i % 7 == 1) end = {1.0 + 0.02 * uniform(0), 0.5 * uniform(1), 1.0 + uniform(2)};
    if (i % 7 == 2) end *= 0.2, end.z() = 0.5 + 0.2 * uniform(2);
    if (i % 7 == 3) end = {-1.0, 3.0 * uniform(0), 0.001 * uniform(1)};
    if (i % 70 == 4) end = {0.1, 0.2, 0.3};
    if (i % 200 == 5) end *= 100.0;
    rays.ends[i] = end + Eigen::Vector3d(far, -far, 0.0);
    rays.starts[i] = rays.ends[i] + Eigen::Vector3d(uniform(3), uniform(4), 2.0);
    rays.times[i] = kFirstTime + (kLastTime - kFirstTime) * random.uniform(i, 5);
    rays.bounded[i] = i % 11 == 0 ? 0 : 1;
  }
  return rays;
}

/// Hits found as ellipsoids are made are those that are found by looking which ellipsoids hold an end.
TEST(FreeSpace, ownHitsAreThoseOfAllEnds) {
  for (const double far : {0.0, 5e5}) {
    const RayCloud rays = ends_of_all_kinds(20000, far);
    MemorySource source(rays, 1000);
    ReadEnds ends = read_ends({}, source, rays.size());
    const double reach = ends.reach;
    EllipsoidMaker maker({}, std::move(ends.points));
    constexpr double kNoise = 0.01, kLookTicks = 300.0;
    OwnHits own({}, maker.points(), end_ticks({}, source, kScale), kLookTicks);
    const auto tree = maker.make({}, reach, kNoise, &own);
    HitTimes times(tree->size());
    times.add(*tree, rays, kScale);
    std::vector<Evidence> expected(tree->size());
    times.find_episodes({}, kLookTicks, expected);
    const std::vector<HitEpisodes> found = own.take();
    std::size_t many = 0;
    for (std::size_t slot = 0; slot < found.size(); ++slot) {
      ASSERT_EQ(found[slot], static_cast<const HitEpisodes&>(expected[slot])) << slot;
      many += found[slot].hits > 16 ? 1 : 0;
    }
    EXPECT_GT(many, 100U);
  }
}

TEST(FreeSpace, manyInOnePlace) {
  Scene scene = random_scene(5, 1, 300, 0.0);
  scene.ellipsoids.resize(100, scene.ellipsoids.front());
  expect_same_counts(counted({}, scene, {}), scene, {});
}

}  // namespace
}  // namespace ray
