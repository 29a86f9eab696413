// Pairs of scans of one world, cut so that they share a part: how many are aligned, how truly, and how many
// wrongly.

#include "aligned_pairs.h"
#include "street_scene.h"
#include "tables.h"

#include <raycloud/align/clouds.h>
#include <raycloud/core/memory_stream.h>
#include <raycloud/exec/random.h>
#include <raycloud/exec/stream.h>
#include <raycloud/synth/movers.h>
#include <raycloud/synth/scenes.h>
#include <raycloud/synth/simulate.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

namespace bench {
namespace {

struct World {
  std::string name;
  ray::Scene first, second;  ///< the same but for what moves, and the season
  std::uint64_t rays = 0, reference_rays = 0;
  std::vector<double> overlaps{1.0, 0.7, 0.5, 0.4, 0.3, 0.2};
  double tilt = 0.0;     ///< rad, at most so much roll and pitch
  bool is_hard = false;  ///< more than is asked for: only wrong answers have a bar
};

/// The scan of that part of the world where dot(direction, p) is below a limit, so that nothing is known of
/// the rest. The world is cut, not what was measured of it: a cut of measured ends along a wall would leave
/// those that noise moved to one side.
ray::RayCloud part_of(ray::RayCloud rays, const Eigen::Vector3d& direction, double limit) {
  std::vector<std::uint8_t> mask(rays.size());
  const auto x = rays.extra("true_x")->values<double>(), y = rays.extra("true_y")->values<double>(),
             z = rays.extra("true_z")->values<double>();
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const Eigen::Vector3d true_end(x[i], y[i], z[i]), way = true_end - rays.starts[i];
    const double at_start = direction.dot(rays.starts[i]) - limit, at_end = direction.dot(true_end) - limit;
    mask[i] = at_start < 0.0 || at_end < 0.0 ? 1 : 0;
    if ((at_start >= 0.0) == (at_end >= 0.0)) continue;
    const double part = at_start / (at_start - at_end);
    if (at_end >= 0.0) {
      rays.bounded[i] = 0;
      rays.ends[i] = rays.starts[i] + part * way;
    } else {                              // what begins there ends there, whatever the noise
      constexpr double kShortest = 1e-3;  // m
      const double measured = (rays.ends[i] - rays.starts[i]).norm() - kShortest;
      rays.starts[i] += std::min(part, measured / way.norm()) * way;
    }
  }
  rays.select(mask);
  rays.extras.clear();
  return rays;
}

/// Below which a share of the bounded ends lies.
double limit_of(const ray::RayCloud& rays, const Eigen::Vector3d& direction, double share) {
  std::vector<double> places;
  for (std::size_t i = 0; i < rays.size(); ++i)
    if (rays.bounded[i] != 0) places.push_back(direction.dot(rays.ends[i]));
  const auto at =
      places.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(places.size() - 1));
  std::nth_element(places.begin(), at, places.end());
  return share >= 1.0 ? *at + 1000.0 : *at;
}

struct Scans {
  ray::RayCloud first, second;
};

/// Two parts of which each has in common with the other a share of its points, one of them moved.
CloudPair cut_pair(const Scans& scans, double overlap, double tilt, const ray::RandomStream& random,
                   std::uint64_t number) {
  const double heading = 2.0 * std::numbers::pi * random.uniform(number, 0);
  const Eigen::Vector3d direction(std::cos(heading), std::sin(heading), 0.0);
  const double share = 1.0 / (2.0 - overlap);
  return moved_pair(part_of(scans.first, direction, limit_of(scans.first, direction, share)),
                    part_of(scans.second, -direction, limit_of(scans.second, -direction, share)), tilt,
                    random, number);
}

/// Without leaves.
ray::Scene in_winter(ray::Scene scene) {
  constexpr double kNever = std::numeric_limits<double>::infinity();
  for (ray::SceneObject& object : scene.objects)
    if (object.label == ray::SceneLabel::leaf || object.label == ray::SceneLabel::understorey)
      object.present = {kNever, kNever};
  return scene;
}

ray::Scene reversed(ray::Scene scene) {
  std::reverse(scene.path.positions.begin(), scene.path.positions.end());
  return scene;
}

Scans scans_of(const World& world, std::uint64_t seed) {
  const auto scan = [&](const ray::Scene& scene, std::uint64_t rays, std::uint64_t noise) {
    return read_all({}, *simulate(scene, {.rays = rays, .truth = true, .seed = noise}));
  };
  return {scan(world.first, world.rays, 2 * seed), scan(world.second, world.reference_rays, 2 * seed + 1)};
}

std::string row_name(const World& world, double overlap) {
  return world.name + ":" + std::to_string(std::lround(100.0 * overlap));
}

void pair_rows(const World& world, int pairs) {
  constexpr int kScansOfWorld = 2;
  if (std::none_of(world.overlaps.begin(), world.overlaps.end(),
                   [&](double overlap) { return is_wanted(row_name(world, overlap)); }))
    return;
  std::vector<Scans> scans;
  for (std::uint64_t seed = 1; seed <= kScansOfWorld; ++seed)
    scans.push_back(scans_of(world, seed));
  for (const double overlap : world.overlaps) {
    if (!is_wanted(row_name(world, overlap))) continue;
    Tally tally;
    const ray::RandomStream random(7 + other_worlds(),
                                   world.name + std::to_string(std::lround(100.0 * overlap)));
    for (int i = 0; i < pairs; ++i)
      judge(cut_pair(scans[static_cast<std::size_t>(i % kScansOfWorld)], overlap, world.tilt, random,
                     static_cast<std::uint64_t>(i)),
            row_name(world, overlap) + ":" + std::to_string(i), tally);
    const double fine = 100.0 * tally.fine / tally.pairs;
    const bool met =
        tally.wrong == 0 && (world.is_hard || overlap < 0.3 || fine >= (overlap >= 0.5 ? 99.0 : 90.0));
    print_row(world.name + ", " + std::to_string(std::lround(100.0 * overlap)) + " %", tally,
              world.is_hard    ? "wrong < 0.5"
              : overlap >= 0.5 ? "fine ≥ 99, wrong < 0.5"
              : overlap >= 0.3 ? "fine ≥ 90, wrong < 0.5"
                               : "wrong < 0.5",
              met);
  }
}

/// Buildings that were scanned storey after storey, cut into the halves of the time that took. What is in
/// both is the stairs, and every storey looks like the next.
void halves_row(int pairs) {
  const std::string name = "building, halves in time";
  if (!is_wanted(name)) return;
  Tally tally;
  const ray::RandomStream random(7 + other_worlds(), name);
  for (int i = 0; i < pairs; ++i) {
    const auto number = static_cast<std::uint64_t>(i);
    const ray::Scene scene = make_scene(ray::SceneKind::building, 2 + other_worlds() + number);
    ray::RayCloud first = read_all(
        {}, *simulate(scene, {.rays = i % 2 == 0 ? 1'000'000U : 600'000U, .truth = true, .seed = number}));
    const double middle = 0.5 * (first.times.front() + first.times.back());
    std::vector<std::uint8_t> is_early(first.size());
    for (std::size_t k = 0; k < first.size(); ++k)
      is_early[k] = first.times[k] <= middle ? 1 : 0;
    ray::RayCloud second = first;
    first.select(is_early);
    for (std::uint8_t& one : is_early)
      one = 1 - one;
    second.select(is_early);
    const Scans scans{std::move(first), std::move(second)};
    judge(cut_pair(scans, 1.0, 0.0, random, number), name + ":" + std::to_string(i), tally);
  }
  print_row(name, tally, "wrong < 0.5", tally.wrong == 0);
}

}  // namespace

void print_alignment() {
  const int pairs = static_cast<int>(number_given("RAYCLOUD_BENCH_PAIRS_PER_ROW", 6));
  std::printf(
      "\nOne cloud onto another: parts of two scans of one world with other people and vehicles in each, 2 cm of "
      "noise, any yaw, up to 100 m apart; by the share of its points that each has in common with the other. "
      "Coarse: within 0.5 degrees and 0.2 m; fine: 0.05 degrees and 2 cm; wrong: not coarse, and not refused\n\n");
  print_alignment_header();
  const std::uint64_t other = other_worlds();
  const ray::Scene building = make_scene(ray::SceneKind::building, 2 + other),
                   forest = make_scene(ray::SceneKind::forest, 2 + other),
                   street = street_scene(7 + other, 0);
  const auto world = [](const std::string& name, const ray::Scene& scene, std::uint64_t rays) {
    return World{name, with_movers(scene, 6, 1), reversed(with_movers(scene, 6, 2)), rays, rays};
  };
  const auto variant = [](World base, const std::string& name) {
    base.name += name;
    base.overlaps = {0.7, 0.5, 0.3};
    return base;
  };
  const World indoors = world("building", building, 1'000'000), wood = world("forest", forest, 1'000'000);
  pair_rows(indoors, pairs);
  pair_rows(world("street", street, 600'000), pairs);
  pair_rows(wood, pairs);
  World bare = variant(wood, " in summer and winter"), sparse = variant(indoors, ", a tenth of the rays"),
        thin = variant(wood, ", a tenth of the rays"), tilted = variant(indoors, ", tilted by 3 degrees"),
        leaning = variant(wood, ", tilted by 3 degrees"), steep = variant(indoors, ", tilted by 10 degrees");
  bare.second = in_winter(bare.second);
  sparse.rays /= 10, thin.rays /= 10;
  tilted.tilt = leaning.tilt = 3.0 * kDegree;
  steep.tilt = 10.0 * kDegree;
  steep.is_hard = true;
  for (const World* one : {&bare, &sparse, &thin, &tilted, &leaning, &steep})
    pair_rows(*one, pairs);
  halves_row(pairs);
}

}  // namespace bench
