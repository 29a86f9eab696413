#pragma once
/// Space in whole steps, so that triangulating it can be exact.

#include "lattice_tests.h"

#include <raycloud/core/bounds.h>

#include <algorithm>
#include <cmath>

namespace ray {

/// A step is a power of two, and about 2^-30 of the longest side of the bounds: 0.5 µm for 500 m.
class Lattice {
 public:
  explicit Lattice(const Bounds& bounds) {
    const double side = std::max(bounds.extent().maxCoeff(), 1e-300);
    // Far from the origin doubles themselves are no finer than this.
    const double finest = 4e-16 * bounds.min.cwiseAbs().cwiseMax(bounds.max.cwiseAbs()).maxCoeff();
    step_ = std::exp2(std::ceil(std::log2(std::max(side / (kLatticeSteps - 2.0), finest))));
    low_ = (bounds.min / step_).array().floor() * step_;
  }
  /// The nearest; of a place outside of the bounds, the nearest within.
  [[nodiscard]] LatticePoint point(const Eigen::Vector3d& place) const {
    LatticePoint point{};
    for (int axis = 0; axis < 3; ++axis) {
      const double steps = std::round((place[axis] - low_[axis]) / step_);
      point[static_cast<std::size_t>(axis)] =
          static_cast<std::int32_t>(std::clamp(steps, 0.0, kLatticeSteps - 1.0));
    }
    return point;
  }
  /// Without rounding.
  [[nodiscard]] Eigen::Vector3d place(const LatticePoint& point) const {
    return low_ + step_ * Eigen::Vector3d(point[0], point[1], point[2]);
  }
  [[nodiscard]] double step() const { return step_; }

 private:
  double step_ = 1.0;
  Eigen::Vector3d low_ = Eigen::Vector3d::Zero();
};

}  // namespace ray
