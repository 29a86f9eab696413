#pragma once
/// The plan in whole steps, so that triangulating it can be exact.

#include "lower_hull.h"

#include <raycloud/core/bounds.h>

#include <algorithm>
#include <cmath>

namespace ray {

/// A step is a power of two, and about 2^-30 of the longer side of the map: 0.5 µm for 500 m.
class PlanSteps {
 public:
  explicit PlanSteps(const Bounds& bounds) {
    const double side = std::max({bounds.extent().x(), bounds.extent().y(), 1e-300});
    // Far from the origin doubles themselves are no finer than this.
    const double finest = 4e-16 * bounds.min.cwiseAbs().cwiseMax(bounds.max.cwiseAbs()).head<2>().maxCoeff();
    step_ = std::exp2(std::ceil(std::log2(std::max(side / static_cast<double>(kPlanSteps - 2), finest))));
    low_ = (bounds.min.head<2>() / step_).array().floor() * step_;
  }
  [[nodiscard]] std::int64_t x(double coordinate) const { return steps(coordinate - low_.x()); }
  [[nodiscard]] std::int64_t y(double coordinate) const { return steps(coordinate - low_.y()); }
  [[nodiscard]] Eigen::Vector2d place(std::int64_t x, std::int64_t y) const {
    return {low_.x() + static_cast<double>(x) * step_, low_.y() + static_cast<double>(y) * step_};
  }
  [[nodiscard]] double step() const { return step_; }

 private:
  [[nodiscard]] std::int64_t steps(double length) const {
    return std::clamp<std::int64_t>(std::llround(length / step_), 0, kPlanSteps - 1);
  }
  double step_ = 1.0;
  Eigen::Vector2d low_ = Eigen::Vector2d::Zero();
};

}  // namespace ray
