#pragma once
/// Which points are ground at all: those with nothing below them in a cone.

#include <raycloud/exec/context.h>

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

namespace ray {

/// For each point 1 if no other one lies in the cone below it: if no q has z(q) + gradient · d(p, q) < z(p),
/// d being the distance in plan. These are the points of the highest surface below all points that is nowhere
/// steeper than the gradient. Exactly what comparing all pairs gives, to the bit; expected O(n log n), as
/// cones of points that are near each other decide nearly all. 30 bytes a point.
/// Precondition: finite points, gradient ≥ 0.
[[nodiscard]] std::vector<std::uint8_t> cone_envelope(const Context& context,
                                                      std::span<const Eigen::Vector3d> points,
                                                      double gradient);

}  // namespace ray
