#pragma once
/// Where it is plain on which side of a mesh a place is, without looking for what is nearest.

#include "edges.h"
#include "plan_heights.h"

#include <raycloud/core/bounds.h>

#include <cmath>
#include <cstdint>
#include <numbers>
#include <optional>
#include <vector>

namespace ray {

/// Over a ground, which covers a convex part of the plan once, a place is above or below it. Outside of the
/// box around one closed surface a place is outside of that, too; in it the faces above it tell.
class KnownSide {
 public:
  /// `mesh` is oriented and stays; `sides` are its own.
  KnownSide(const Mesh& mesh, const std::vector<FaceSide>& sides, const MeshTopology& topology) {
    for (const Mesh::Face& face : mesh.faces)
      for (const std::uint32_t vertex : face)
        box_.add(mesh.vertices[vertex]);
    is_closed_ = topology.is_closed() && topology.components == 1;
    nearly_on_ = 1e-9 * (1.0 + box_.extent().norm() + box_.min.cwiseAbs().maxCoeff());
    if (is_closed_ || (topology.is_disc() && looks_up(mesh) && is_convex(mesh, sides))) faces_.emplace(mesh);
  }

  /// 1 in front of the mesh, -1 behind it; 0 where that has to be looked for.
  [[nodiscard]] int of(const Eigen::Vector3d& place) const {
    if (is_closed_) {
      if ((place.array() < box_.min.array()).any() || (place.array() > box_.max.array()).any()) return 1;
      const auto turns = faces_->turns_above(place, nearly_on_);
      return !turns || *turns < 0 ? 0 : *turns > 0 ? -1 : 1;
    }
    if (!faces_) return 0;
    const auto height = faces_->highest(place.head<2>());
    if (!height || std::abs(place.z() - *height) <= nearly_on_) return 0;
    return place.z() > *height ? 1 : -1;
  }

 private:
  static bool looks_up(const Mesh& mesh) {
    for (const Mesh::Face& face : mesh.faces)
      if (!(plan_area(mesh, face) > 0.0)) return false;
    return true;
  }

  /// Whether the border, seen from above, turns to the left all the way, and once around; but for the dents
  /// that rounding leaves.
  static bool is_convex(const Mesh& mesh, const std::vector<FaceSide>& sides) {
    constexpr double kDents = 1e-3;  // rad, all together
    std::vector<std::uint32_t> next(mesh.vertices.size(), 0);
    std::vector<std::uint32_t> border;
    for_each_edge(sides, [&](const FaceSide* first, const FaceSide* last) {
      if (last - first != 1) return;
      const std::uint32_t from = first->forwards ? first->low : first->high;
      next[from] = first->forwards ? first->high : first->low;
      border.push_back(from);
    });
    double left = 0.0;
    double right = 0.0;
    for (const std::uint32_t from : border) {
      const std::uint32_t corner = next[from];
      const Eigen::Vector2d before = (mesh.vertices[corner] - mesh.vertices[from]).head<2>();
      const Eigen::Vector2d after = (mesh.vertices[next[corner]] - mesh.vertices[corner]).head<2>();
      const double turn = std::atan2(before.x() * after.y() - before.y() * after.x(), before.dot(after));
      (turn > 0.0 ? left : right) += std::abs(turn);
    }
    return right <= kDents && left <= 2.0 * std::numbers::pi + 2.0 * kDents;
  }

  Bounds box_;
  bool is_closed_ = false;
  double nearly_on_ = 0.0;
  std::optional<PlanHeights> faces_;
};

}  // namespace ray
