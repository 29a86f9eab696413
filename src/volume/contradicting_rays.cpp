#include "contradicting_rays.h"

#include "coherent_order.h"
#include "mix_bits.h"
#include "ray_path.h"

#include <algorithm>
#include <bit>

namespace ray {
namespace {

std::uint64_t hash_of(const Eigen::Vector3d& point, std::uint64_t seed) {
  for (const double coordinate : {point.x(), point.y(), point.z()})
    seed = mix_bits(seed + 0x9e3779b97f4a7c15ULL + std::bit_cast<std::uint64_t>(coordinate));
  return seed;
}

/// In [0, 1).
float fraction_of(std::uint64_t bits) {
  return static_cast<float>(bits >> 40) * 0x1p-24F;
}

}  // namespace

std::vector<float> contradicting_rays(const EllipsoidTree& tree, const RayCloud& rays, const PassGuard& guard,
                                      const PassScore& score,
                                      const std::function<float(std::uint32_t)>& opacity) {
  std::vector<float> scores(rays.size());
  std::vector<std::uint32_t> slots;
  for (const std::uint32_t i : coherent_order(rays, false)) {
    tree.near_line(rays.starts[i], rays.ends[i], slots);
    if (slots.empty()) continue;
    const RayPath path(rays, i);
    const std::uint64_t hash = hash_of(rays.ends[i], std::bit_cast<std::uint64_t>(rays.times[i]));
    for (const std::uint32_t slot : slots) {
      const float of_slot = score(slot, rays.times[i]);
      if (!(of_slot > scores[i])) continue;
      const Ellipsoid ellipsoid = tree.at_slot(slot);
      if (path.cross(ellipsoid, guard) != Crossing::proves_empty) continue;
      if (fraction_of(hash_of(ellipsoid.centre, hash)) < opacity(slot)) scores[i] = of_slot;
    }
  }
  return scores;
}

}  // namespace ray
