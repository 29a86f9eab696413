#pragma once
/// Axis-aligned boxes.

#include <Eigen/Core>
#include <limits>

namespace ray {

/// The closed box from `min` to `max`, in metres; empty until something is added.
struct Bounds {
  Eigen::Vector3d min = Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity());
  Eigen::Vector3d max = Eigen::Vector3d::Constant(-std::numeric_limits<double>::infinity());

  [[nodiscard]] bool empty() const { return !(min.array() <= max.array()).all(); }
  void add(const Eigen::Vector3d& point) {
    min = min.cwiseMin(point);
    max = max.cwiseMax(point);
  }
  void add(const Bounds& other) {
    min = min.cwiseMin(other.min);
    max = max.cwiseMax(other.max);
  }
  /// Zero for an empty box.
  [[nodiscard]] Eigen::Vector3d extent() const {
    return empty() ? Eigen::Vector3d::Zero() : Eigen::Vector3d(max - min);
  }
};

}  // namespace ray
