#pragma once
/// The signed distance from a mesh, of any triangles: a ground, a building from a modelling program, the
/// result of `raywrap`.

#include <raycloud/core/mesh.h>
#include <raycloud/mesh/topology.h>

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace ray {

/// Which side is which: the sign is that of the pseudo-normal at the nearest place, the mean of the normals
/// around it weighted by their angles, which is right on edges and at corners too (Bærentzen and Aanæs,
/// 2005). Beyond the border of an open mesh the plane of the border's face goes on.
class MeshDistance {
 public:
  /// Welds the mesh (`mesh/weld.h`), turns neighbouring faces so that they agree on their front, and then
  /// all of them where a closed mesh shows its front to the inside, or every face of an open one looks
  /// down. Throws Error(no_data) if no face has an area; O(n log n); some 400 bytes a face, at most 2^31 of
  /// them.
  explicit MeshDistance(const Mesh& mesh);
  ~MeshDistance();
  MeshDistance(MeshDistance&&) noexcept;
  MeshDistance& operator=(MeshDistance&&) noexcept;

  /// In m, above an open mesh and outside a closed one positive, 0 on it. Thread-safe.
  [[nodiscard]] std::vector<double> at(std::span<const Eigen::Vector3d> points) const;
  [[nodiscard]] double at(const Eigen::Vector3d& point) const { return at(std::span(&point, 1)).front(); }

  /// Whether at(point) > distance, 1 or 0 for each of the points; quicker, most of all for points that are
  /// not. Precondition: as many of both.
  void are_beyond(std::span<const Eigen::Vector3d> points, double distance,
                  std::span<std::uint8_t> beyond) const;

  /// The welded mesh as turned, which has what users should hear of.
  [[nodiscard]] const Mesh& mesh() const;
  [[nodiscard]] const MeshTopology& topology() const;
  [[nodiscard]] std::size_t faces_without_area() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace ray
