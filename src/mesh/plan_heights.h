#pragma once
/// Heights of a mesh over places of the plan.

#include "plan_grid.h"

#include <raycloud/core/mesh.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace ray {

/// Twice the signed area of a, b and p; exactly opposite when a and b change places, so that two faces which
/// share a side agree on which of them has the point.
[[nodiscard]] inline double plan_side(const Eigen::Vector2d& a, const Eigen::Vector2d& b,
                                      const Eigen::Vector2d& p) {
  return (a.x() - p.x()) * (b.y() - p.y()) - (b.x() - p.x()) * (a.y() - p.y());
}

/// Twice the area of a face seen from above, below 0 if its back is seen.
[[nodiscard]] inline double plan_area(const Mesh& mesh, const Mesh::Face& face) {
  return plan_side(mesh.vertices[face[0]].head<2>(), mesh.vertices[face[1]].head<2>(),
                   mesh.vertices[face[2]].head<2>());
}

/// Above or below the place, if the face is seen from there; exact at vertices and without steps at sides.
[[nodiscard]] inline std::optional<double> height_of_face(const Mesh& mesh, const Mesh::Face& face,
                                                          const Eigen::Vector2d& p) {
  const Eigen::Vector3d& a = mesh.vertices[face[0]];
  const Eigen::Vector3d& b = mesh.vertices[face[1]];
  const Eigen::Vector3d& c = mesh.vertices[face[2]];
  const double of_a = plan_side(b.head<2>(), c.head<2>(), p);
  const double of_b = plan_side(c.head<2>(), a.head<2>(), p);
  const double of_c = plan_side(a.head<2>(), b.head<2>(), p);
  const bool anticlockwise = of_a >= 0.0 && of_b >= 0.0 && of_c >= 0.0;
  const bool clockwise = of_a <= 0.0 && of_b <= 0.0 && of_c <= 0.0;
  const double sum = of_a + of_b + of_c;
  if ((!anticlockwise && !clockwise) || sum == 0.0) return std::nullopt;
  return (of_a * a.z() + of_b * b.z() + of_c * c.z()) / sum;
}

class PlanHeights {
 public:
  /// Precondition: at least one face, and the mesh stays. 20 bytes a face.
  explicit PlanHeights(const Mesh& mesh) : mesh_(mesh), grid_(shapes_of(mesh)) {}

  /// Of the faces above and below the place, the highest there; nothing where there is none. O(1) for faces
  /// of like size.
  [[nodiscard]] std::optional<double> highest(const Eigen::Vector2d& place) const {
    std::optional<double> highest;
    for (const std::uint32_t item : grid_.at(place)) {
      const auto height = height_of_face(mesh_, mesh_.faces[item], place);
      if (height && (!highest || *height > *highest)) highest = height;
    }
    return highest;
  }

  /// Of the faces above the place, those that show it their backs, less those that show it their fronts: 0
  /// outside of a closed surface, 1 inside. Nothing where the place is as near as `nearly` (m) to one, or to
  /// the plan of a side.
  [[nodiscard]] std::optional<int> turns_above(const Eigen::Vector3d& place, double nearly) const {
    int turns = 0;
    for (const std::uint32_t item : grid_.at(place.head<2>())) {
      const Mesh::Face& face = mesh_.faces[item];
      const Eigen::Vector3d& a = mesh_.vertices[face[0]];
      const Eigen::Vector3d& b = mesh_.vertices[face[1]];
      const Eigen::Vector3d& c = mesh_.vertices[face[2]];
      const double of_a = plan_side(b.head<2>(), c.head<2>(), place.head<2>());
      const double of_b = plan_side(c.head<2>(), a.head<2>(), place.head<2>());
      const double of_c = plan_side(a.head<2>(), b.head<2>(), place.head<2>());
      const auto [least, most] = std::minmax({of_a, of_b, of_c});
      const double rim = nearly * ((b - a).head<2>().lpNorm<1>() + (c - a).head<2>().lpNorm<1>());
      if (least < -rim && most > rim) continue;
      if (least <= rim && most >= -rim) return std::nullopt;
      const double height = (of_a * a.z() + of_b * b.z() + of_c * c.z()) / (of_a + of_b + of_c);
      if (std::abs(height - place.z()) <= nearly) return std::nullopt;
      if (height > place.z()) turns += least > 0.0 ? 1 : -1;
    }
    return turns;
  }

 private:
  static std::vector<PlanShape> shapes_of(const Mesh& mesh) {
    std::vector<PlanShape> shapes;
    shapes.reserve(mesh.faces.size());
    for (const auto& [a, b, c] : mesh.faces)
      shapes.push_back({mesh.vertices[a].head<2>(), mesh.vertices[b].head<2>(), mesh.vertices[c].head<2>()});
    return shapes;
  }

  const Mesh& mesh_;
  PlanGrid grid_;
};

}  // namespace ray
