// How true the opacity of ellipsoids is, in hedges whose opacity is known: of rays that go l m through leaves
// that face anywhere, 1 - exp(-density l / 2) end there.

#include "../cloud_ellipsoids.h"
#include "street_scene.h"
#include "tables.h"
#include "volume/transience.h"

#include <raycloud/exec/parallel.h>
#include <raycloud/exec/random.h>
#include <raycloud/exec/stream.h>
#include <raycloud/synth/simulate.h>
#include <raycloud/volume/free_space.h>

#include <atomic>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <vector>

namespace bench {
namespace {

constexpr double kRangeNoise = 0.005;  // m
constexpr double kHedgeRim = 0.25;     // m, all of an ellipsoid is in the hedge
constexpr double kFewestRays = 100.0;
constexpr std::uint64_t kOfOther = 5;  // rays of the other scan for each of the first

const Eigen::Vector3d kMiddleLow = kHedgeLow + Eigen::Vector3d::Constant(kHedgeRim);
const Eigen::Vector3d kMiddleHigh = kHedgeHigh - Eigen::Vector3d::Constant(kHedgeRim);

ray::RayCloud hedge_scan(const ray::Scene& scene, std::uint64_t rays, std::uint64_t seed) {
  return read_all({}, *simulate(scene, {.rays = rays, .noise = kRangeNoise, .seed = seed}));
}

std::vector<ray::Evidence> all_evidence(const ray::EllipsoidTree& tree, const ray::RayCloud& rays) {
  const ray::TimeScale scale(rays.times.front(), rays.times.back());
  std::vector<ray::Evidence> evidence(tree.size());
  ray::HitTimes times(tree.size());
  times.add(tree, rays, scale);
  times.find_episodes({}, 0.0, evidence);
  add_passes(tree, rays, {}, scale, evidence);
  return evidence;
}

/// By slot: the share of the rays which reach an ellipsoid that is to end in it.
std::vector<double> analytic_opacity(const ray::EllipsoidTree& tree, const ray::RayCloud& rays,
                                     double density) {
  std::vector<double> sums(tree.size()), counts(tree.size());
  std::vector<std::uint32_t> crossed, ended;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    tree.near_line(rays.starts[i], rays.ends[i], crossed);
    tree.holding(rays.ends[i], ended);
    const auto add = [&](std::uint32_t slot, bool ends) {
      const ray::Chord chord = chord_of(tree.at_slot(slot), rays.starts[i], rays.ends[i]);
      if (chord.miss2 > 1.0 || chord.enters <= 0.0 || (chord.leaves >= 1.0) != ends) return;
      const double length = (chord.leaves - chord.enters) * (rays.ends[i] - rays.starts[i]).norm();
      sums[slot] += 1.0 - std::exp(-0.5 * density * length);
      counts[slot] += 1.0;
    };
    for (const std::uint32_t slot : crossed)
      add(slot, false);
    for (const std::uint32_t slot : ended)
      add(slot, true);
  }
  for (std::size_t slot = 0; slot < sums.size(); ++slot)
    sums[slot] = counts[slot] > 0.0 ? sums[slot] / counts[slot] : 0.0;
  return sums;
}

std::vector<ray::Ellipsoid> in_the_middle(const ray::EllipsoidTree& tree) {
  std::vector<ray::Ellipsoid> middle;
  for (std::uint32_t slot = 0; slot < tree.size(); ++slot) {
    const ray::Ellipsoid ellipsoid = tree.at_slot(slot);
    if ((ellipsoid.centre.array() > kMiddleLow.array()).all() &&
        (ellipsoid.centre.array() < kMiddleHigh.array()).all())
      middle.push_back(ellipsoid);
  }
  return middle;
}

ray::EllipsoidTree tree_of_all(const std::vector<ray::Ellipsoid>& ellipsoids) {
  ray::EllipsoidTree tree({}, ellipsoids.size(), [&](std::size_t i) { return ellipsoids[i].centre; });
  for (std::size_t i = 0; i < ellipsoids.size(); ++i)
    tree.set(i, ellipsoids[i]);
  tree.close({});
  return tree;
}

struct OpacityMeans {
  double found = 0.0, truth = 0.0, count = 0.0;
  void add(double of_found, double of_truth) { found += of_found, truth += of_truth, count += 1.0; }
};

double share_ended(const ray::Evidence& evidence) {
  const double hits = evidence.hits;
  return hits / (hits + evidence.crossings);
}

struct HedgeOpacity {
  OpacityMeans anywhere;  ///< ellipsoids at places chosen without knowing the leaves, and analytic values
  OpacityMeans around_hits, met;  ///< the column of ellipsoids around hits, all and those that enough rays
                                  ///< met, and what the other scan says of them
  double analytic_of_met = 0.0;   ///< sum
};

void add_hedge(double density, double blade, std::uint64_t count, std::uint64_t seed, HedgeOpacity& sums) {
  const ray::Scene scene = hedge_scene(density, blade, seed);
  const ray::RayCloud rays = hedge_scan(scene, count, seed),
                      other = hedge_scan(scene, kOfOther * count, seed + 100);
  const std::vector<ray::Ellipsoid> found =
      in_the_middle(ellipsoids_of({}, rays, {.range_noise = kRangeNoise}));
  {
    const ray::EllipsoidTree tree = tree_of_all(found);
    const std::vector<ray::Evidence> own = all_evidence(tree, rays), of_other = all_evidence(tree, other);
    const std::vector<double> analytic = analytic_opacity(tree, rays, density);
    for (std::uint32_t slot = 0; slot < tree.size(); ++slot) {
      const auto column = static_cast<double>(opacity_of(own[slot]));
      sums.around_hits.add(column, share_ended(of_other[slot]));
      if (of_other[slot].hits + of_other[slot].crossings < kOfOther * kFewestRays) continue;
      sums.met.add(column, share_ended(of_other[slot]));
      sums.analytic_of_met += analytic[slot];
    }
  }
  const ray::RandomStream random(seed, "places");
  std::vector<ray::Ellipsoid> moved = found;
  for (std::size_t i = 0; i < moved.size(); ++i)
    for (int axis = 0; axis < 3; ++axis)
      moved[i].centre[axis] = kMiddleLow[axis] + (kMiddleHigh[axis] - kMiddleLow[axis]) *
                                                     random.uniform(i, static_cast<std::uint64_t>(axis));
  const ray::EllipsoidTree tree = tree_of_all(moved);
  const std::vector<ray::Evidence> evidence = all_evidence(tree, rays);
  const std::vector<double> analytic = analytic_opacity(tree, rays, density);
  for (std::uint32_t slot = 0; slot < tree.size(); ++slot)
    if (evidence[slot].hits + evidence[slot].crossings >= kFewestRays)
      sums.anywhere.add(share_ended(evidence[slot]), analytic[slot]);
}

void opacity_row(double density, double blade, std::uint64_t count, std::uint64_t hedges) {
  HedgeOpacity sums;
  for (std::uint64_t seed = 1; seed <= hedges; ++seed)
    add_hedge(density, blade, count, seed, sums);
  const auto means = [](const OpacityMeans& of) {
    std::printf(" %.0f | %.4f | %.4f |", of.count, of.found / of.count, of.truth / of.count);
  };
  std::printf("| %.0f m²/m³, leaves of %.0f cm, %.1f M rays |", density, 100 * blade,
              1e-6 * static_cast<double>(count));
  means(sums.anywhere);
  means(sums.met);
  std::printf(" %.4f |", sums.analytic_of_met / sums.met.count);
  means(sums.around_hits);
  const double error = sums.anywhere.found / sums.anywhere.truth - 1.0;
  std::printf(" %s |\n", verdict("anywhere: within 5 %", std::abs(error) <= 0.05).c_str());
  std::fflush(stdout);
}

}  // namespace

void print_opacity() {
  std::printf(
      "\nOpacity within hedges. Anywhere: ellipsoids as large as those around hits, but at random places, that "
      "%.0f rays or more have met, and the analytic value. Around hits: the column of raytransients, and what "
      "another scan with %.0f times the rays finds in the same ellipsoids; those that %.0f rays meet, with the "
      "analytic value, which knows of no leaf that was hit, and all\n\n"
      "| hedge | anywhere | opacity | analytic | around hits, many rays | opacity | other scan | analytic | "
      "around hits, all | opacity | other scan | bar | |\n"
      "|---|---|---|---|---|---|---|---|---|---|---|---|---|\n",
      kFewestRays, static_cast<double>(kOfOther), kFewestRays);
  opacity_row(1.0, 0.04, 500'000, 4);
  opacity_row(1.0, 0.04, 2'000'000, 2);
  opacity_row(1.0, 0.02, 2'000'000, 2);
  opacity_row(1.0, 0.01, 2'000'000, 1);
  opacity_row(2.0, 0.02, 2'000'000, 1);
}

}  // namespace bench
