/// Splitting what is fixed from what is transient, on a wall with a box before it that comes or goes.

#include "support/random_cloud.h"

#include <raycloud/core/error.h>
#include <raycloud/core/memory_stream.h>
#include <raycloud/exec/random.h>
#include <raycloud/volume/transients.h>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

namespace ray {
namespace {

using namespace test;

struct Halves {
  RayCloud fixed;
  RayCloud transient;
};

Halves halves_of(const RayCloud& cloud, const TransientRule& rule, const Context& context = {},
                 std::size_t chunk_rays = 1000) {
  MemorySource source(cloud, chunk_rays);
  const std::vector<ColumnInfo> columns = transient_columns(schema_of(cloud));
  MemorySink fixed(columns), transient(columns);
  const TransientCounts counts = split_transients(context, source, fixed, transient, rule);
  EXPECT_EQ(counts.stream.rays_in, cloud.size());
  EXPECT_EQ(counts.fixed, fixed.cloud().size());
  EXPECT_EQ(counts.transient, transient.cloud().size());
  return {fixed.cloud(), transient.cloud()};
}

enum Part : std::uint8_t { kWall, kThing, kSky };

/// A sensor walks along x for 60 s and looks at a wall in y = 8, over which there is the sky. While `there`,
/// a board of 2 m stands in y = 4.
RayCloud board_before_wall(std::size_t rays, const std::function<bool(double)>& there) {
  const RandomStream random(3, "board");
  RayCloud cloud;
  cloud.set_schema({{"part", ScalarType::uint8}});
  cloud.resize(rays);
  for (std::size_t i = 0; i < rays; ++i) {
    const double time = 60.0 * static_cast<double>(i) / static_cast<double>(rays);
    const Eigen::Vector3d start(-3.0 + 0.1 * time, 0.0, 1.0);
    const Eigen::Vector3d way =
        Eigen::Vector3d(1.6 * random.uniform(i, 0) - 0.8, 1.0, random.uniform(i, 1) - 0.3);
    const Eigen::Vector3d at_board = start + 4.0 * way, at_wall = start + 8.0 * way;
    const bool on_board =
        there(time) && std::abs(at_board.x()) < 1.0 && at_board.z() > 0.2 && at_board.z() < 2.2;
    const bool on_wall = at_wall.z() < 4.0;
    const double noise = 0.01 * (random.uniform(i, 2) + random.uniform(i, 3) - 1.0);
    cloud.starts[i] = start;
    cloud.ends[i] = start + (on_board ? 4.0 + noise : on_wall ? 8.0 + noise : 30.0) * way;
    cloud.times[i] = time;
    cloud.bounded[i] = on_board || on_wall ? 1 : 0;
    cloud.extras[0].values<std::uint8_t>()[i] = on_board ? kThing : on_wall ? kWall : kSky;
  }
  return cloud;
}

double share_of(const RayCloud& cloud, Part part, std::size_t of_all) {
  const auto parts = cloud.extra("part")->values<std::uint8_t>();
  return static_cast<double>(std::count(parts.begin(), parts.end(), part)) / static_cast<double>(of_all);
}

std::size_t count_of(const RayCloud& cloud, Part part) {
  const auto parts = cloud.extra("part")->values<std::uint8_t>();
  return static_cast<std::size_t>(std::count(parts.begin(), parts.end(), part));
}

bool came(double time) {
  return time >= 30.0;
}
bool went(double time) {
  return time < 30.0;
}

TEST(Transients, minTakesOutWhatWasSeenThrough) {
  for (const auto& there : {came, went}) {
    const RayCloud cloud = board_before_wall(40000, there);
    const Halves halves = halves_of(cloud, {.merge = Merge::min});
    EXPECT_GT(share_of(halves.transient, kThing, count_of(cloud, kThing)), 0.98);
    EXPECT_EQ(count_of(halves.transient, kWall), 0U);
    EXPECT_EQ(count_of(halves.transient, kSky), 0U);
  }
}

TEST(Transients, maxTakesOutTheRaysThatSawThrough) {
  const RayCloud cloud = board_before_wall(40000, came);
  const Halves halves = halves_of(cloud, {.merge = Merge::max});
  EXPECT_EQ(count_of(halves.transient, kThing), 0U);
  // Of the rays that are left before the board came, none goes through its middle; all others are there.
  std::size_t through = 0, beside = 0;
  for (const RayCloud* half : {&halves.fixed, &halves.transient})
    for (std::size_t i = 0; i < half->size(); ++i) {
      if (half->times[i] >= 30.0) continue;
      const Eigen::Vector3d way = half->ends[i] - half->starts[i];
      const Eigen::Vector3d at_board = half->starts[i] + 4.0 / way.y() * way;
      const double x = std::abs(at_board.x()), z = std::abs(at_board.z() - 1.2);
      if (half == &halves.fixed && x < 0.9 && z < 0.9) ++through;
      if (half == &halves.transient && (x > 1.2 || z > 1.2)) ++beside;
    }
  EXPECT_LT(through, 40U);
  EXPECT_EQ(beside, 0U);
  // But for some that graze its edges later.
  EXPECT_LT(std::count_if(halves.transient.times.begin(), halves.transient.times.end(), came), 20);
}

TEST(Transients, oldestAndNewestKeepTheFirstAndTheLastState) {
  for (const auto& [there, first] : {std::pair{&came, false}, {&went, true}}) {
    const RayCloud cloud = board_before_wall(40000, there);
    const std::size_t things = count_of(cloud, kThing);
    const Halves oldest = halves_of(cloud, {.merge = Merge::oldest});
    const Halves newest = halves_of(cloud, {.merge = Merge::newest});
    const Halves& keeps = first ? oldest : newest;
    const Halves& removes = first ? newest : oldest;
    EXPECT_EQ(count_of(keeps.transient, kThing), 0U);
    EXPECT_GT(keeps.transient.size(), 1000U);
    EXPECT_GT(share_of(removes.transient, kThing, things), 0.98);
    EXPECT_EQ(removes.transient.size(), count_of(removes.transient, kThing));
  }
}

TEST(Transients, whatComesTwiceIsSeenThroughBetween) {
  const RayCloud cloud =
      board_before_wall(60000, [](double time) { return time < 15.0 || (time > 40.0 && time < 50.0); });
  const Halves halves = halves_of(cloud, {.merge = Merge::min});
  EXPECT_GT(share_of(halves.transient, kThing, count_of(cloud, kThing)), 0.98);
}

TEST(Transients, aFenceStays) {
  // Slats of 5 cm every 20 cm, for all the time.
  RayCloud cloud = board_before_wall(40000, [](double) { return true; });
  const auto parts = cloud.extra("part")->values<std::uint8_t>();
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const double x = cloud.ends[i].x() + 10.0;
    if (parts[i] != kThing || x - 0.2 * std::floor(x / 0.2) < 0.05) continue;
    cloud.ends[i] = cloud.starts[i] + 2.0 * (cloud.ends[i] - cloud.starts[i]);
    parts[i] = kWall;
  }
  for (const double n : {2.0, 10.0}) {
    const Halves halves = halves_of(cloud, {.merge = Merge::min, .rays = n});
    EXPECT_LT(share_of(halves.transient, kThing, count_of(cloud, kThing)), 0.01) << n;
    EXPECT_EQ(count_of(halves.transient, kWall), 0U) << n;
  }
}

TEST(Transients, columnsTellWhatAnotherNumberOfRaysGives) {
  const RayCloud cloud = board_before_wall(20000, came);
  for (const bool paper : {false, true}) {
    const Halves once = halves_of(cloud, {.rays = 1e9, .paper = paper});
    ASSERT_EQ(once.fixed.size(), cloud.size());
    const auto scores = once.fixed.extra("transience")->values<float>();
    for (const double n : {1.0, 4.0, 17.0}) {
      const Halves halves = halves_of(cloud, {.rays = n, .paper = paper});
      std::size_t above = 0;
      for (std::size_t i = 0; i < cloud.size(); ++i) {
        const bool gone = static_cast<double>(scores[i]) > n;
        const RayCloud& half = gone ? halves.transient : halves.fixed;
        const std::size_t row = gone ? above : i - above;
        ASSERT_EQ(half.times[row], cloud.times[i]);
        ASSERT_EQ(half.ends[row], cloud.ends[i]);
        above += gone ? 1 : 0;
      }
      ASSERT_EQ(above, halves.transient.size());
    }
  }
}

/// Every ray is in one half, in order, with every bit; threads and chunks change nothing.
RC_GTEST_PROP(Transients, everyRayOnceHoweverItRuns, (std::uint64_t seed)) {
  RayCloud cloud = random_cloud(seed, {.rays = *rc::gen::inRange<std::size_t>(3, 300),
                                       .half_extent = 2.0,
                                       .extras = {{"mine", ScalarType::float64}}});
  const TransientRule rule{.merge = *rc::gen::element(Merge::min, Merge::max, Merge::oldest, Merge::newest),
                           .rays = *rc::gen::element(0.1, 1.0, 10.0),
                           .paper = *rc::gen::element(false, true)};
  const Halves halves = halves_of(cloud, rule);
  std::size_t next_fixed = 0, next_transient = 0;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    RayCloud ray, found;
    const auto row = static_cast<std::uint32_t>(i);
    ray.assign_rows(cloud, std::span(&row, 1));
    bool matched = false;
    for (const auto& [half, next] :
         {std::pair{&halves.fixed, &next_fixed}, {&halves.transient, &next_transient}}) {
      if (matched || *next >= half->size()) continue;
      const auto other = static_cast<std::uint32_t>(*next);
      found.assign_rows(*half, std::span(&other, 1));
      found.set_schema({});
      found.extras.clear();
      RayCloud bare = ray;
      bare.extras.clear();
      if (!same_bits(found, bare) ||
          half->extra("mine")->as_double(*next) != cloud.extra("mine")->as_double(i))
        continue;
      ++*next;
      matched = true;
    }
    RC_ASSERT(matched);
  }
  RC_ASSERT(next_fixed == halves.fixed.size());
  RC_ASSERT(next_transient == halves.transient.size());
  for (const unsigned threads : {1U, 2U, 8U})
    for (const std::size_t chunk : {1UL, 7UL, 1000000UL}) {
      const Halves again = halves_of(cloud, rule, {.threads = threads}, chunk);
      RC_ASSERT(same_bits(again.fixed, halves.fixed));
      RC_ASSERT(same_bits(again.transient, halves.transient));
    }
}

TEST(Transients, threadsChangeNothing) {
  const RayCloud cloud = board_before_wall(20000, came);
  for (const Merge merge : {Merge::min, Merge::newest}) {
    const Halves one = halves_of(cloud, {.merge = merge}, {.threads = 1});
    for (const unsigned threads : {2U, 8U}) {
      const Halves many = halves_of(cloud, {.merge = merge}, {.threads = threads});
      EXPECT_TRUE(same_bits(one.fixed, many.fixed));
      EXPECT_TRUE(same_bits(one.transient, many.transient));
    }
  }
}

/// A way of 100 m, thousands of times as long as its points are apart, that a sensor drives twice. It looks
/// ahead and down, at boards that stand across the way every 3 m: some the first time, some the second.
RayCloud long_way(std::size_t rays) {
  const RandomStream random(5, "way");
  RayCloud cloud;
  cloud.resize(rays);
  for (std::size_t i = 0; i < rays; ++i) {
    const double time = 200.0 * static_cast<double>(i) / static_cast<double>(rays);
    const bool again = time >= 100.0;
    const Eigen::Vector3d start(again ? time - 100.0 : time, 0.0, 0.6);
    const Eigen::Vector3d way(1.0, 0.1 * random.uniform(i, 0) - 0.05, -0.4 - random.uniform(i, 1));
    const double noise = 0.004 * (random.uniform(i, 2) + random.uniform(i, 3) - 1.0);
    const double far = (0.6 + noise) / -way.z();
    const double next = 3.0 * std::ceil(start.x() / 3.0);
    const bool stands = (std::lround(next / 3.0) % 2 == 0) == again;
    const bool on_board = stands && next - start.x() < far;
    cloud.starts[i] = start;
    cloud.ends[i] = start + (on_board ? next - start.x() + noise : far) * way;
    cloud.times[i] = time;
    cloud.bounded[i] = random.uniform(i, 4) < 0.95 ? 1 : 0;
  }
  return cloud;
}

TEST(Transients, memoryChangesNothing) {
  const RayCloud way = long_way(10000);
  for (const TransientRule& rule :
       {TransientRule{.merge = Merge::min, .rays = 3.0}, TransientRule{.merge = Merge::max, .rays = 3.0},
        TransientRule{.merge = Merge::oldest, .rays = 3.0},
        TransientRule{.merge = Merge::newest, .rays = 3.0, .paper = true}}) {
    const Halves whole = halves_of(way, rule);
    EXPECT_GT(whole.transient.size(), 100U);
    for (const std::size_t memory : {700UL << 10, 150UL << 10}) {
      const Halves blocks = halves_of(way, rule, {.memory = memory});
      EXPECT_TRUE(same_bits(blocks.fixed, whole.fixed)) << static_cast<int>(rule.merge) << memory;
      EXPECT_TRUE(same_bits(blocks.transient, whole.transient)) << static_cast<int>(rule.merge) << memory;
    }
  }
}

/// With everything in everybody's reach, and fewer rays than blocks.
RC_GTEST_PROP(Transients, memoryChangesNothingForFewRays, (std::uint64_t seed)) {
  const RayCloud cloud =
      random_cloud(seed, {.rays = *rc::gen::inRange<std::size_t>(3, 200), .half_extent = 2.0, .extras = {}});
  const TransientRule rule{.merge = *rc::gen::element(Merge::min, Merge::max, Merge::oldest, Merge::newest),
                           .rays = *rc::gen::element(0.1, 1.0, 10.0)};
  const Halves whole = halves_of(cloud, rule);
  const Halves blocks = halves_of(cloud, rule, {.memory = *rc::gen::inRange<std::size_t>(1000, 20000)}, 7);
  RC_ASSERT(same_bits(blocks.fixed, whole.fixed));
  RC_ASSERT(same_bits(blocks.transient, whole.transient));
}

ErrorCode refusal(const RayCloud& cloud, const TransientRule& rule) {
  try {
    halves_of(cloud, rule);
  } catch (const Error& error) {
    return error.code();
  }
  return ErrorCode::cancelled;
}

TEST(Transients, refusesWhatMakesNoSense) {
  RayCloud cloud = board_before_wall(100, came);
  EXPECT_EQ(refusal(cloud, {.rays = 0.0}), ErrorCode::usage);
  EXPECT_EQ(refusal(cloud, {.rays = -3.0}), ErrorCode::usage);
  EXPECT_EQ(refusal(cloud, {.rays = std::numeric_limits<double>::quiet_NaN()}), ErrorCode::usage);
  std::fill(cloud.times.begin(), cloud.times.end(), 4.0);
  EXPECT_EQ(refusal(cloud, {}), ErrorCode::no_data);
  EXPECT_THROW(static_cast<void>(transient_columns({{"hits", ScalarType::float32}})), Error);
}

TEST(Transients, fewRays) {
  for (const std::size_t rays : {0UL, 1UL, 2UL, 5UL}) {
    const Halves halves = halves_of(board_before_wall(rays, came), {});
    EXPECT_EQ(halves.fixed.size(), rays);
  }
  RayCloud sky = board_before_wall(50, came);
  std::fill(sky.bounded.begin(), sky.bounded.end(), std::uint8_t{0});
  EXPECT_EQ(halves_of(sky, {}).fixed.size(), 50U);
}

}  // namespace
}  // namespace ray
