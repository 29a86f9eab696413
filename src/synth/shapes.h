#pragma once
/// The shapes that scenes are made of.

#include <raycloud/core/mesh.h>
#include <raycloud/core/pose.h>

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <utility>

namespace ray {

/// Two directions at right angles to `axis` and to each other; axis, first and second are right-handed.
struct AcrossAxes {
  Eigen::Vector3d first;
  Eigen::Vector3d second;
};
/// Precondition: `axis` has unit length.
[[nodiscard]] AcrossAxes across(const Eigen::Vector3d& axis);

/// Rotation about z by `turns` whole turns, then a shift.
[[nodiscard]] Pose placed(const Eigen::Vector3d& position, double turns);

/// Area and, for closed shapes, enclosed volume.
[[nodiscard]] double surface_area(const Mesh& mesh);
[[nodiscard]] double enclosed_volume(const Mesh& mesh);

/// Collects shapes into one mesh. Closed shapes have vertices of their own, every edge in two faces, and
/// fronts outside. Everything that is added goes through the pose that was set last.
class MeshBuilder {
 public:
  void set_pose(const Pose& pose) { pose_ = pose; }

  /// Closed. Precondition: low < high in every coordinate.
  void box(const Eigen::Vector3d& low, const Eigen::Vector3d& high);
  /// Closed: the eight corners of a box that was bent: the lower four anticlockwise as seen from above, then
  /// the upper four above them.
  void hexahedron(const std::array<Eigen::Vector3d, 8>& corners);
  /// Closed frustum of a regular polygon of `sides` sides, with the cross-section area of the round one at
  /// both ends and so its volume. Preconditions: the ends differ, both radii > 0, sides >= 3.
  void tube(const Eigen::Vector3d& from, double from_radius, const Eigen::Vector3d& to, double to_radius,
            std::size_t sides);
  /// Sheet of one triangle, seen from both sides.
  void triangle(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c);
  /// Sheet of two triangles folded along the middle rib from `stem` to `tip`: width² is the area over the
  /// length. `flat` is a unit vector across the rib, `up` the unit normal; the halves rise by `fold` (slope).
  void leaf(const Eigen::Vector3d& stem, const Eigen::Vector3d& tip, const Eigen::Vector3d& flat,
            const Eigen::Vector3d& up, double area, double fold);
  void mesh(const Mesh& other);

  [[nodiscard]] const Mesh& built() const { return mesh_; }
  [[nodiscard]] Mesh take() { return std::exchange(mesh_, {}); }

 private:
  std::uint32_t vertex(const Eigen::Vector3d& position);

  Mesh mesh_;
  Pose pose_;
};

/// A closed sphere of 20 × 4^`splits` faces, radius 1.
[[nodiscard]] Mesh icosphere(int splits);

}  // namespace ray
