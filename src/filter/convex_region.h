#pragma once
/// Convex regions of space and where a ray enters and leaves them. kConvexOutside: what is outside is convex
/// too.

#include <raycloud/core/cloud_info.h>

#include <Eigen/Core>
#include <vector>

namespace ray {

struct Stretch;

/// Where the line start + t (end - start) is inside: nowhere if !(enter < leave). A face whose axis is known
/// has its exact coordinate there.
struct Crossing {
  double enter = 0.0;
  double leave = 0.0;
  int enter_axis = -1;
  int leave_axis = -1;
  double enter_at = 0.0;  ///< m, the coordinate of the axis
  double leave_at = 0.0;
};

/// {x : x . p <= p . p}.
struct HalfSpace {
  static constexpr bool kConvexOutside = true;
  Eigen::Vector3d p;
  [[nodiscard]] bool contains(const Eigen::Vector3d& x) const { return x.dot(p) <= p.squaredNorm(); }
  [[nodiscard]] Crossing cross(const Eigen::Vector3d& start, const Eigen::Vector3d& end) const;
};

/// Closed.
struct Box {
  static constexpr bool kConvexOutside = false;
  Eigen::Vector3d low;
  Eigen::Vector3d high;
  [[nodiscard]] bool contains(const Eigen::Vector3d& x) const {
    return (x.array() >= low.array()).all() && (x.array() <= high.array()).all();
  }
  [[nodiscard]] Crossing cross(const Eigen::Vector3d& start, const Eigen::Vector3d& end) const;
};

/// All that is at most `radius` from the line between `a` and `b`.
struct Capsule {
  static constexpr bool kConvexOutside = false;
  Eigen::Vector3d a;
  Eigen::Vector3d b;
  double radius = 0.0;
  [[nodiscard]] bool contains(const Eigen::Vector3d& x) const;
  [[nodiscard]] Crossing cross(const Eigen::Vector3d& start, const Eigen::Vector3d& end) const;
};

/// A ray's way through inside (part 0) and outside (part 1). Start and end are judged by `contains`, so that
/// a whole ray and a bounded end never depend on the rounding of a cut. Empty for a ray that is not cut,
/// which is inside if its end is.
template <class Region>
std::uint32_t way_through(const Region& region, const Eigen::Vector3d& start, const Eigen::Vector3d& end,
                          Precision stored, std::vector<Stretch>& way);

}  // namespace ray
