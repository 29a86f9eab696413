#pragma once
/// How high the ground is, once it is known where: the height at which most ends of a cell lie, not the
/// lowest.

#include "ground_sites.h"

namespace ray {

/// A point for each cell with a site, in its middle: of the heights of its ends above the plane through the
/// sites around, the mean about the lowest peak of their frequency. A noisy ground is met in its middle,
/// where the lowest ends would lie below it, and grass above a ground that can be seen adds nothing. Reads
/// the source to its end. 150 bytes a site, 4 a cell.
[[nodiscard]] std::vector<Eigen::Vector3d> ground_heights(const Context& context, RaySource& source,
                                                          const std::vector<GroundSite>& sites,
                                                          const PlanRaster& raster, double gradient);

}  // namespace ray
