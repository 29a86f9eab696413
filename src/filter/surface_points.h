#pragma once
/// What the tools that look at surfaces have in common: which points they take and how far they look.

#include <raycloud/core/ray_cloud.h>
#include <raycloud/exec/blocks.h>
#include <raycloud/spatial/seen_point.h>
#include <raycloud/spatial/surfel.h>

#include <functional>

namespace ray {

inline constexpr std::size_t kSurfaceNeighbours = 16;

inline constexpr double kReachSpacings = 32.0;  ///< how far neighbours may be, in spacings

inline SeenPoint seen_point(const RayCloud& rays, std::size_t i) {
  return {rays.ends[i], pack_direction(rays.starts[i] - rays.ends[i])};
}

/// How far neighbours may be, by the sample alone: far enough for places with a hundredth of the density of
/// the rest. What is further from everything else has no neighbours. Infinite for very few points, 0
/// where all are in one place.
[[nodiscard]] double neighbour_reach(const EndSample& sample);

/// Calls `work(search, begin, end)` for ranges of places that cover the tree, on all threads; places of a
/// range are near each other.
void for_each_place(const Context& context, const PointTree& tree,
                    const std::function<void(NeighbourSearch&, std::size_t begin, std::size_t end)>& work);

}  // namespace ray
