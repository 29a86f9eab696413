#pragma once
/// Which sites stand on the ground rather than in it.

#include "ground_sites.h"

#include <cstdint>
#include <vector>

namespace ray {

/// 1 for each site that an opening with growing windows lowers: what stands on the ground goes all at once
/// with the first window that is wider than it, where a hill is worn down bit by bit (progressive
/// morphological filter; Zhang et al., 2003; with thresholds that grow as windows do: Pingel, Clarke and
/// McBride, 2013). A slope, whatever its gradient, and the edge of a terrace stay. What is wider than 60 m
/// is ground. O(cells), some 30 openings.
[[nodiscard]] std::vector<std::uint8_t> raised_sites(const Context& context,
                                                     const std::vector<GroundSite>& sites,
                                                     const PlanRaster& raster);

/// 1 for each site with another one in the cone below it (mesh/cone_envelope.h).
[[nodiscard]] std::vector<std::uint8_t> sites_above_cones(const Context& context,
                                                          const std::vector<GroundSite>& sites,
                                                          double gradient);

/// Sites that are `doubtful` (1), beside those that are surely ground (0), become ground, round by round,
/// where they continue it: on the plane through the ground sites around. The tops of hills, and terraces
/// beside their steps, come back so; what has a step all around does not.
void grow_ground(const Context& context, const std::vector<GroundSite>& sites, const PlanRaster& raster,
                 std::vector<std::uint8_t>& doubtful);

}  // namespace ray
