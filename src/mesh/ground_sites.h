#pragma once
/// Where the ground may be: at most one place in each cell of the map.

#include "plan_raster.h"

#include <raycloud/exec/stream.h>

#include <Eigen/Core>
#include <vector>

namespace ray {

struct GroundSite {
  Eigen::Vector3d place = Eigen::Vector3d::Zero();  ///< m; an end
  bool is_there = false;
};

/// One for each cell: the lowest end of the lowest level of the cell (half a cell high) that has support and
/// is no pit. A level has support if it and what lies about as low in the eight cells around, given the
/// gradient, are three ends or more, and half a percent of all ends of these cells. A pit is what few ends
/// have made and what lies in a hole of a smooth ground, below everything around, or behind the ground on
/// the way from the sensor: no ray comes through the ground, but false returns seem to. The cell's next
/// level takes its place. Where rays to other sites pass under what was found there is no site. Reads the
/// source to its end. 60 bytes a cell, and 200 more for each that has ends.
[[nodiscard]] std::vector<GroundSite> ground_sites(const Context& context, RaySource& source,
                                                   const PlanRaster& raster, double gradient);

}  // namespace ray
