#pragma once
/// Which rays of a chunk stay when some are noise.

#include <raycloud/core/ray_cloud.h>

#include <cstdint>
#include <span>
#include <vector>

namespace ray {

/// 1 for each ray but the bounded ones that are noise. Precondition: `noise` has a byte for each bounded ray.
inline std::vector<std::uint8_t> without_noise(const RayCloud& rays, std::span<const std::uint8_t> noise) {
  std::vector<std::uint8_t> mask(rays.size(), 1);
  std::size_t next = 0;
  for (std::size_t i = 0; i < rays.size(); ++i)
    if (rays.bounded[i] != 0) mask[i] = noise[next++] == 0 ? 1 : 0;
  return mask;
}

}  // namespace ray
