#pragma once
/// A small quadratic bend of a whole map, as long ones have along their length (paper, section VIII-E).

#include <raycloud/core/ray_cloud.h>

#include <Eigen/Core>

namespace ray {

/// `p ↦ p + shifts · (x², y², x y)`, where x and y are the horizontal place of p from the centre. At the
/// centre nothing moves and nothing turns.
struct Bend {
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();  ///< m
  Eigen::Matrix3d shifts = Eigen::Matrix3d::Zero();  ///< 1/m; a column each for x², y² and x y

  [[nodiscard]] Eigen::Vector3d shift_at(const Eigen::Vector3d& point) const {
    const Eigen::Vector2d from = point.head<2>() - centre;
    return shifts * Eigen::Vector3d(from.x() * from.x(), from.y() * from.y(), from.x() * from.y());
  }
  [[nodiscard]] Eigen::Vector3d operator*(const Eigen::Vector3d& point) const {
    return point + shift_at(point);
  }
  [[nodiscard]] bool is_none() const { return shifts.isZero(0.0); }
};

/// Moves each ray as a whole, by the shift at its end, or at its start where it is unbounded: starts go with
/// their ends, and lengths and directions stay.
void bend_rays(const Bend& bend, RayCloud& rays);

}  // namespace ray
