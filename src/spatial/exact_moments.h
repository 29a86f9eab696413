#pragma once
/// How some points lie around another, to the last bit whatever their order.

#include <raycloud/spatial/neighbour_search.h>

#include <Eigen/Core>
#include <span>

namespace ray {

/// The moments of offsets from the point in the middle, as whole numbers of a 2^-22th of the furthest: sums
/// of their products are exact, and so do not depend on the order of the neighbours.
class ExactMoments {
 public:
  ExactMoments(const PointTree& tree, const Eigen::Vector3d& middle, std::span<const Neighbour> neighbours,
               double furthest2);

  /// Of `count` points, those that were not added being at the middle.
  [[nodiscard]] Eigen::Vector3d mean(double count) const { return sum_ / (count * scale_); }
  [[nodiscard]] Eigen::Matrix3d covariance(double count) const {
    Eigen::Matrix3d products;
    products << squares_.x(), products_.x(), products_.y(), products_.x(), squares_.y(), products_.z(),
        products_.y(), products_.z(), squares_.z();
    return (products - sum_ * sum_.transpose() / count) / (count * scale_ * scale_);
  }

 private:
  double scale_;
  Eigen::Vector3d sum_, squares_;
  Eigen::Vector3d products_;  // xy, xz, yz
};

}  // namespace ray
