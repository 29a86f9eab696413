#pragma once
/// Where each ray starts: the step of importing that turns points into rays.

#include <raycloud/core/ray_cloud.h>
#include <raycloud/core/trajectory.h>

#include <cstdint>
#include <optional>
#include <variant>

namespace ray {

/// The source says itself where its rays start; it is believed.
struct OwnOrigins {};

/// A scanner that stood still.
struct FixedSensor {
  Eigen::Vector3d position;  ///< m
};

/// The same vector from start to end for every ray, as for aerial clouds of which nothing better is known.
struct ConstantRay {
  Eigen::Vector3d start_to_end;  ///< m
};

/// A sensor that moved along a trajectory; positions between nodes are interpolated linearly at the ray's
/// time.
struct MovingSensor {
  Trajectory trajectory;
  /// The sensor in the frame of the trajectory's orientations, m, which are interpolated spherically.
  std::optional<Eigen::Vector3d> lever_arm;
  /// Keep rays whose time is further outside the trajectory than one (median) node spacing, starting them at
  /// its first or last node, instead of leaving them out.
  bool clamp = false;
};

using SensorOrigin = std::variant<OwnOrigins, FixedSensor, ConstantRay, MovingSensor>;

/// What happened to the rays of a chunk or cloud.
struct OriginCounts {
  std::uint64_t before = 0;   ///< rays earlier than the trajectory by more than one node spacing
  std::uint64_t after = 0;    ///< likewise later
  std::uint64_t in_gaps = 0;  ///< rays between nodes more than 10 median spacings apart
  double longest_gap = 0.0;   ///< s; of those that hold rays
  void add(const OriginCounts& other);
};

/// A streaming map: give it to exec/stream.h. Thread-safe. A trajectory is never extrapolated: within one
/// node spacing outside its span a ray starts at the end node. O(1) a ray where times are nearly sorted.
class OriginStep {
 public:
  /// Throws Error(no_data) for an empty trajectory and Error(wrong_content) for a lever arm without
  /// orientations.
  explicit OriginStep(SensorOrigin origin);
  /// Sets the starts; drops the rays outside a trajectory unless it clamps.
  OriginCounts operator()(RayCloud& rays) const;

 private:
  OriginCounts follow(const MovingSensor& sensor, RayCloud& rays) const;

  SensorOrigin origin_;
  double spacing_ = 0.0;
};

}  // namespace ray
