#include "support/random_cloud.h"

#include <raycloud/core/memory_stream.h>
#include <raycloud/exec/blocks.h>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <limits>

namespace ray {
namespace {

using test::random_cloud;
using test::same_bits;

struct Place {
  Eigen::Vector3d end;
  double time = 0.0;
};

/// What the toy finds out: how many ends are within reach, and which of them came first.
struct Seen {
  std::uint32_t count = 0;
  float first_time = 0.0F;
};

std::vector<Seen> look_around(const Context&, Block<Place>&& block, double reach) {
  const std::vector<Place>& places = block.records;
  std::vector<Seen> seen(places.size());
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (!block.is_own(i)) continue;
    for (const Place& other : places) {
      if ((other.end - places[i].end).norm() > reach) continue;
      if (seen[i].count++ == 0) seen[i].first_time = static_cast<float>(other.time);
    }
  }
  return seen;
}

/// Nothing else is near a place that says so; true of how many.
std::size_t count_places_among_own(const Block<Place>& block, double radius) {
  std::size_t count = 0;
  for (const Place& place : block.records) {
    if (!block.has_only_own(place.end, radius)) continue;
    ++count;
    for (std::size_t i = 0; i < block.records.size(); ++i)
      EXPECT_TRUE(block.is_own(i) || (block.records[i].end - place.end).norm() > radius);
  }
  return count;
}

/// Writes what was seen into the colours, with the number of times that `compute` was called.
struct ToyRun {
  RayCloud cloud;
  StreamCounts counts;
  std::size_t blocks = 0;
  std::size_t among_own = 0;
};

constexpr std::size_t kBytes = 64;

template <class Apply>
ToyRun toy_run(const RayCloud& cloud, double reach, const Context& context, std::size_t chunk,
               const Apply& apply) {
  MemorySource source(cloud, chunk);
  MemorySink sink(source.info().extras);
  const BlockNeeds needs{.bytes_per_record = kBytes, .reach = [&](const EndSample& sample) {
                           std::size_t bounded = 0;
                           for (const auto b : cloud.bounded)
                             bounded += b != 0 ? 1 : 0;
                           EXPECT_EQ(sample.bounded, bounded);
                           return reach;
                         }};
  ToyRun run;
  run.counts = run_blocks<Place, Seen>(
      context, source, sink, needs,
      [](const RayCloud& rays, std::size_t i) {
        EXPECT_NE(rays.bounded[i], 0);
        return Place{rays.ends[i], rays.times[i]};
      },
      [&](const Context& with, Block<Place>&& block, double given) {
        ++run.blocks;
        run.among_own += count_places_among_own(block, given / 3.0);
        return look_around(with, std::move(block), given);
      },
      apply);
  run.cloud = sink.cloud();
  return run;
}

/// The change form: unbounded rays are left alone.
void write_seen(RayCloud& rays, std::span<const Seen> seen) {
  std::size_t next = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    if (rays.bounded[i] == 0) continue;
    const Seen& of_ray = seen[next++];
    rays.starts[i] = {static_cast<double>(of_ray.count), static_cast<double>(of_ray.first_time), 0.0};
  }
  EXPECT_EQ(next, seen.size());
}

/// The mask form: lonely rays go, unbounded ones stay.
std::vector<std::uint8_t> mask_seen(RayCloud& rays, std::span<const Seen> seen) {
  std::vector<std::uint8_t> mask(rays.size(), 1);
  std::size_t next = 0;
  for (std::size_t i = 0; i < rays.size(); ++i)
    if (rays.bounded[i] != 0) mask[i] = seen[next++].count > 3 ? 1 : 0;
  return mask;
}

std::vector<Seen> by_brute_force(const RayCloud& cloud, double reach) {
  Block<Place> all;
  for (std::size_t i = 0; i < cloud.size(); ++i)
    if (cloud.bounded[i] != 0) all.records.push_back({cloud.ends[i], cloud.times[i]});
  return look_around({}, std::move(all), reach);
}

RC_GTEST_PROP(RunBlocks, AsByBruteForceWholeAndInManyBlocks, ()) {
  const auto rays = *rc::gen::element<std::size_t>(0, 1, 2, 100, 400);
  RayCloud cloud = random_cloud(*rc::gen::arbitrary<std::uint64_t>(),
                                {.rays = rays, .extras = test::schema_of_every_type()});
  if (*rc::gen::inRange(0, 4) == 0) cloud.bounded.assign(rays, 0);
  if (*rc::gen::inRange(0, 4) == 0) cloud.ends.assign(rays, {1, 2, 3});
  const double reach = *rc::gen::element(0.0, 3.0, 8.0, std::numeric_limits<double>::infinity());
  const std::vector<Seen> seen = by_brute_force(cloud, reach);
  RayCloud changed = cloud;
  write_seen(changed, seen);
  RayCloud kept = cloud;
  kept.select(mask_seen(cloud, seen));
  for (const std::size_t memory : {0UL, 3000UL, 1UL})
    for (const unsigned threads : {1U, 3U}) {
      const auto chunk = *rc::gen::element<std::size_t>(1, 7, 1000);
      const Context context{.threads = threads, .memory = memory};
      const ToyRun change = toy_run(cloud, reach, context, chunk, write_seen);
      RC_ASSERT(same_bits(change.cloud, changed));
      RC_ASSERT(change.counts.rays_in == rays && change.counts.rays_out == rays);
      const bool whole = memory == 0 || seen.size() * kBytes <= memory;
      RC_ASSERT(change.blocks == 1 || !whole);
      const ToyRun mask = toy_run(cloud, reach, context, chunk, mask_seen);
      RC_ASSERT(same_bits(mask.cloud, kept));
      RC_ASSERT(mask.counts.rays_in == rays && mask.counts.rays_out == kept.size());
    }
}

TEST(RunBlocks, TwentyBlocksAndMore) {
  const RayCloud cloud = random_cloud(5, {.rays = 3000});
  RayCloud changed = cloud;
  write_seen(changed, by_brute_force(cloud, 2.0));
  const ToyRun run = toy_run(cloud, 2.0, {.memory = 15000}, 100, write_seen);
  EXPECT_GE(run.blocks, 20U);
  EXPECT_GE(run.among_own, 500U);
  EXPECT_LT(run.among_own, 3000U);
  EXPECT_TRUE(same_bits(run.cloud, changed));
}

TEST(RunBlocks, ManyRaysInOnePlaceAreNotCopiedToEveryBlock) {
  RayCloud cloud = random_cloud(5, {.rays = 500});
  cloud.ends.assign(cloud.size(), {1, 2, 3});
  RayCloud changed = cloud;
  write_seen(changed, by_brute_force(cloud, 1.0));
  for (const double reach : {1.0, std::numeric_limits<double>::infinity()}) {
    const ToyRun run = toy_run(cloud, reach, {.memory = 100}, 100, write_seen);
    EXPECT_EQ(run.blocks, 1U);
    EXPECT_TRUE(same_bits(run.cloud, changed));
  }
}

/// Ends numbered from `first` on along x, each behind an unbounded one if `mixed`.
RayCloud numbered_ends(std::size_t first, std::size_t count, bool mixed) {
  RayCloud rays;
  for (std::size_t i = 0; i < count; ++i) {
    if (mixed) {
      rays.ends.emplace_back(-1.0, 0.0, 0.0);
      rays.bounded.push_back(0);
    }
    rays.ends.emplace_back(static_cast<double>(first + i), 0.0, 0.0);
    rays.bounded.push_back(1);
  }
  rays.starts.resize(rays.ends.size());
  rays.times.resize(rays.ends.size());
  rays.colours.resize(rays.ends.size());
  return rays;
}

TEST(EndSampler, AnEvenSampleOfAnyNumber) {
  std::size_t chunk = 1;
  for (const std::size_t count : {0UL, 1UL, 65536UL, 65537UL, 131072UL, 131073UL, 500000UL}) {
    blocks::EndSampler sampler;
    for (std::size_t i = 0; i < count; i += chunk) {
      chunk = chunk * 7 % 10007;
      const std::size_t bounded = std::min(chunk, count - i);
      sampler.add(numbered_ends(i, bounded, chunk % 2 == 0), bounded);
    }
    const EndSample& sample = sampler.sample();
    EXPECT_EQ(sample.bounded, count);
    EXPECT_LE(sample.ends.size(), 65536U);
    std::size_t stride = 1;
    while ((count + stride - 1) / stride > 65536)
      stride *= 2;
    ASSERT_EQ(sample.ends.size(), (count + stride - 1) / stride) << count;
    for (std::size_t i = 0; i < sample.ends.size(); ++i)
      ASSERT_EQ(sample.ends[i].x(), static_cast<double>(i * stride));
  }
}

}  // namespace
}  // namespace ray
