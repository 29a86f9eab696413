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

/// Four points at a time.
using Lanes = Eigen::Array4f;

struct LanesOfVectors {
  Lanes x, y, z;
  [[nodiscard]] Lanes dot(const Eigen::Vector3f& other) const {
    return x * other.x() + y * other.y() + z * other.z();
  }
};

/// The surface through the planes around a point, which are a sample of its heights and slopes. Their mean
/// height is that of the surface but for its curvature, which pulls it towards the hollow side twice: the
/// points of each plane lie on a curved surface, and so do the planes. The curvature, in both directions, is
/// how much their slopes change from place to place; it is trusted as far as it is more than its error. The
/// unit of length is about the reach of the point's plane.
class SurfaceFit {
 public:
  /// As many neighbours, at most.
  static constexpr std::size_t kMost = 63;

  SurfaceFit(const PointTree& tree, std::span<const LocalPlane> planes);

  /// Of the surface from the point, along the normal of its plane, m. Depends on the neighbours, not on their
  /// order. Precondition: the point has a plane.
  [[nodiscard]] double height(std::size_t place, std::span<const Neighbour> neighbours);

 private:
  static constexpr std::size_t kGroups = (kMost + 1) / 4;

  void take(std::size_t place, const LocalPlane& own, std::span<const Neighbour> neighbours);

  const PointTree& tree_;
  std::span<const LocalPlane> planes_;
  float unit_ = 1.0F;  // m, a power of two, at most the reach
  std::array<LanesOfVectors, kGroups> normals_, offsets_;
  std::array<Lanes, kGroups> heights_, spreads2_;
};

}  // namespace ray
