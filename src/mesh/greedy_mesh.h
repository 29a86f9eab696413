#pragma once
/// A mesh of as few of many heights as describe them.

#include <raycloud/core/mesh.h>
#include <raycloud/exec/context.h>

#include <cstdint>
#include <vector>

namespace ray {

/// The Delaunay triangulation (in plan) of some of the points, with fronts upwards, of which no point is
/// further than `tolerance` above or below: one by one the worst (to a factor of two) is added (greedy
/// insertion; Garland and Heckbert, 1995), to those that `begin_with` names: some that are spread evenly make
/// it quicker. It covers the convex hull of their plan. Of points at one place of the plan one is used. Empty
/// if all lie on a line of the plan. O(n log n), 150 bytes a point. The result does not depend on the
/// threads.
[[nodiscard]] Mesh greedy_mesh(const Context& context, const std::vector<Eigen::Vector3d>& points,
                               double tolerance, const std::vector<std::uint32_t>& begin_with);

}  // namespace ray
