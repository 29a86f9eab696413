#pragma once
/// Where the sensor was, and when.

#include <Eigen/Geometry>
#include <cstddef>
#include <vector>

namespace ray {

/// Nodes in strictly increasing time, linear in between. `orientations` (sensor to world, unit length) is
/// empty or has one per node.
struct Trajectory {
  std::vector<double> times;               ///< s
  std::vector<Eigen::Vector3d> positions;  ///< m
  std::vector<Eigen::Quaterniond> orientations;

  [[nodiscard]] std::size_t size() const { return times.size(); }
  [[nodiscard]] bool empty() const { return times.empty(); }
};

/// A place on a trajectory: `fraction` (0 to 1) of the way from node `node` to the next one.
struct TrajectorySpot {
  std::size_t node = 0;
  double fraction = 0.0;
};

/// Where the trajectory is at `time`; the first or last node for a time before or after all of them, never
/// beyond. `hint` is the node of an earlier answer: a time near it is found in O(1), one d nodes away in
/// O(log d). Precondition: not empty, `time` is not NaN.
[[nodiscard]] TrajectorySpot spot_at(const Trajectory& trajectory, double time, std::size_t hint = 0);

/// Linear interpolation, exact at the nodes.
[[nodiscard]] Eigen::Vector3d position_at(const Trajectory& trajectory, TrajectorySpot spot);

/// Spherical linear interpolation along the shorter arc. Precondition: the trajectory has orientations.
[[nodiscard]] Eigen::Quaterniond orientation_at(const Trajectory& trajectory, TrajectorySpot spot);

/// The median time from a node to the next, in s; 0 with fewer than two nodes. O(n) time and memory.
[[nodiscard]] double node_spacing(const Trajectory& trajectory);

}  // namespace ray
