#include <raycloud/exec/random.h>
#include <raycloud/spatial/crossed_cubes.h>
#include <raycloud/spatial/known_bricks.h>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <array>
#include <atomic>
#include <limits>
#include <map>
#include <set>
#include <thread>
#include <tuple>
#include <vector>

namespace ray {
namespace {

constexpr std::size_t kNoLimit = std::numeric_limits<std::size_t>::max();
constexpr std::uint64_t kAllCubes = std::numeric_limits<std::uint64_t>::max();

VoxelIndex any_brick(std::int64_t reach) {
  const auto number = [&] {
    return *rc::gen::oneOf(rc::gen::inRange<std::int64_t>(-reach, reach),
                           rc::gen::inRange<std::int64_t>(-3, 3));
  };
  return {number(), number(), number()};
}

RC_GTEST_PROP(BrickNames, AreUniqueWithinReachAndNoneBeyond, ()) {
  const std::int64_t reach = *rc::gen::element<std::int64_t>(2, 8, 1 << 15);
  const VoxelIndex centre = any_brick(std::int64_t{1} << 50);
  const BrickNames names(centre, reach);
  const auto from_centre = [&](const VoxelIndex& brick) {
    return VoxelIndex{centre.x + brick.x, centre.y + brick.y, centre.z + brick.z};
  };
  const VoxelIndex a = any_brick(reach + 2), b = any_brick(reach + 2);
  const BrickNames::Name name = names.of(from_centre(a)), other = names.of(from_centre(b));
  const bool is_near = std::max({std::abs(a.x), std::abs(a.y), std::abs(a.z)}) < reach;
  RC_ASSERT((name != BrickNames::kNone) == is_near);
  if (name != BrickNames::kNone) RC_ASSERT((name == other) == (a == b));
  const BrickNames::Name next = names.of(from_centre({a.x, a.y - 1, a.z}));
  if (name != BrickNames::kNone && next != BrickNames::kNone) RC_ASSERT(name == next + BrickNames::kSteps[1]);
}

RC_GTEST_PROP(KnownBricks, KnowWhatTheyLearntOrNothing, ()) {
  KnownBricks known(*rc::gen::element<std::size_t>(0, 16, 200, 1024, 1 << 20));
  const VoxelIndex centre = any_brick(std::int64_t{1} << 50);
  known.centre_on(centre);
  std::map<BrickNames::Name, std::uint64_t> learnt;
  std::size_t forgotten = 0;
  for (int i = 0; i < 200; i++) {
    const VoxelIndex brick = any_brick(5);
    const BrickNames::Name name =
        known.names().of({centre.x + brick.x, centre.y + brick.y, centre.z + brick.z});
    if (name == BrickNames::kNone) continue;
    const auto before = learnt.find(name);
    const std::uint64_t cubes = known.cubes(name);
    if (before == learnt.end())
      RC_ASSERT(cubes == 0U);
    else
      RC_ASSERT(cubes == 0U || cubes == before->second);
    if (before != learnt.end() && cubes == 0) forgotten++;
    learnt[name] |= std::uint64_t{1} << *rc::gen::inRange(0, 64);
    known.learn(name, learnt[name]);
    RC_ASSERT(known.cubes(name) == learnt[name]);
  }
  if (known.memory() == 1 << 20) RC_ASSERT(forgotten == 0U);
  known.clear();
  RC_ASSERT(!known.has_centre());
  for (const auto& [name, cubes] : learnt)
    RC_ASSERT(known.cubes(name) == 0U);
}

TEST(KnownBricks, StayWithinTheirMemory) {
  for (const std::size_t bytes :
       {std::size_t{16}, std::size_t{1000}, std::size_t{1} << 20, std::size_t{1} << 40}) {
    EXPECT_LE(KnownBricks(bytes).memory(), std::min(bytes, KnownBricks::kMostBytes));
    EXPECT_GT(2 * KnownBricks(bytes).memory(), std::min(bytes, KnownBricks::kMostBytes));
  }
}

/// Two bricks in one place, of which one thread learns in turn.
TEST(KnownBricks, NeverMixTwoBricksForWhoeverAsksMeanwhile) {
  KnownBricks known(1024 * 16);
  const VoxelIndex brick{1, 2, 3},
      rival{1 - static_cast<std::int64_t>(BrickNames::kSteps[1] >> 32) % 1024, 3, 3};
  const BrickNames names({0, 0, 0});
  const std::array<BrickNames::Name, 2> rivals{names.of(brick), names.of(rival)};
  ASSERT_EQ(BrickNames::place(rivals[0], 1023), BrickNames::place(rivals[1], 1023));
  const std::array<std::uint64_t, 2> of{0x5555555555555555, 0xaaaaaaaaaaaaaaaa};
  std::atomic<bool> is_done = false;
  int mixed = 0;
  std::thread asking([&] {
    for (int asked = 0; asked < 1000000; asked++) {
      if (known.has_centre() && known.names().of(brick) != rivals[0]) mixed++;
      for (std::size_t i = 0; i < 2; i++) {
        if ((known.cubes(rivals[i]) & ~of[i]) != 0) mixed++;
      }
    }
    is_done = true;
  });
  known.centre_on({0, 0, 0});
  for (std::size_t i = 0; !is_done; i++)
    known.learn(rivals[i % 2], of[i % 2]);
  asking.join();
  EXPECT_EQ(mixed, 0);
}

using Crossing = std::tuple<VoxelIndex, std::uint64_t, int>;

/// The cubes of a ray alone, which the tests of crossed_cubes compare with their definition.
std::set<Crossing> crossings(const Eigen::Vector3d& start, const Eigen::Vector3d& end, double width) {
  const CrossedCubes crossed = crossed_cubes({&start, 1}, {&end, 1}, {width}, kNoLimit);
  std::set<Crossing> result;
  std::size_t i = 0;
  for (const VoxelKeys::Run& run : crossed.bricks.runs) {
    for (; i < run.end; i++) {
      for (int bit = 0; bit < 64; bit++) {
        if ((crossed.cubes[i] >> bit & 1) != 0) result.emplace(run.block, crossed.bricks.keys[i], bit);
      }
    }
  }
  return result;
}

struct Rays {
  std::vector<Eigen::Vector3d> starts, ends;
};

/// Within 4 m of each other, so that many cross the same cubes; or along an axis, or not moved, or long.
Rays many_rays(std::uint64_t seed, std::size_t count, double far) {
  const RandomStream random(seed, "known");
  const Eigen::Vector3d centre =
      random.below(2, 0, 0) == 0 ? Eigen::Vector3d(-0.5, 0.5, -0.5) : Eigen::Vector3d(500000, -6900000, 30);
  Rays rays;
  for (std::uint64_t i = 1; i <= count; i++) {
    Eigen::Vector3d start = centre, end = centre;
    const std::uint64_t kind = random.below(12, i, 0);
    for (int axis = 0; axis < 3; axis++) {
      const auto draw = static_cast<std::uint64_t>(1 + 2 * axis);
      if (kind % 2 == 0) start[axis] += random.uniform(i, draw) - 0.5;
      end[axis] += 4.0 * random.uniform(i, draw + 1) - 2.0;
    }
    if (kind == 9) end = start + Eigen::Vector3d::Unit(static_cast<int>(i % 3)) * (end.x() - centre.x());
    if (kind == 10) end = start;
    if (kind == 11) end = start + far * (end - start);
    rays.starts.push_back(start);
    rays.ends.push_back(end);
  }
  return rays;
}

/// What a table of all bricks says to each of the rays, with what is known of the ones before.
class Fold {
 public:
  explicit Fold(KnownBricks& known) : known_(known) {}

  std::vector<std::uint8_t> add(const CrossedCubes& crossed) {
    std::vector<std::uint8_t> kept(crossed.done);
    for (std::size_t i = 0; i < crossed.cubes.size(); i++) {
      const CrossedCubes::Brick& brick = crossed.all.at(crossed.which.at(i));
      EXPECT_EQ(brick.place.key, crossed.bricks.keys[i]);
      EXPECT_EQ(crossed.cubes[i] & ~brick.cubes, 0U);
      std::uint64_t& cubes = table_[{brick.place.block, brick.place.key}];
      if ((crossed.cubes[i] & ~cubes) != 0) kept[crossed.rays[i]] = 1;
      cubes |= crossed.cubes[i];
    }
    for (const CrossedCubes::Brick& brick : crossed.all)
      known_.learn(brick.name, table_[{brick.place.block, brick.place.key}]);
    return kept;
  }

 private:
  KnownBricks& known_;
  std::map<std::pair<VoxelIndex, std::uint64_t>, std::uint64_t> table_;
};

RC_GTEST_PROP(CrossedCubes, OfWhatIsKnownTellTheFirstRayOfEachCube, ()) {
  const double width = *rc::gen::element(0.05, 0.2, 1.0);
  const Rays rays = many_rays(*rc::gen::arbitrary<std::uint64_t>(), 150, 20.0);
  std::vector<std::uint8_t> expected;
  std::set<Crossing> seen;
  for (std::size_t i = 0; i < rays.ends.size(); i++) {
    const std::size_t before = seen.size();
    seen.merge(crossings(rays.starts[i], rays.ends[i], width));
    expected.push_back(seen.size() > before ? 1 : 0);
  }
  const auto bytes = *rc::gen::element<std::size_t>(0, 64 * 16, 512 * 16, KnownBricks::kMostBytes);
  const auto chunk = *rc::gen::element<std::size_t>(1, 7, 40);
  const auto late = *rc::gen::element<std::size_t>(0, 1, 3);  // chunks that look before this one is learnt
  KnownBricks known(bytes);
  Fold fold(known);
  std::vector<CrossedCubes> waiting;
  std::vector<std::uint8_t> kept;
  const auto take = [&](std::size_t most) {
    for (; waiting.size() > most; waiting.erase(waiting.begin())) {
      const std::vector<std::uint8_t> some = fold.add(waiting.front());
      kept.insert(kept.end(), some.begin(), some.end());
    }
  };
  for (std::size_t done = 0; done < rays.ends.size(); done += chunk) {
    const std::size_t count = std::min(chunk, rays.ends.size() - done);
    waiting.push_back(crossed_cubes(std::span(rays.starts).subspan(done, count),
                                    std::span(rays.ends).subspan(done, count), {width}, kNoLimit, &known));
    const VoxelIndex cube = voxel_index(rays.starts[0], {width});
    if (!known.has_centre()) known.centre_on({cube.x >> 2, cube.y >> 2, cube.z >> 2});
    take(late);
  }
  take(0);
  RC_ASSERT(kept == expected);
}

TEST(CrossedCubes, OfRaysThatAreKnownNothingIsTold) {
  const Rays rays = many_rays(3, 500, 1.0);
  const VoxelIndex cube = voxel_index(rays.starts[0], {0.2});
  KnownBricks known(KnownBricks::kMostBytes);
  known.centre_on({cube.x >> 2, cube.y >> 2, cube.z >> 2});
  Fold fold(known);
  fold.add(crossed_cubes(rays.starts, rays.ends, {0.2}, kNoLimit, &known));
  EXPECT_TRUE(crossed_cubes(rays.starts, rays.ends, {0.2}, kNoLimit, &known).cubes.empty());
  known.clear();
  EXPECT_FALSE(crossed_cubes(rays.starts, rays.ends, {0.2}, kNoLimit, &known).cubes.empty());
}

/// Of bricks beyond its reach it would say what it knows of those in the same places.
TEST(CrossedCubes, BeyondReachNothingIsKnown) {
  constexpr std::int64_t kPlaces = 1024, kReach = kPlaces / 2;
  KnownBricks known(kPlaces * 16);
  known.centre_on({0, 0, 0});
  for (std::int64_t x = 1 - kReach; x < kReach; x++)
    known.learn(known.names().of({x, 0, 0}), kAllCubes);
  const auto told = [&](std::int64_t from, std::int64_t to) {
    const Eigen::Vector3d start(static_cast<double>(from) + 0.5, 1.5, 2.5);
    const Eigen::Vector3d end(static_cast<double>(to) + 0.5, 1.5, 2.5);
    std::int64_t cubes = 0;
    for (const std::uint64_t some : crossed_cubes({&start, 1}, {&end, 1}, {1.0}, kNoLimit, &known).cubes)
      cubes += __builtin_popcountll(some);
    return cubes;
  };
  EXPECT_EQ(told(-2000, 2000), 0);
  EXPECT_EQ(told(0, 5000), 5001);
  EXPECT_EQ(told(5000, 0), 5001);
  EXPECT_EQ(told(4 * kPlaces, 4 * kPlaces + 100), 101);
  EXPECT_EQ(told(0, 1000000), 1000001);
}

TEST(BrickNames, HaveRoomForEveryCube) {
  KnownBricks known(1024);
  known.centre_on({0, 0, 0});
  const BrickNames::Name name = known.names().of({-1, 2, -3});
  known.learn(name, kAllCubes);
  EXPECT_EQ(known.cubes(name), kAllCubes);
  EXPECT_EQ(known.cubes(known.names().of({-1, 2, -2})), 0U);
}

}  // namespace
}  // namespace ray
