#include <raycloud/core/error.h>
#include <raycloud/mesh/weld.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>
#include <numeric>
#include <string>

namespace ray {
namespace {

constexpr std::uint32_t kUnused = std::numeric_limits<std::uint32_t>::max();

/// For each vertex the first one at the same place.
std::vector<std::uint32_t> first_at_place(const std::vector<Eigen::Vector3d>& vertices) {
  std::vector<std::uint32_t> order(vertices.size());
  std::iota(order.begin(), order.end(), std::uint32_t{0});
  const auto less = [&](std::uint32_t a, std::uint32_t b) {
    return std::lexicographical_compare(vertices[a].begin(), vertices[a].end(), vertices[b].begin(),
                                        vertices[b].end());
  };
  std::stable_sort(order.begin(), order.end(), less);
  std::vector<std::uint32_t> first(vertices.size());
  for (std::size_t i = 0; i < order.size(); ++i)
    first[order[i]] = i > 0 && !less(order[i - 1], order[i]) ? first[order[i - 1]] : order[i];
  return first;
}

bool has_area(const Mesh& mesh, const Mesh::Face& face) {
  const Eigen::Vector3d& a = mesh.vertices[face[0]];
  const double area = (mesh.vertices[face[1]] - a).cross(mesh.vertices[face[2]] - a).squaredNorm();
  return area > 0.0 && area < std::numeric_limits<double>::infinity();
}

}  // namespace

WeldedMesh weld(const Mesh& mesh) {
  const std::vector<std::uint32_t> first = first_at_place(mesh.vertices);
  std::vector<std::uint32_t> number(mesh.vertices.size(), kUnused);
  WeldedMesh welded;
  for (const Mesh::Face& face : mesh.faces) {
    if (!has_area(mesh, face)) {
      ++welded.without_area;
      continue;
    }
    Mesh::Face& added = welded.mesh.faces.emplace_back();
    for (std::size_t i = 0; i < 3; ++i) {
      std::uint32_t& own = number[first[face[i]]];
      if (own == kUnused) {
        own = static_cast<std::uint32_t>(welded.mesh.vertices.size());
        welded.mesh.vertices.push_back(mesh.vertices[first[face[i]]]);
      }
      added[i] = own;
    }
  }
  if (welded.mesh.faces.empty()) throw Error(ErrorCode::no_data, "the mesh has no face with an area");
  return welded;
}

}  // namespace ray
