#pragma once
/// Whether two triangles meet elsewhere than where neighbours of a surface may.

#include <Eigen/Core>
#include <array>

namespace ray {

using TriangleCorners = std::array<Eigen::Vector3d, 3>;

/// Beyond the corners that they share (the same coordinates), and the edge between two of those. Exact.
/// Precondition: both have an area.
[[nodiscard]] bool meet_beyond_shared(const TriangleCorners& a, const TriangleCorners& b);

/// Not 0, exactly.
[[nodiscard]] bool has_exact_area(const TriangleCorners& corners);

}  // namespace ray
