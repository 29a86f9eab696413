#pragma once
/// Which ray of an edited cloud is which ray of the original.

#include "rigid_fit.h"

#include <raycloud/core/ray_cloud.h>
#include <raycloud/exec/context.h>

#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

namespace ray {

/// The columns that two clouds share, by their numbers. Throws Error(wrong_content) where types differ.
[[nodiscard]] std::vector<std::pair<std::size_t, std::size_t>> shared_extras(const RayCloud& original,
                                                                             const RayCloud& edited);

/// At most one partner for each ray, of the same time. Among several rays of one time those are paired that
/// have the same bits everywhere; then the same start and end; then the start and end to which the motion of
/// rays that are certain carries them, or `motion` where it is known; then by order, or by distance where
/// rays are missing. Throws Error(wrong_content) where that leaves too much open. O(n log n); 32 bytes a ray.
[[nodiscard]] std::vector<RowPair> pair_rays(const Context& context, const RayCloud& original,
                                             const RayCloud& edited, const std::optional<Pose>& motion);

}  // namespace ray
