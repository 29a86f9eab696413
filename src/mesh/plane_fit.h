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
    const Eigen::Matrix2d plan = spread().topLeftCorner<2, 2>();
    const double extent = plan.trace();
    return plan.determinant() > 0.01 * extent * extent ? plane_of_likely_slope(0.0) : with_slope({0.0, 0.0});
  }

  /// That of the least sum of squares and of `stiffness` (m², above 0) for each unit of the slope's square:
  /// level in all directions in which the points do not extend.
  [[nodiscard]] Plane plane_of_likely_slope(double stiffness) const {
    const Eigen::Matrix3d products_here = spread();
    const Eigen::Matrix2d plan =
        products_here.topLeftCorner<2, 2>() + stiffness * Eigen::Matrix2d::Identity();
    return with_slope(plan.inverse() * products_here.topRightCorner<2, 1>());
  }

 private:
  [[nodiscard]] Eigen::Matrix3d spread() const {
    const Eigen::Vector3d mean = sum / count;
    return products - count * mean * mean.transpose();
  }
  [[nodiscard]] Plane with_slope(const Eigen::Vector2d& slope) const {
    const Eigen::Vector3d mean = sum / count;
    const Eigen::Matrix3d around = spread();
    const double squares = around(2, 2) - 2.0 * slope.dot(around.topRightCorner<2, 1>()) +
                           slope.dot(around.topLeftCorner<2, 2>() * slope);
    return {slope, mean.z() - slope.dot(mean.head<2>()), std::sqrt(std::max(squares, 0.0) / count)};
  }
};

}  // namespace ray
