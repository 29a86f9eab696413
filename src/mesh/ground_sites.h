#pragma once
/// Where the ground may be: at most one place in each cell of the map.

#include "plan_raster.h"

#include <raycloud/exec/stream.h>

#include <Eigen/Core>
#include <vector>

namespace ray {

struct GroundSite {
  Eigen::Vector3d place = Eigen::Vector3d::Zero();  ///< m; the mean of some ends
  bool is_there = false;
};

/// One for each cell: the mean of the ends on the lowest level of the cell (half a cell high) that has
/// support. A level has it if it and what lies about as low in the eight cells around, given the gradient,
/// are three ends or more, and half a percent of all ends of these cells: so false returns below the
/// ground, which are few and lie anywhere, have none. A level of few ends that is a hole in the ground around
/// gives way to the next. Reads the source to its end. 130 bytes a cell.
[[nodiscard]] std::vector<GroundSite> ground_sites(const Context& context, RaySource& source,
                                                   const PlanRaster& raster, double gradient);

/// Takes out what stands on the ground: sites are connected to those of the cells around if the gradient
/// leads from one to the other, and connected parts that are higher than three quarters of what borders on
/// them go. The largest part stays. Repeated until nothing goes, for what stands upon what.
void remove_raised(std::vector<GroundSite>& sites, const PlanRaster& raster, double gradient);

/// Takes out sites with another one in the cone below them (mesh/cone_envelope.h).
void remove_above_cones(std::vector<GroundSite>& sites, double gradient);

}  // namespace ray
