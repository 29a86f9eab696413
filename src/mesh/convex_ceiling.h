#pragma once
/// A function of a square that is nowhere below a convex one: bilinear between samples of it, as a convex
/// function is at most linear between any two of them.

#include <algorithm>
#include <cstddef>
#include <limits>
#include <vector>

namespace ray {

class ConvexCeiling {
 public:
  /// `sides` cells a side; sample (column, row) is at (column, row) / sides.
  explicit ConvexCeiling(std::size_t sides)
      : sides_(sides), samples_((sides + 1) * (sides + 1), std::numeric_limits<double>::infinity()) {}

  [[nodiscard]] std::size_t sides() const { return sides_; }
  [[nodiscard]] double& sample(std::size_t column, std::size_t row) {
    return samples_[row * (sides_ + 1) + column];
  }

  /// Infinite where a sample of the cell is. Precondition: u and v in [0, 1].
  [[nodiscard]] double at(double u, double v) const {
    const double x = u * static_cast<double>(sides_);
    const double y = v * static_cast<double>(sides_);
    const std::size_t column = std::min(static_cast<std::size_t>(x), sides_ - 1);
    const std::size_t row = std::min(static_cast<std::size_t>(y), sides_ - 1);
    const double s = x - static_cast<double>(column);
    const double t = y - static_cast<double>(row);
    const double* const corner = samples_.data() + row * (sides_ + 1) + column;
    const double low = mix(corner[0], corner[1], s);
    const double high = mix(corner[sides_ + 1], corner[sides_ + 2], s);
    return mix(low, high, t);
  }

 private:
  static double mix(double a, double b, double t) {
    if (!(a < std::numeric_limits<double>::infinity() && b < std::numeric_limits<double>::infinity()))
      return std::numeric_limits<double>::infinity();
    return a + t * (b - a);
  }
  std::size_t sides_;
  std::vector<double> samples_;
};

}  // namespace ray
