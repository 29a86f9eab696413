#pragma once
/// A ray against a triangle in double precision.

#include <raycloud/core/mesh.h>

#include <Eigen/Geometry>
#include <limits>
#include <optional>

namespace ray {

/// The range at which origin + range · direction lies on the triangle, if it is above 0; either side counts.
/// Edges belong to the triangle, and two triangles that share one decide by the same number, so no ray slips
/// between them (the edge test of Woop, Benthin and Wald, "Watertight Ray/Triangle Intersection", 2013,
/// without their shear; it needs that products are not fused into sums). A ray within the plane misses.
[[nodiscard]] inline std::optional<double> range_to_triangle(const Eigen::Vector3d& origin,
                                                             const Eigen::Vector3d& direction,
                                                             const Mesh& mesh, const Mesh::Face& face) {
  const Eigen::Vector3d a = mesh.vertices[face[0]] - origin;
  const Eigen::Vector3d b = mesh.vertices[face[1]] - origin;
  const Eigen::Vector3d c = mesh.vertices[face[2]] - origin;
  // The sign says on which side of the edge the ray passes; swapping the ends changes it and nothing else.
  const double ab = direction.dot(a.cross(b));
  const double bc = direction.dot(b.cross(c));
  const double ca = direction.dot(c.cross(a));
  const bool anticlockwise = ab >= 0.0 && bc >= 0.0 && ca >= 0.0;
  const bool clockwise = ab <= 0.0 && bc <= 0.0 && ca <= 0.0;
  if (!anticlockwise && !clockwise) return std::nullopt;
  const Eigen::Vector3d normal = (b - a).cross(c - a);
  const double along = normal.dot(direction);
  if (along == 0.0) return std::nullopt;
  const double range = normal.dot(a) / along;
  if (!(range > 0.0 && range < std::numeric_limits<double>::infinity())) return std::nullopt;
  return range;
}

}  // namespace ray
