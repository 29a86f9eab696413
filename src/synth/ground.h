#pragma once
/// Heights of a ground that is a mesh.

#include "shapes.h"

#include <functional>
#include <optional>
#include <vector>

namespace ray {

/// A rectangle of the plane, in m.
struct Area {
  Eigen::Vector2d low = Eigen::Vector2d::Zero();
  Eigen::Vector2d high = Eigen::Vector2d::Zero();
  [[nodiscard]] Eigen::Vector2d size() const { return high - low; }
};
/// The smallest that holds all vertices.
[[nodiscard]] Area area_of(const Mesh& mesh);

/// `height` sampled on a grid: cells of at most `cell` m, two triangles each, fronts upwards.
[[nodiscard]] Mesh height_field(const Area& area, double cell,
                                const std::function<double(double x, double y)>& height);

/// Finds the surface of a mesh above a place. O(1) for a mesh of even triangles, memory O(faces).
class Ground {
 public:
  /// Keeps its own copy of the triangles' numbers only: `mesh` must outlive it.
  explicit Ground(const Mesh& mesh);

  /// The highest surface at (x, y); nothing beside the mesh.
  [[nodiscard]] std::optional<double> find(double x, double y) const;
  /// Precondition: (x, y) is on the mesh.
  [[nodiscard]] double at(double x, double y) const { return find(x, y).value(); }
  /// The lowest of eight places on a circle around (x, y), where they are on the mesh.
  [[nodiscard]] double lowest_around(double x, double y, double radius) const;
  [[nodiscard]] const Area& area() const { return area_; }

 private:
  [[nodiscard]] std::size_t column_of(double x) const;
  [[nodiscard]] std::size_t row_of(double y) const;

  const Mesh* mesh_;
  Area area_;
  double cell_ = 1.0;
  std::size_t columns_ = 1;
  std::size_t rows_ = 1;
  std::vector<std::size_t> begins_;  ///< of each cell's faces
  std::vector<std::uint32_t> faces_;
};

}  // namespace ray
