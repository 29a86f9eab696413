#include "disjoint_sets.h"
#include "edges.h"

#include <raycloud/mesh/topology.h>

namespace ray {
namespace {

/// Fans: corners of faces, joined across the edges that they share at a vertex. A pinched vertex has more
/// than one.
std::size_t count_pinched(const Mesh& mesh, DisjointSets& corners) {
  std::vector<std::uint32_t> fan(mesh.vertices.size());
  std::vector<std::uint8_t> state(mesh.vertices.size(), 0);  // 0: no face yet, 1: one fan, 2: more
  std::size_t pinched = 0;
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t vertex = mesh.faces[f][i];
      const std::uint32_t set = corners.find(static_cast<std::uint32_t>(3 * f + i));
      if (state[vertex] == 0) {
        fan[vertex] = set;
        state[vertex] = 1;
      } else if (state[vertex] == 1 && fan[vertex] != set) {
        state[vertex] = 2;
        ++pinched;
      }
    }
  }
  return pinched;
}

}  // namespace

MeshTopology topology_of(const Mesh& mesh) {
  return count_topology(mesh, sorted_sides(mesh));
}

MeshTopology count_topology(const Mesh& mesh, const std::vector<FaceSide>& sides) {
  MeshTopology topology;
  topology.faces = mesh.faces.size();
  std::vector<std::uint8_t> used(mesh.vertices.size(), 0);
  for (const Mesh::Face& face : mesh.faces) {
    for (const std::uint32_t vertex : face)
      used[vertex] = 1;
  }
  topology.vertices = static_cast<std::size_t>(std::count(used.begin(), used.end(), 1));

  DisjointSets faces(mesh.faces.size());
  DisjointSets corners(3 * mesh.faces.size());
  DisjointSets rims(mesh.vertices.size());
  std::vector<std::uint8_t> on_rim(mesh.vertices.size(), 0);
  const auto corner_at = [&](const FaceSide& side, std::uint32_t vertex) {
    const bool first = mesh.faces[side.face][side.side] == vertex;
    return 3 * side.face + (first ? side.side : (side.side + 1u) % 3u);
  };
  for_each_edge(sides, [&](const FaceSide* first, const FaceSide* last) {
    ++topology.edges;
    if (last - first == 1) {
      ++topology.border_edges;
      rims.unite(first->low, first->high);
      on_rim[first->low] = on_rim[first->high] = 1;
    } else if (last - first > 2) {
      ++topology.tangled_edges;
    } else if (first[0].forwards == first[1].forwards) {
      ++topology.reversed_edges;
    }
    for (const FaceSide* other = first + 1; other < last; ++other) {
      faces.unite(first->face, other->face);
      for (const std::uint32_t vertex : {first->low, first->high})
        corners.unite(corner_at(*first, vertex), corner_at(*other, vertex));
    }
  });
  topology.components = mesh.faces.empty() ? 0 : faces.count();
  topology.pinched_vertices = count_pinched(mesh, corners);
  for (std::uint32_t v = 0; v < mesh.vertices.size(); ++v)
    topology.border_loops += on_rim[v] != 0 && rims.find(v) == v ? 1 : 0;
  return topology;
}

}  // namespace ray
