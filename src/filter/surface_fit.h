#pragma once
/// The surface that the planes around a point are samples of.

#include <raycloud/spatial/neighbour_search.h>

#include <Eigen/Core>
#include <array>
#include <span>

namespace ray {

/// The plane around a point: through point + height · normal.
struct LocalPlane {
  Eigen::Vector3f normal = Eigen::Vector3f::Zero();  // zero: there is none
  float height = 0.0F;                               // m
  float spread2 = 0.0F;  // m², variance of its points along it, both ways together
  float reach = 0.0F;    // m, of its neighbours
};

/// Planes in columns, a whole number of lanes of them, seen from a point, in units of length.
struct SeenPlanes {
  static constexpr std::size_t kLanes = 8, kMost = 64;
  using Column = std::array<float, kMost>;
  std::size_t size = 0;
  alignas(32) Column normal_x{}, normal_y{}, normal_z{};
  alignas(32) Column offset_x{}, offset_y{}, offset_z{};
  alignas(32) Column height{}, spread2{};
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

  /// Of the surface from the point, along the normal of its plane, m. Depends on the neighbours, not on their
  /// order. Precondition: the point has a plane.
  [[nodiscard]] double height(std::size_t place, std::span<const std::uint32_t> neighbours);

 private:
  void take(std::size_t place, const LocalPlane& own, std::span<const std::uint32_t> neighbours);

  const PointTree& tree_;
  std::span<const LocalPlane> planes_;
  float unit_ = 1.0F;  // m, a power of two, at most the reach
  SeenPlanes seen_;
};

}  // namespace ray
