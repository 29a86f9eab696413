#pragma once
/// The rays that saw through what was there at another time, or in another cloud.

#include <raycloud/core/ray_cloud.h>
#include <raycloud/volume/free_space.h>

#include <functional>
#include <vector>

namespace ray {

/// The score of an ellipsoid, by its slot, for a pass at a time (s); 0 where such a pass contradicts nothing.
using PassScore = std::function<float(std::uint32_t slot, double time)>;

/// For each ray the largest of the scores of the ellipsoids that it passes, as PassGuard has it. Of a
/// porous ellipsoid not all passes are a contradiction: the share `opacity(slot)` of them, by a hash of ray
/// and ellipsoid, so that it is the same in every order. Thread-safe. About 1 µs a ray.
[[nodiscard]] std::vector<float> contradicting_rays(const EllipsoidTree& tree, const RayCloud& rays,
                                                    const PassGuard& guard, const PassScore& score,
                                                    const std::function<float(std::uint32_t slot)>& opacity);

}  // namespace ray
