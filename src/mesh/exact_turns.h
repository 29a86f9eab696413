#pragma once
/// On which side of a plane or a line a place is, exact for any doubles: where rounding leaves a doubt, the
/// determinant is summed as an expansion that loses nothing (Shewchuk, "Adaptive precision floating-point
/// arithmetic and fast robust geometric predicates", 1997).

#include <Eigen/Core>

namespace ray {

/// 1 if d is in front of a, b, c (which run anticlockwise as seen from there), -1 behind, 0 in their plane.
[[nodiscard]] int turn_in_space(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c,
                                const Eigen::Vector3d& d);

/// 1 if a, b, c run anticlockwise, -1 clockwise, 0 on a line.
[[nodiscard]] int turn_in_plan(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c);

}  // namespace ray
