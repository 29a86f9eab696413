#include "coherent_order.h"

#include <raycloud/core/bounds.h>

#include <algorithm>

namespace ray {
namespace {

/// Puts two zeros after each of ten bits.
std::uint32_t spread_bits(std::uint32_t x) {
  x = (x | x << 16) & 0x030000ff;
  x = (x | x << 8) & 0x0300f00f;
  x = (x | x << 4) & 0x030c30c3;
  return (x | x << 2) & 0x09249249;
}

}  // namespace

std::vector<std::uint32_t> coherent_order(const RayCloud& rays, bool only_bounded) {
  constexpr double kSteps = 1023.0;
  Bounds bounds;
  for (std::size_t i = 0; i < rays.size(); ++i)
    if (!only_bounded || rays.bounded[i] != 0) bounds.add(rays.ends[i]);
  const double extent = bounds.extent().maxCoeff();
  const double scale = extent > 0.0 ? kSteps / extent : 0.0;
  std::vector<std::uint64_t> keys;
  keys.reserve(rays.size());
  for (std::size_t i = 0; i < rays.size(); ++i) {
    if (only_bounded && rays.bounded[i] == 0) continue;
    const Eigen::Vector3d at = (rays.ends[i] - bounds.min) * scale;
    const auto bits = [&](int axis) { return spread_bits(static_cast<std::uint32_t>(at[axis])); };
    keys.push_back(std::uint64_t{bits(0) << 2 | bits(1) << 1 | bits(2)} << 32 | i);
  }
  std::sort(keys.begin(), keys.end());
  std::vector<std::uint32_t> order(keys.size());
  for (std::size_t i = 0; i < keys.size(); ++i)
    order[i] = static_cast<std::uint32_t>(keys[i]);
  return order;
}

}  // namespace ray
