#pragma once
/// The edges of a mesh as a sorted list of the sides of its faces.

#include <raycloud/core/mesh.h>
#include <raycloud/mesh/topology.h>

#include <algorithm>
#include <cstdint>
#include <tuple>
#include <vector>

namespace ray {

/// One side of a face; the sides of an edge have the same ends.
struct FaceSide {
  std::uint32_t low = 0;   ///< the vertex with the lower number
  std::uint32_t high = 0;  ///< the other
  std::uint32_t face = 0;
  std::uint8_t side = 0;  ///< from corner `side` of the face to the next
  bool forwards = false;  ///< from low to high
};

/// All sides, by edge and then by face.
[[nodiscard]] inline std::vector<FaceSide> sorted_sides(const Mesh& mesh) {
  std::vector<FaceSide> sides;
  sides.reserve(3 * mesh.faces.size());
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    for (std::uint8_t i = 0; i < 3; ++i) {
      const std::uint32_t from = mesh.faces[f][i];
      const std::uint32_t to = mesh.faces[f][(i + 1) % 3];
      sides.push_back({std::min(from, to), std::max(from, to), static_cast<std::uint32_t>(f), i, from < to});
    }
  }
  std::sort(sides.begin(), sides.end(), [](const FaceSide& a, const FaceSide& b) {
    return std::tie(a.low, a.high, a.face, a.side) < std::tie(b.low, b.high, b.face, b.side);
  });
  return sides;
}

/// Calls `visit(first, last)`, pointers to the sides of an edge, for each edge.
template <class Visit>
void for_each_edge(const std::vector<FaceSide>& sides, const Visit& visit) {
  for (const FaceSide *first = sides.data(), *end = first + sides.size(); first != end;) {
    const FaceSide* last = first;
    while (last != end && last->low == first->low && last->high == first->high)
      ++last;
    visit(first, last);
    first = last;
  }
}

/// topology_of, of a mesh whose sides are known.
[[nodiscard]] MeshTopology count_topology(const Mesh& mesh, const std::vector<FaceSide>& sides);

}  // namespace ray
