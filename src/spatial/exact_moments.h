#pragma once
/// How some points lie around another, to the last bit whatever their order.

#include <raycloud/spatial/neighbour_search.h>

#include <Eigen/Core>
#include <cmath>
#include <cstddef>
#include <span>

namespace ray {

/// The moments of offsets from the point in the middle, as whole numbers of a 2^-22th of the furthest: sums
/// of their products are exact, and so do not depend on the order of the neighbours. Two go at once.
class ExactMoments {
 public:
  ExactMoments(const PointTree& tree, const Eigen::Vector3d& middle, std::span<const Neighbour> neighbours,
               double furthest2) {
    int exponent = 0;
    static_cast<void>(std::frexp(std::sqrt(furthest2), &exponent));
    scale_ = std::ldexp(1.0, 22 - exponent);
    Sums sum = Sums::Zero(), squares = Sums::Zero(), products = Sums::Zero();
    for (std::size_t i = 0; i < neighbours.size(); i += 2) {
      const bool has_two = i + 1 < neighbours.size();  // else what is in the middle does not change the sums
      const Eigen::Vector3d first = tree.point(neighbours[i].place);
      const Eigen::Vector3d second = has_two ? tree.point(neighbours[i + 1].place) : middle;
      Sums whole;
      whole << whole_numbers(first.x() - middle.x(), second.x() - middle.x()),
          whole_numbers(first.y() - middle.y(), second.y() - middle.y()),
          whole_numbers(first.z() - middle.z(), second.z() - middle.z());
      sum += whole;
      squares += whole * whole;
      products.col(0) += whole.col(0) * whole.col(1);
      products.col(1) += whole.col(0) * whole.col(2);
      products.col(2) += whole.col(1) * whole.col(2);
    }
    sum_ = sum.colwise().sum();
    squares_ = squares.colwise().sum();
    products_ = products.colwise().sum();
  }

  /// Of `count` points, those that were not added being at the middle.
  [[nodiscard]] Eigen::Vector3d mean(double count) const { return sum_ / (count * scale_); }
  [[nodiscard]] Eigen::Matrix3d covariance(double count) const {
    Eigen::Matrix3d products;
    products << squares_.x(), products_.x(), products_.y(), products_.x(), squares_.y(), products_.z(),
        products_.y(), products_.z(), squares_.z();
    return (products - sum_ * sum_.transpose() / count) / (count * scale_ * scale_);
  }

 private:
  using Sums = Eigen::Array<double, 2, 3>;  // of every other neighbour, along the axes

  [[nodiscard]] Eigen::Array2d whole_numbers(double first, double second) const {
    constexpr double kRounds = 0x1.8p52;
    return Eigen::Array2d(first, second) * scale_ + kRounds - kRounds;
  }

  double scale_;
  Eigen::Vector3d sum_, squares_;
  Eigen::Vector3d products_;  // xy, xz, yz
};

}  // namespace ray
