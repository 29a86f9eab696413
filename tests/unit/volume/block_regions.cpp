/// Ellipsoids in blocks of space, and evidence that is brought together across blocks, against all at once.

#include "volume/block_regions.h"

#include "volume/cloud_ellipsoids.h"
#include "volume/crossing_rays.h"

#include <raycloud/core/memory_stream.h>
#include <raycloud/exec/random.h>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <bit>

namespace ray {
namespace {

/// The ends of a floor and a wall, ten times as dense in the middle as at the rim, of a bush, and of points
/// far from all others.
RayCloud surroundings(std::uint64_t seed, std::size_t count) {
  const RandomStream random(seed, "surroundings");
  RayCloud cloud;
  cloud.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    const auto even = [&](std::uint64_t draw) { return 2.0 * random.uniform(i, draw) - 1.0; };
    const auto dense = [&](std::uint64_t draw) { return 5.0 * even(draw) * std::abs(even(draw + 1)); };
    Eigen::Vector3d& end = cloud.ends[i];
    switch (random.below(20, i, 0)) {
      case 0:
        end = {5.0 * even(1), 5.0 * even(2), 4.0 * random.uniform(i, 3)};
        break;
      case 1:
        end = Eigen::Vector3d(2.0, 3.0, 1.0) + 0.5 * Eigen::Vector3d(even(1), even(2), even(3));
        break;
      case 2:
      case 3:
      case 4:
        end = {dense(1), 5.0 + 0.01 * even(3), std::abs(dense(4))};
        break;
      default:
        end = {dense(1), dense(3), 0.01 * even(5)};
    }
    cloud.starts[i] = {0.0, 0.0, 2.0};
    cloud.times[i] = static_cast<double>(i);
    cloud.bounded[i] = random.below(10, i, 6) == 0 ? 0 : 1;
  }
  return cloud;
}

/// The ends along a wire: ellipsoids as long as can be, so what spreads goes as far as it can.
RayCloud wire(double spacing, std::size_t count) {
  const RandomStream random(7, "wire");
  RayCloud cloud;
  cloud.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    cloud.starts[i] = {0.0, 0.0, 2.0};
    cloud.ends[i] = {spacing * static_cast<double>(i), 0.004 * random.uniform(i, 0),
                     0.004 * random.uniform(i, 1)};
    cloud.times[i] = static_cast<double>(i);
    cloud.bounded[i] = 1;
  }
  return cloud;
}

std::uint64_t number_of(const Eigen::Vector3d& place) {
  std::uint64_t number = 0;
  for (const double coordinate : {place.x(), place.y(), place.z()})
    number = 31 * number + std::bit_cast<std::uint64_t>(coordinate + 0.0);
  return number;
}

constexpr double kPatches = 1.25;  // 1/m

/// By the place of the ellipsoid: nearly everything hints, so that what is sure of itself, in a few patches,
/// spreads as far as it can.
RegionSeed seed_at(const Eigen::Vector3d& centre) {
  const RandomStream random(number_of(centre), "seed");
  const RandomStream of_patch(number_of((kPatches * centre).array().floor()), "patch");
  const double patch = of_patch.uniform(0, 0);
  RegionSeed seed;
  seed.hint = static_cast<float>(random.uniform(0, 0) < 0.9 ? 6.0 + 6.0 * random.uniform(0, 1) : 0.5);
  if (patch < 0.05 && random.uniform(0, 2) < 0.9)
    seed.own = static_cast<float>(20.0 + 60.0 * of_patch.uniform(0, 1));
  else if (patch < 0.1)
    seed.own = static_cast<float>(4.0 * random.uniform(0, 3));
  seed.opaque = random.below(2, 0, 4) == 0 ? 1 : 0;
  seed.solid = random.below(5, 0, 5) != 0 ? 1 : 0;
  return seed;
}

struct Scored {
  std::vector<Ellipsoid> ellipsoids;
  std::vector<float> scores;
};

Scored scored_whole(const RayCloud& cloud, const SpreadSteps& steps) {
  MemorySource source(cloud, 100);
  const CloudEllipsoids whole = cloud_ellipsoids({}, source);
  const std::vector<float> by_slot = transient_regions(
      {}, *whole.tree,
      [&](std::size_t slot) { return seed_at(whole.tree->at_slot(static_cast<std::uint32_t>(slot)).centre); },
      steps);
  Scored scored;
  for (std::size_t i = 0; i < whole.tree->size(); ++i) {
    scored.ellipsoids.push_back(whole.tree->at_slot(whole.tree->slot(i)));
    scored.scores.push_back(by_slot[whole.tree->slot(i)]);
  }
  return scored;
}

Scored scored_in_blocks(const RayCloud& cloud, const SpreadSteps& steps, const Context& context) {
  MemorySource source(cloud, 100);
  EllipsoidBlocks blocks(context, source, read_ends(context, source, 0), 140);
  const auto seeds_of = [&](std::size_t part) {
    std::vector<RegionSeed> seeds;
    for (const PackedEllipsoid& ellipsoid : blocks.load(part))
      seeds.push_back(seed_at(centre_of(ellipsoid)));
    return seeds;
  };
  BlockRegions regions(blocks, steps);
  for (std::size_t part = 0; part < blocks.parts(); ++part)
    regions.see(part, seeds_of(part), blocks.load(part));
  regions.judge(context, seeds_of);
  std::vector<std::vector<PackedEllipsoid>> ellipsoids(blocks.parts());
  std::vector<std::vector<float>> scores(blocks.parts());
  std::vector<std::size_t> next(blocks.parts());
  for (std::size_t part = 0; part < blocks.parts(); ++part) {
    ellipsoids[part] = blocks.load(part);
    scores[part] = regions.scores(part);
  }
  Scored scored;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (cloud.bounded[i] == 0) continue;
    const std::size_t part = blocks.part_of(cloud.ends[i]);
    scored.ellipsoids.push_back(unpacked(ellipsoids[part][next[part]]));
    scored.scores.push_back(scores[part][next[part]++]);
  }
  return scored;
}

void expect_same(const Scored& blocks, const Scored& whole) {
  ASSERT_EQ(blocks.scores.size(), whole.scores.size());
  for (std::size_t i = 0; i < whole.scores.size(); ++i) {
    ASSERT_EQ(blocks.ellipsoids[i].centre, whole.ellipsoids[i].centre) << i;
    ASSERT_EQ(blocks.ellipsoids[i].shape, whole.ellipsoids[i].shape) << i;
    ASSERT_EQ(blocks.ellipsoids[i].normal, whole.ellipsoids[i].normal) << i;
    ASSERT_EQ(blocks.scores[i], whole.scores[i]) << i;
  }
}

TEST(BlockRegions, knowWhatTheWholeCloudDoes) {
  const RayCloud cloud = surroundings(1, 3000);
  for (const SpreadSteps& steps : {kWithinCloud, kBetweenClouds}) {
    const Scored whole = scored_whole(cloud, steps);
    EXPECT_GT(
        std::count_if(whole.scores.begin(), whole.scores.end(), [](float score) { return score > 0.0F; }),
        200);
    for (const std::size_t memory : {200UL << 10, 50UL << 10})
      expect_same(scored_in_blocks(cloud, steps, {.memory = memory}), whole);
  }
}

TEST(BlockRegions, knowHowFarItSpreads) {
  // Cells are in powers of two: how many ellipsoids fit one depends on the spacing.
  for (const double spacing : {0.03, 0.034, 0.039, 0.045, 0.051}) {
    const RayCloud cloud = wire(spacing, 3000);
    for (const SpreadSteps& steps : {kWithinCloud, kBetweenClouds}) {
      const Scored whole = scored_whole(cloud, steps);
      EXPECT_GT(
          std::count_if(whole.scores.begin(), whole.scores.end(), [](float score) { return score > 0.0F; }),
          200);
      expect_same(scored_in_blocks(cloud, steps, {.memory = 10UL << 10}), whole);
    }
  }
}

RC_GTEST_PROP(BlockRegions, knowWhatTheWholeCloudDoesForAnyNumber, (std::uint64_t seed)) {
  const RayCloud cloud = surroundings(seed, *rc::gen::inRange<std::size_t>(1, 400));
  const SpreadSteps steps{.any = *rc::gen::inRange(0, 5), .solid = *rc::gen::inRange(0, 9)};
  expect_same(scored_in_blocks(cloud, steps, {.memory = *rc::gen::inRange<std::size_t>(1, 30000)}),
              scored_whole(cloud, steps));
}

TEST(TransientRegions, spreadFurtherBetweenCloudsWhereSolid) {
  const RayCloud cloud = wire(0.03, 400);
  MemorySource source(cloud, 100);
  const CloudEllipsoids whole = cloud_ellipsoids({}, source);
  const auto reached = [&](std::uint8_t solid, const SpreadSteps& steps) {
    const std::vector<float> scores = transient_regions(
        {}, *whole.tree,
        [&](std::size_t slot) {
          const bool sure = whole.tree->at_slot(static_cast<std::uint32_t>(slot)).centre.x() < 1.0;
          return RegionSeed{.own = sure ? 30.0F : 0.0F, .hint = 6.0F, .opaque = 0, .solid = solid};
        },
        steps);
    return std::count_if(scores.begin(), scores.end(), [](float score) { return score > 0.0F; });
  };
  EXPECT_GT(reached(1, kBetweenClouds), reached(1, kWithinCloud) + 20);
  EXPECT_EQ(reached(0, kBetweenClouds), reached(0, kWithinCloud));
  EXPECT_EQ(reached(1, kWithinCloud), reached(0, kWithinCloud));
}

/// m, of the nearest point of a line from a box: the distance is convex along it.
double distance_to(const Eigen::AlignedBox3d& box, const Eigen::Vector3d& start, const Eigen::Vector3d& end) {
  double from = 0.0, to = 1.0;
  const auto at = [&](double share) {
    return box.exteriorDistance(Eigen::Vector3d(start + share * (end - start)));
  };
  for (int i = 0; i < 200; ++i) {
    const double one = from + (to - from) / 3.0, other = to - (to - from) / 3.0;
    (at(one) <= at(other) ? to : from) = at(one) <= at(other) ? other : one;
  }
  return at(0.5 * (from + to));
}

RC_GTEST_PROP(BoxTree, findsEveryBoxThatALineMeets, (std::uint64_t seed)) {
  const RandomStream random(seed, "boxes");
  const auto point = [&](std::uint64_t index, double extent) {
    return Eigen::Vector3d(extent * random.uniform(index, 0), extent * random.uniform(index, 1),
                           extent * random.uniform(index, 2));
  };
  std::vector<Eigen::AlignedBox3d> boxes(std::size_t{1} << *rc::gen::inRange(0, 5));
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    if (random.below(5, i, 3) == 0) continue;  // empty
    const Eigen::Vector3d low = point(i, 10.0);
    boxes[i] = {low, Eigen::Vector3d(low + point(100 + i, 4.0))};
  }
  const BoxTree tree(boxes);
  for (std::size_t i = 0; i < 50; ++i) {
    const Eigen::Vector3d start = point(200 + i, 14.0);
    Eigen::Vector3d end = point(300 + i, 14.0);
    if (i % 5 == 0) end.x() = start.x();
    if (i % 9 == 0) end = start;
    std::vector<std::uint32_t> found;
    tree.near_line(start, end, found);
    for (std::uint32_t box = 0; box < boxes.size(); ++box) {
      const bool is_found = std::find(found.begin(), found.end(), box) != found.end();
      const double distance = boxes[box].isEmpty() ? 1.0 : distance_to(boxes[box], start, end);
      if (distance == 0.0) RC_ASSERT(is_found);
      if (distance > 1e-6) RC_ASSERT(!is_found);
    }
  }
}

}  // namespace
}  // namespace ray
