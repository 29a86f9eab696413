#include <raycloud/exec/parallel.h>
#include <raycloud/exec/random.h>
#include <raycloud/spatial/seen_through.h>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <numeric>
#include <vector>

namespace ray {
namespace {

struct Shot {
  Eigen::Vector3d start, end;
  bool bounded = true;
};

Eigen::Vector3d random_in_box(const RandomStream& random, std::uint64_t i, std::uint64_t draw) {
  return {random.uniform(i, draw) - 0.5, random.uniform(i, draw + 1) - 0.5,
          random.uniform(i, draw + 2) - 0.5};
}

/// Points in a cube of some side, half of them in a corner of it, and rays across: one of eight along an
/// axis, some without a length, to a point, from far away, or without an end.
struct ShotsAtBalls {
  std::vector<Eigen::Vector3d> points;
  std::vector<Shot> rays;

  ShotsAtBalls(std::uint64_t seed, std::size_t count, double side, const Eigen::Vector3d& middle) {
    const RandomStream random(seed, "balls");
    for (std::size_t i = 0; i < count; ++i) {
      const double extent = i % 2 == 0 ? side : 0.1 * side;
      points.push_back(middle + extent * random_in_box(random, i, 0));
      if (i % 16 == 1) points.back() = points[i - 1];
    }
    for (std::size_t i = 0; i < 100; ++i) {
      const Eigen::Vector3d across = 1.5 * side * random_in_box(random, i, 3);
      Shot ray{middle + across, middle + (i % 2 == 0 ? 1.2 : 0.2) * side * random_in_box(random, i, 6)};
      const auto axis = static_cast<Eigen::Index>(random.below(3, i, 9));
      if (i % 8 == 0) ray.end = ray.start + 2.0 * across[axis] * Eigen::Vector3d::Unit(axis);
      if (i % 50 == 3) ray.end = ray.start;
      if (i % 10 == 4 && !points.empty()) ray.end = points[i % points.size()];
      if (i % 40 == 5) ray.start += 1e4 * side * across.normalized();
      ray.bounded = i % 5 != 0;
      rays.push_back(ray);
    }
  }
};

std::vector<std::uint32_t> passes_of(const ShotsAtBalls& scene, double radius, unsigned threads) {
  SeenThrough balls(scene.points, radius);
  parallel_for({.threads = threads}, scene.rays.size(), 7, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      balls.add(scene.rays[i].start, scene.rays[i].end, scene.rays[i].bounded);
  });
  std::vector<std::uint32_t> passes;
  for (std::size_t i = 0; i < balls.size(); ++i)
    passes.push_back(balls.passes(i));
  return passes;
}

/// Every ray against every ball, by the point of the ray that is nearest to the middle.
std::vector<std::uint32_t> passes_by_all_pairs(const ShotsAtBalls& scene, double radius) {
  std::vector<std::uint32_t> passes(scene.points.size());
  for (const Shot& ray : scene.rays) {
    const double length = (ray.end - ray.start).norm();
    if (!(length > 0.0)) continue;
    const Eigen::Vector3d direction = (ray.end - ray.start) / length;
    for (std::size_t i = 0; i < passes.size(); ++i) {
      const Eigen::Vector3d offset = scene.points[i] - ray.start;
      const double along = offset.dot(direction);
      const bool is_behind = along < (ray.bounded ? length - radius : length);
      if (along >= 0.0 && is_behind && offset.squaredNorm() - along * along < radius * radius) ++passes[i];
    }
  }
  return passes;
}

std::size_t sum_of(const std::vector<std::uint32_t>& values) {
  return std::accumulate(values.begin(), values.end(), std::size_t{0});
}

RC_GTEST_PROP(SeenThrough, CountsWhatAllPairsCount, (std::uint64_t seed)) {
  const auto count = *rc::gen::inRange<std::size_t>(0, 200);
  // In a few radii there are groups in each brick, in thousands most bricks are empty.
  const double side = std::pow(10.0, *rc::gen::inRange(0, 4));
  const double radius = std::pow(10.0, *rc::gen::inRange(-3, 1));
  const bool is_far = *rc::gen::arbitrary<bool>();
  const Eigen::Vector3d middle = is_far ? Eigen::Vector3d(5e5, 5.4e6, 100.0) : Eigen::Vector3d::Zero();
  const ShotsAtBalls scene(seed, count, radius * side, middle);
  const std::vector<std::uint32_t> expected = passes_by_all_pairs(scene, radius);
  RC_CLASSIFY(sum_of(expected) > 0, "some pass");
  for (const unsigned threads : {1U, 3U})
    RC_ASSERT(passes_of(scene, radius, threads) == expected);
}

/// Where one is far away, the bricks of the others share cells with those of nowhere.
TEST(SeenThrough, APointFarAwayChangesNothing) {
  ShotsAtBalls scene(3, 300, 50.0, Eigen::Vector3d::Zero());
  const std::vector<std::uint32_t> before = passes_of(scene, 0.5, 1);
  EXPECT_GT(sum_of(before), 20U);
  scene.points.push_back({1e7, -1e7, 1e5});
  std::vector<std::uint32_t> after = passes_of(scene, 0.5, 1);
  EXPECT_EQ(after.back(), 0U);
  after.pop_back();
  EXPECT_EQ(after, before);
}

/// A brick with so many points has groups; a ray passes those beside it, not those behind its end.
TEST(SeenThrough, ARowOfPointsIsPassedUpToTheEndLessTheRadius) {
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i < 1000; ++i)
    points.emplace_back(0.01 * i, 0.05, 0.0);
  SeenThrough balls(points, 0.1);
  balls.add({-1.0, 0.0, 0.0}, {5.005, 0.0, 0.0}, true);
  balls.add({12.0, 0.0, 0.0}, {7.005, 0.0, 0.0}, false);
  for (int i = 0; i < 1000; ++i)
    EXPECT_EQ(balls.passes(static_cast<std::size_t>(i)), i <= 490 || i > 700 ? 1U : 0U) << i;
}

}  // namespace
}  // namespace ray
