/// Free space against looking at all rays and all ellipsoids.

#include <raycloud/exec/parallel.h>
#include <raycloud/exec/random.h>
#include <raycloud/volume/free_space.h>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <Eigen/Geometry>

namespace ray {
namespace {

const TimeScale kScale(-10.0, 20.0);

struct Scene {
  std::vector<Ellipsoid> ellipsoids;
  RayCloud rays;
};

/// Ellipsoids of all sizes and shapes, some of them flat; rays of all lengths, some of which end in them.
Scene random_scene(std::uint64_t seed, std::size_t ellipsoids, std::size_t rays, double far) {
  const RandomStream random(seed, "free space");
  Scene scene;
  const Eigen::Vector3d middle(far, -far, 0.1 * far);
  const auto point = [&](std::uint64_t index, std::uint64_t draw, double extent) -> Eigen::Vector3d {
    return middle + extent * Eigen::Vector3d(random.uniform(index, draw) - 0.5,
                                             random.uniform(index, draw + 1) - 0.5,
                                             random.uniform(index, draw + 2) - 0.5);
  };
  for (std::size_t i = 0; i < ellipsoids; ++i) {
    Surfel surfel;
    surfel.count = 17;
    const Eigen::Vector3d centre = point(i, 0, 10.0);
    surfel.centroid = centre;
    surfel.normal = (point(i, 3, 1.0) - middle).normalized();
    surfel.axis = surfel.normal.unitOrthogonal();
    const double size = 0.03 * std::pow(20.0, random.uniform(i, 6));
    const double flat = random.below(2, i, 7) == 0 ? 1.0 : 0.03;
    surfel.variances = size * size * Eigen::Vector3d(0.4 * flat * flat, 0.5, 1.0);
    const Eigen::Vector3d own = centre + size * (point(i, 8, 2.0) - middle);
    scene.ellipsoids.push_back(ellipsoid_of(surfel, own, surfel.normal, 0.01));
  }
  scene.rays.resize(rays);
  for (std::size_t i = 0; i < rays; ++i) {
    scene.rays.starts[i] = point(i, 20, 16.0);
    scene.rays.ends[i] = random.below(2, i, 23) == 0 && ellipsoids > 0
                             ? Eigen::Vector3d(scene.ellipsoids[random.below(ellipsoids, i, 24)].centre +
                                               0.02 * (point(i, 25, 1.0) - middle))
                             : point(i, 28, 16.0);
    if (random.below(50, i, 31) == 0) scene.rays.ends[i] = scene.rays.starts[i];
    if (random.below(20, i, 32) == 0) scene.rays.ends[i].x() = scene.rays.starts[i].x();
    scene.rays.times[i] = -10.0 + 30.0 / 65536.0 * (0.5 + static_cast<double>(random.below(65536, i, 33)));
    scene.rays.bounded[i] = random.below(4, i, 34) == 0 ? 0 : 1;
  }
  return scene;
}

EllipsoidTree tree_of(const Context& context, const std::vector<Ellipsoid>& ellipsoids) {
  EllipsoidTree tree(context, ellipsoids.size(), [&](std::size_t i) { return ellipsoids[i].centre; });
  for (std::size_t i = 0; i < ellipsoids.size(); ++i)
    tree.set(i, ellipsoids[i]);
  tree.close(context);
  return tree;
}

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

/// In the frame in which the ellipsoid is the unit ball, by the roots of a quadratic in long double.
struct Ball {
  Eigen::Matrix<long double, 3, 3> to_ball;
  const Ellipsoid& ellipsoid;
  explicit Ball(const Ellipsoid& of)
      : to_ball(of.shape.cast<long double>().llt().matrixL().transpose()), ellipsoid(of) {}
  [[nodiscard]] Eigen::Matrix<long double, 3, 1> at(const Eigen::Vector3d& point) const {
    return to_ball * (point - ellipsoid.centre).cast<long double>();
  }
};

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
    if (rays.bounded[i] != 0 && ball.at(rays.ends[i]).squaredNorm() <= 1.0L) times.push_back(rays.times[i]);
  sum.hits = times.size();
  const auto episodes = plain_episodes(times, rule.look_time);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const auto from = ball.at(rays.starts[i]), to = ball.at(rays.ends[i]);
    const auto way = to - from;
    const long double a = way.squaredNorm(), b = from.dot(way), c = from.squaredNorm() - 1.0L;
    if (!(a > 0.0L) || b * b - a * c < 0.0L) continue;
    const long double root = std::sqrt(b * b - a * c);
    const long double enters = (-b - root) / a, leaves = (-b + root) / a;
    if (enters <= 0.0L || leaves >= 1.0L) continue;
    ++sum.crossings;
    const double length = (rays.ends[i] - rays.starts[i]).norm();
    const double beyond = static_cast<double>(1.0L - leaves) * length;
    if ((root / std::sqrt(a)) * (root / std::sqrt(a)) < 1.0L - rule.guard.most_miss2) continue;
    if (rays.bounded[i] != 0 && beyond < rule.guard.beyond) continue;
    if (!ellipsoid.normal.isZero()) {
      const double sine = std::abs(ellipsoid.normal.dot(rays.ends[i] - rays.starts[i])) / length;
      if (sine < rule.guard.least_sine || (rays.bounded[i] != 0 && beyond * sine < rule.guard.depth))
        continue;
    }
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
