#pragma once
/// Planes z = a x + b y + c through points by least squares.

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace ray {

/// Of points given from a place nearby, so that sums lose nothing.
struct PlaneFit {
  int count = 0;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  Eigen::Matrix3d products = Eigen::Matrix3d::Zero();

  void add(const Eigen::Vector3d& point) {
    ++count;
    sum += point;
    products += point * point.transpose();
  }
  struct Plane {
    Eigen::Vector2d slope = Eigen::Vector2d::Zero();
    double height = 0.0;  ///< at the origin
    double error = 0.0;   ///< of the points, root mean square
  };
  /// Level if all are on a line of the plan.
  [[nodiscard]] Plane plane() const {
    const Eigen::Vector3d mean = sum / count;
    const Eigen::Matrix3d spread = products - count * mean * mean.transpose();
    const Eigen::Matrix2d plan = spread.topLeftCorner<2, 2>();
    const Eigen::Vector2d rise = spread.topRightCorner<2, 1>();
    const double extent = plan.trace();
    Eigen::Vector2d slope = Eigen::Vector2d::Zero();
    if (plan.determinant() > 0.01 * extent * extent) slope = plan.inverse() * rise;
    const double squares = spread(2, 2) - slope.dot(rise);
    return {slope, mean.z() - slope.dot(mean.head<2>()), std::sqrt(std::max(squares, 0.0) / count)};
  }
};

}  // namespace ray
