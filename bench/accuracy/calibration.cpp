// Denoising against its own definitions: what a number of sigmas removes of a clean plane, and what a
// distance removes.

#include "kept_rows.h"
#include "room_scan.h"
#include "tables.h"

#include <cmath>
#include <cstdio>
#include <numbers>

namespace bench {

namespace {

/// The share of counted points that are gone.
double removed_share(double sigmas) {
  double all = 0.0;
  double gone = 0.0;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    Sampled plane;
    add_samples(plane, rectangle({-2, -2, 0}, {4, 0, 0}, {0, 4, 0}), {{0, 0, 6}},
                {.noise = 0.02, .seed = seed});
    const std::vector<std::uint8_t> kept = kept_rows(plane.rays, ray::OutsideNeighbours{sigmas});
    for (std::size_t i = 0; i < kept.size(); ++i) {
      if (!plane.truth[i].counted) continue;
      all += 1.0;
      if (kept[i] == 0) gone += 1.0;
    }
  }
  return gone / all;
}

/// Bounded ends with fewer than so many others within the distance are 0, all other rays 1.
std::vector<std::uint8_t> kept_by_definition(const ray::RayCloud& rays, const ray::FarFromOthers& rule) {
  const double distance2 = rule.distance.value * rule.distance.value;
  std::vector<std::uint8_t> kept(rays.size(), 1);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    if (rays.bounded[i] == 0) continue;
    unsigned near = 0;
    for (std::size_t k = 0; k < rays.size() && near < rule.min_neighbours; ++k)
      if (k != i && rays.bounded[k] != 0 && (rays.ends[k] - rays.ends[i]).squaredNorm() <= distance2) ++near;
    kept[i] = near >= rule.min_neighbours ? 1 : 0;
  }
  return kept;
}

}  // namespace

void print_calibration() {
  std::printf("\nDenoising of a clean plane: noise 2 cm, spacing 3 cm\n\n");
  std::printf("| sigmas | removed | normal tail |\n|---|---|---|\n");
  for (const double sigmas : {1.0, 2.0, 3.0, 4.0}) {
    std::printf("| %g | %.3f %% | %.3f %% |\n", sigmas, 100 * removed_share(sigmas),
                100 * std::erfc(sigmas / std::numbers::sqrt2));
  }
}

void print_far_from_others() {
  const Sampled scan = room_scan(1, {true, true, true}, {.rays = 20'000});
  std::printf("\nDenoising by distance against its definition: %zu rays\n\n", scan.rays.size());
  std::printf("| command | removed | differences | bar | |\n|---|---|---|---|---|\n");
  for (const unsigned least : {1U, 3U}) {
    const ray::FarFromOthers rule{.distance = {0.04}, .min_neighbours = least};
    const std::vector<std::uint8_t> expected = kept_by_definition(scan.rays, rule);
    const std::vector<std::uint8_t> kept = kept_rows(scan.rays, rule);
    std::size_t removed = 0;
    std::size_t differences = 0;
    for (std::size_t i = 0; i < kept.size(); ++i) {
      removed += kept[i] == 0 ? 1 : 0;
      differences += kept[i] != expected[i] ? 1 : 0;
    }
    std::printf("| 4 cm, %u neighbours | %zu | %zu | %s |\n", least, removed, differences,
                verdict("0", differences == 0).c_str());
  }
}

}  // namespace bench
