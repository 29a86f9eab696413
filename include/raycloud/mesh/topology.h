#pragma once
/// How the triangles of a mesh hang together: what is a surface, what is torn, what is tangled, and what goes
/// through itself.

#include <raycloud/core/mesh.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace ray {

/// Counts over the vertices as they are numbered: two vertices at one place are two (see `weld`).
struct MeshTopology {
  std::size_t vertices = 0;  ///< that a face has
  std::size_t edges = 0;
  std::size_t faces = 0;
  std::size_t border_edges = 0;   ///< of one face
  std::size_t tangled_edges = 0;  ///< of three faces or more
  std::size_t reversed_edges =
      0;  ///< of two faces, one of which shows its front where the other shows its back
  std::size_t pinched_vertices = 0;  ///< whose faces are not one fan
  std::size_t border_loops = 0;      ///< closed ways along border edges; meaningful for a surface only
  std::size_t components = 0;        ///< sets of faces that are connected by edges

  [[nodiscard]] std::ptrdiff_t euler_characteristic() const {
    return static_cast<std::ptrdiff_t>(vertices + faces) - static_cast<std::ptrdiff_t>(edges);
  }
  /// Every edge has two faces or is on the border, every vertex has one fan, and one side is the front.
  [[nodiscard]] bool is_surface() const {
    return tangled_edges == 0 && reversed_edges == 0 && pinched_vertices == 0;
  }
  [[nodiscard]] bool is_closed() const { return is_surface() && border_edges == 0 && faces > 0; }
  /// One closed surface without handles.
  [[nodiscard]] bool is_sphere() const {
    return is_closed() && components == 1 && euler_characteristic() == 2;
  }
  /// One surface with one border and neither holes nor handles.
  [[nodiscard]] bool is_disc() const {
    return is_surface() && components == 1 && border_loops == 1 && euler_characteristic() == 1;
  }
};

/// O(n log n) in the faces; 40 bytes a face. Precondition: indices in range.
[[nodiscard]] MeshTopology topology_of(const Mesh& mesh);

/// Pairs of faces, the lower first and in order, that meet elsewhere than at a corner, an edge or no place of
/// both: they cross, touch, overlap or are the same. Exact, for coordinates whose products of three are
/// doubles (1e-100 to 1e100). Corners at one place are one, whether or not the mesh is welded; faces without
/// an area meet nothing.
///
/// O(n log n) in the faces of a surface whose triangles are not mostly needles, some 2 µs a face; 150 bytes
/// a face. Precondition: indices in range, finite vertices.
[[nodiscard]] std::vector<std::array<std::uint32_t, 2>> self_intersections(const Mesh& mesh);

}  // namespace ray
