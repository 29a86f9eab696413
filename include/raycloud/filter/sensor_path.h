#pragma once
/// The trajectory back out of a ray cloud: the origins of its rays, thinned in time.

#include <raycloud/core/ray_stream.h>
#include <raycloud/core/trajectory.h>
#include <raycloud/core/units.h>
#include <raycloud/exec/context.h>

#include <unordered_map>

namespace ray {

/// Goes over a cloud once, in any order of time, and keeps the earliest ray of every `spacing` seconds and
/// the last one of all. Every node is the exact time and origin of a ray, and every ray lies within the span,
/// so importing with the result gives each ray an origin that is off by no more than the sensor's deviation
/// from a straight line within two spacings. Memory: 40 bytes a node; a nanosecond a ray where times are
/// sorted.
class SensorPath {
 public:
  /// Throws Error(usage) unless `spacing` (s) is positive and finite.
  explicit SensorPath(double spacing);
  void add(const RayCloud& rays);
  /// Nodes in strictly increasing time; empty if there was no ray.
  [[nodiscard]] Trajectory trajectory() const;

 private:
  struct Node {
    double time;
    Eigen::Vector3d position;
  };

  double spacing_;
  std::unordered_map<double, Node> earliest_;  ///< by floor(time / spacing)
  // The times that would change nothing: from that of the slot's earliest ray to the slot's end.
  double known_begin_ = 0.0;
  double known_end_ = 0.0;
  Node last_{};
};

/// The sampling error of a trajectory for a cloud: how far, at most, the start of a ray is from where the
/// trajectory says that the sensor was at its time. Importing the cloud's points with it moves no start
/// further. 0 without rays. Streaming; reads `source` from where it stands to its end. Precondition: the
/// trajectory is not empty.
[[nodiscard]] Metres sampling_error(const Context& context, RaySource& source, const Trajectory& trajectory);

}  // namespace ray
