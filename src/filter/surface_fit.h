#pragma once
/// The surface that the planes around a point are samples of.

#include "plane_sums.h"

#include <raycloud/spatial/neighbour_search.h>

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace ray {

/// The plane around a point: through point + height · normal.
struct LocalPlane {
  Eigen::Vector3f normal = Eigen::Vector3f::Zero();  // zero: there is none
  float height = 0.0F;                               // m
  float spread2 = 0.0F;  // m², variance of its points along it, both ways together
  float reach = 0.0F;    // m, of its neighbours
};

/// The surface through the planes around a point, which are a sample of its heights and slopes. Their mean
/// height is that of the surface but for its curvature, which pulls it towards the hollow side twice: the
/// points of each plane lie on a curved surface, and so do the planes. The curvature, in both directions, is
/// how much their slopes change from place to place; it is trusted as far as it is more than its error. The
/// unit of length is about the reach of the point's plane.
class SurfaceFit {
 public:
  /// As many neighbours, at most.
  static constexpr std::size_t kMost = SeenPlanes::kMost - 1;

  SurfaceFit(const PointTree& tree, std::span<const LocalPlane> planes) : tree_(tree), planes_(planes) {}

  struct Height {
    std::size_t place = 0;
    double height = 0.0;
  };

  /// Depends on the neighbours, not on their order. Precondition: the point has a plane; not is_full().
  void add(std::size_t place, std::span<const std::uint32_t> neighbours);
  [[nodiscard]] bool is_full() const { return count_ == kHeights; }
  /// Of the surface from each point that was added since the last call, along the normal of its plane, m.
  [[nodiscard]] std::span<const Height> heights();

 private:
  static constexpr std::size_t kAtOnce = 4;

  void take(std::size_t place, std::span<const std::uint32_t> neighbours);
  void take_some(std::span<const std::uint32_t, kAtOnce> places, const Eigen::Vector3d& point,
                 std::size_t at);

  const PointTree& tree_;
  std::span<const LocalPlane> planes_;
  SeenPlanes seen_;
  std::size_t count_ = 0;  // of points that wait for their height
  std::array<PlaneSums, kHeights> sums_{};
  std::array<Height, kHeights> heights_{};  // before they are known, the units of length, m
};

}  // namespace ray
