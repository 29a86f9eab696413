#pragma once
/// A pose error that grows and wanders smoothly, as that of a map without loop closure.

#include <raycloud/core/pose.h>

#include <cstdint>
#include <utility>
#include <vector>

namespace ray {

/// What a scanner believes its pose to be, less what it is. Linear between the nodes. Empty: no error.
struct Drift {
  std::vector<double> times;             ///< s, strictly increasing
  std::vector<Eigen::Vector3d> offsets;  ///< m
  std::vector<double> yaws;              ///< rad, about z

  [[nodiscard]] bool empty() const { return times.empty(); }
};

/// Begins with no error at `times.first`; its largest offset is `largest` m, its largest yaw 0.05 rad for
/// each m of that. Nodes every 0.25 s. Preconditions: first < second, largest > 0.
[[nodiscard]] Drift make_drift(std::pair<double, double> times, double largest, std::uint64_t seed);

/// Takes true points to where the scanner puts them: turned about the true position of the sensor, then
/// shifted.
[[nodiscard]] Pose pose_error(const Drift& drift, double time, const Eigen::Vector3d& sensor);

}  // namespace ray
