#pragma once
/// Which surfaces of one cloud lie in the way of rays of another: to the noise of the points, where free
/// cubes tell to a cube or two.

#include "agreement.h"
#include "patches.h"

#include <raycloud/core/pose.h>
#include <raycloud/exec/context.h>

#include <cstdint>
#include <vector>

namespace ray::align {

/// An even choice of at most `most` of the rays that hit a surface, one of each of its cubes.
[[nodiscard]] std::vector<Segment> sightlines_of(const Surfaces& surfaces, std::size_t most);

/// For each patch of a level 1 if one of the rays, moved by a pose, goes through it, else 0. Only clean
/// patches are told of, and only rays that begin and end well off their plane: by a quarter of a width.
/// O(cubes crossed): 50 ns each. Depends on neither threads nor the order of the rays.
[[nodiscard]] std::vector<std::uint8_t> pierced_patches(const Context& context,
                                                        const std::vector<Segment>& rays, const Pose& pose,
                                                        const PatchLevel& level);

}  // namespace ray::align
