// How true the opacity of ellipsoids is, in a hedge whose opacity is known: of rays that go l m through
// leaves that face anywhere, 1 - exp(-density l / 2) end there.

#include "../cloud_ellipsoids.h"
#include "street_scene.h"
#include "tables.h"

#include <raycloud/exec/stream.h>
#include <raycloud/synth/simulate.h>
#include <raycloud/volume/free_space.h>

#include <cmath>
#include <cstdio>
#include <vector>

namespace bench {
namespace {

constexpr double kRangeNoise = 0.005;  // m
constexpr int kFewestRays = 100;
constexpr std::size_t kSample = 300;  // ellipsoids

/// Of the rays that reach it.
double expected_opacity(const ray::Ellipsoid& ellipsoid, const ray::RayCloud& rays, double density) {
  double sum = 0.0, count = 0.0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const ray::Chord chord = chord_of(ellipsoid, rays.starts[i], rays.ends[i]);
    if (chord.miss2 > 1.0 || chord.enters <= 0.0 || chord.enters >= 1.0) continue;
    const double length = (chord.leaves - chord.enters) * (rays.ends[i] - rays.starts[i]).norm();
    sum += 1.0 - std::exp(-0.5 * density * length);
    count += 1.0;
  }
  return sum / count;
}

void opacity_row(double density, double blade, std::uint64_t count) {
  const ray::Scene scene = hedge_scene(density, blade);
  const ray::RayCloud rays = read_all({}, *simulate(scene, {.rays = count, .noise = kRangeNoise}));
  const ray::EllipsoidTree tree = ellipsoids_of({}, rays, {.by_side = true, .range_noise = kRangeNoise});
  std::vector<ray::Evidence> evidence(tree.size());
  const ray::TimeScale scale(scene.path.times.front(), scene.path.times.back());
  ray::HitTimes times(tree.size());
  times.add(tree, rays, scale);
  times.find_episodes({}, 0.0, evidence);
  add_passes(tree, rays, {}, scale, evidence);
  constexpr double kRim = 0.25;  // m, all of the ellipsoid is in the hedge
  std::vector<std::uint32_t> seen;
  for (std::uint32_t slot = 0; slot < tree.size(); ++slot) {
    const Eigen::Vector3d centre = tree.at_slot(slot).centre;
    const bool inside =
        ((centre - kHedgeLow).array() > kRim).all() && ((kHedgeHigh - centre).array() > kRim).all();
    if (inside && evidence[slot].hits + evidence[slot].crossings >= kFewestRays) seen.push_back(slot);
  }
  double found = 0.0, expected = 0.0, used = 0.0;
  for (std::size_t i = 0; i < seen.size(); i += seen.size() / kSample + 1, used += 1.0) {
    const double others = evidence[seen[i]].hits - 1.0;
    found += others / (others + evidence[seen[i]].crossings);
    expected += expected_opacity(tree.at_slot(seen[i]), rays, density);
  }
  std::printf("| %.0f m²/m³, leaves of %.0f cm | %.0f | %.3f | %.3f | %s |\n", density, 100 * blade, used,
              found / used, expected / used,
              verdict("within 5 %", std::abs(found / expected - 1.0) <= 0.05).c_str());
  std::fflush(stdout);
}

}  // namespace

void print_opacity() {
  std::printf(
      "\nOpacity of ellipsoids within a hedge that %d rays or more have met\n\n"
      "| hedge | ellipsoids | mean opacity | expected | bar | |\n|---|---|---|---|---|---|\n",
      kFewestRays);
  opacity_row(1.0, 0.04, 400'000);
  opacity_row(2.0, 0.02, 1'000'000);
  opacity_row(4.0, 0.01, 2'000'000);
}

}  // namespace bench
