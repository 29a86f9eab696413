#pragma once
/// The nearest point of one cloud to the points of another, exact.

#include <raycloud/spatial/point_tree.h>

namespace ray {

/// Searches in a tree for places that need not be in it; one for each thread. Quick where places come one
/// after the other that are near each other, as in the order of another tree: about 0.3 µs.
class NearestPoint {
 public:
  explicit NearestPoint(const PointTree& tree) : tree_(tree) {}

  /// The squared distance (m²) of the nearest point that is no further than `within2` (m², inclusive), or
  /// infinity. It is the sum of the three squares from x to z as doubles have it, so that it depends on the
  /// two points alone and is the same in both directions.
  [[nodiscard]] double distance2(const Eigen::Vector3d& from, double within2);

 private:
  struct Open {
    std::uint32_t node;
    double distance2;
  };
  void scan(std::uint32_t first, std::uint32_t count, const Eigen::Vector3d& from, double& nearest2);

  const PointTree& tree_;
  std::uint32_t last_ = 0;       ///< place of what was found last
  std::array<Open, 96> open_{};  ///< nodes still to be looked at; a tree has less than 64 levels
};

}  // namespace ray
