#pragma once
/// Triangle meshes.

#include <raycloud/core/column.h>

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

namespace ray {

/// Triangles over shared vertices, in m. A face is seen from its front when its vertices run anticlockwise.
struct Mesh {
  using Face = std::array<std::uint32_t, 3>;  ///< indices into `vertices`
  std::vector<Eigen::Vector3d> vertices;
  std::vector<Face> faces;
  std::vector<Column> face_columns;  ///< one value a face each, by name

  [[nodiscard]] bool empty() const { return faces.empty(); }
};

}  // namespace ray
