#pragma once
/// The rays that saw through what was there at another time.

#include <raycloud/core/ray_cloud.h>
#include <raycloud/volume/free_space.h>

#include <functional>
#include <span>
#include <vector>

namespace ray {

/// For each ray the largest of the scores of the ellipsoids that it passes, as PassGuard has it, outside of
/// their episodes. `score(slot, run)` is that of an ellipsoid for a pass in a run of Evidence::run_at. Of a
/// porous ellipsoid not all passes are a contradiction: the share `opacity(slot)` of them, by a hash of ray
/// and ellipsoid, so that it is the same in every order. Thread-safe. About 1 µs a ray.
[[nodiscard]] std::vector<float> contradicting_rays(
    const EllipsoidTree& tree, const RayCloud& rays, const PassGuard& guard, const TimeScale& scale,
    std::span<const Evidence> evidence,
    const std::function<float(std::uint32_t slot, std::size_t run)>& score,
    const std::function<float(std::uint32_t slot)>& opacity);

}  // namespace ray
