#pragma once
/// Making one surface of the triangles of a file. Programs that write meshes often repeat a vertex for each
/// face that has it, and leave triangles behind that have shrunk to a line.

#include <raycloud/core/mesh.h>

#include <cstddef>

namespace ray {

struct WeldedMesh {
  Mesh mesh;                     ///< vertices in the order in which the faces use them; no face columns
  std::size_t without_area = 0;  ///< faces left out
};

/// Vertices at exactly the same place become one, those of no face go, and so do faces without an area.
/// Faces keep their order. O(n log n). Precondition: finite vertices, indices in range. Throws
/// Error(no_data) if no face is left.
[[nodiscard]] WeldedMesh weld(const Mesh& mesh);

}  // namespace ray
