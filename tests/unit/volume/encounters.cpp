/// Encounters of two clouds against looking at all rays and all ellipsoids.

#include "volume/encounters.h"

#include "all_pairs.h"
#include "volume/look.h"

#include <raycloud/exec/parallel.h>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <numeric>

namespace ray {
namespace {

using namespace test;

const FineTime kFine(kFirstTime, kLastTime);

/// `add(chunk, first)` for the rays in pieces, on any thread.
template <class Add>
void each_piece(const Context& context, const RayCloud& rays, const Add& add) {
  constexpr std::size_t kPiece = 37;
  parallel_for(context, rays.size(), kPiece, [&](std::size_t begin, std::size_t end) {
    std::vector<std::uint32_t> rows(end - begin);
    std::iota(rows.begin(), rows.end(), static_cast<std::uint32_t>(begin));
    RayCloud piece;
    piece.assign_rows(rays, rows);
    add(piece, begin);
  });
}

/// Times that are not those of the rays, as of clouds without.
std::vector<double> other_times(std::size_t rays) {
  std::vector<double> times(rays);
  for (std::size_t i = 0; i < rays; ++i)
    times[i] = 0.1 * static_cast<double>(i);
  return times;
}

std::vector<Encounters> encountered(const Context& context, const EllipsoidTree& tree, const RayCloud& rays,
                                    const CountRule& rule) {
  std::vector<Encounters> met(tree.size());
  const std::vector<double> look_times = other_times(rays.size());
  each_piece(context, rays, [&](const RayCloud& piece, std::size_t first) {
    add_encounters(tree, piece, std::span(look_times).subspan(first, piece.size()), rule, kFine, met);
  });
  return met;
}

Encounters plainly_encountered(const Ellipsoid& ellipsoid, const RayCloud& rays, const CountRule& rule) {
  const std::vector<double> look_times = other_times(rays.size());
  const Ball ball(ellipsoid);
  Encounters met;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const std::uint64_t tick = kFine.tick(rays.times[i]);
    if (is_hit(ball, rays, i)) {
      ++met.hits;
      met.hit_ticks += tick;
    }
    const PlainCrossing crossing = plain_crossing(ball, rays, i, rule.guard);
    if (crossing.crosses) ++met.crossings;
    if (!crossing.proves_empty) continue;
    ++met.passes;
    met.pass_ticks += tick;
    met.looks |= look_of(look_times[i], rays.ends[i] - rays.starts[i], rule.look_time);
  }
  return met;
}

void expect_same_encounters(const Scene& scene, const CountRule& rule) {
  const EllipsoidTree tree = tree_of({}, scene.ellipsoids);
  const std::vector<Encounters> fast = encountered({}, tree, scene.rays, rule);
  std::vector<std::uint8_t> passes(tree.size());
  each_piece({}, scene.rays,
             [&](const RayCloud& piece, std::size_t) { count_passes(tree, piece, rule.guard, passes); });
  for (std::size_t i = 0; i < tree.size(); ++i) {
    const Encounters plain = plainly_encountered(scene.ellipsoids[i], scene.rays, rule);
    const Encounters& met = fast[tree.slot(i)];
    ASSERT_EQ(met.hits, plain.hits) << i;
    ASSERT_EQ(met.crossings, plain.crossings) << i;
    ASSERT_EQ(met.passes, plain.passes) << i;
    ASSERT_EQ(met.looks, plain.looks) << i;
    ASSERT_EQ(met.hit_ticks, plain.hit_ticks) << i;
    ASSERT_EQ(met.pass_ticks, plain.pass_ticks) << i;
    ASSERT_EQ(passes[tree.slot(i)], std::min(plain.passes, 255U)) << i;
  }
}

TEST(Encounters, areThoseOfAllPairs) {
  std::uint64_t seed = 20;
  for (const double far : {0.0, 300.0, 5e5})
    for (const PassGuard& guard : {PassGuard{}, kEveryPass})
      expect_same_encounters(random_scene(++seed, 300, 500, far), {.guard = guard});
}

RC_GTEST_PROP(Encounters, areThoseOfAllPairsForAnyNumbers, (std::uint64_t seed)) {
  const auto ellipsoids = *rc::gen::inRange<std::size_t>(0, 60);
  const auto rays = *rc::gen::inRange<std::size_t>(0, 60);
  expect_same_encounters(random_scene(seed, ellipsoids, rays, 0.0), {});
}

TEST(Encounters, passesAreCountedUpTo255) {
  Scene scene = random_scene(5, 1, 2, 0.0);
  const Eigen::Vector3d centre = scene.ellipsoids.front().centre;
  scene.rays.resize(700);
  for (std::size_t i = 0; i < scene.rays.size(); ++i) {
    scene.rays.starts[i] = centre - 20.0 * Eigen::Vector3d(1.0, 0.5, 0.25);
    scene.rays.ends[i] = centre + 20.0 * Eigen::Vector3d(1.0, 0.5, 0.25);
    scene.rays.times[i] = 0.0;
    scene.rays.bounded[i] = 1;
  }
  expect_same_encounters(scene, {.guard = kEveryPass});
}

TEST(Encounters, someEllipsoidsMeetWhatTheyMeetAmongAll) {
  const Scene scene = random_scene(8, 400, 600, 0.0);
  const EllipsoidTree tree = tree_of({}, scene.ellipsoids);
  const std::vector<Encounters> all = encountered({}, tree, scene.rays, {});
  std::vector<std::uint32_t> slots;
  for (std::uint32_t slot = 0; slot < tree.size(); slot += 3)
    slots.push_back(slot);
  const SomeEllipsoids some = some_of({}, tree, slots);
  const std::vector<Encounters> of_some = encountered({}, *some.tree, scene.rays, {});
  for (std::size_t i = 0; i < slots.size(); ++i) {
    const Encounters& met = of_some[some.tree->slot(i)];
    ASSERT_EQ(met.hits, all[slots[i]].hits);
    ASSERT_EQ(met.crossings, all[slots[i]].crossings);
    ASSERT_EQ(met.pass_ticks, all[slots[i]].pass_ticks);
    ASSERT_EQ(met.looks, all[slots[i]].looks);
  }
}

}  // namespace
}  // namespace ray
