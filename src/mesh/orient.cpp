#include "orient.h"

#include <Eigen/Geometry>
#include <array>
#include <limits>
#include <utility>

namespace ray {
namespace {

constexpr std::uint32_t kNoFace = std::numeric_limits<std::uint32_t>::max();

struct FaceNeighbour {
  std::uint32_t face = kNoFace;
  bool agrees = true;
};

/// Faces to be turned over.
using TurnedFaces = std::vector<std::uint8_t>;

void turn(const TurnedFaces& turned, Mesh& mesh, std::vector<FaceSide>& sides) {
  for (std::size_t f = 0; f < turned.size(); ++f)
    if (turned[f] != 0) std::swap(mesh.faces[f][1], mesh.faces[f][2]);
  for (FaceSide& side : sides) {
    if (turned[side.face] == 0) continue;
    side.side = static_cast<std::uint8_t>(2 - side.side);
    side.forwards = !side.forwards;
  }
}

/// Those that do not agree with the first face of their part.
TurnedFaces disagreeing(const Mesh& mesh, const std::vector<FaceSide>& sides) {
  std::vector<std::array<FaceNeighbour, 3>> neighbours(mesh.faces.size());
  for_each_edge(sides, [&](const FaceSide* first, const FaceSide* last) {
    if (last - first != 2) return;
    const bool agree = first[0].forwards != first[1].forwards;
    neighbours[first[0].face][first[0].side] = {first[1].face, agree};
    neighbours[first[1].face][first[1].side] = {first[0].face, agree};
  });
  TurnedFaces turned(mesh.faces.size(), 0);
  std::vector<std::uint8_t> seen(mesh.faces.size(), 0);
  std::vector<std::uint32_t> front;
  for (std::uint32_t seed = 0; seed < mesh.faces.size(); ++seed) {
    if (seen[seed] != 0) continue;
    seen[seed] = 1;
    front.assign(1, seed);
    while (!front.empty()) {
      const std::uint32_t face = front.back();
      front.pop_back();
      for (const FaceNeighbour& neighbour : neighbours[face]) {
        if (neighbour.face == kNoFace || seen[neighbour.face] != 0) continue;
        seen[neighbour.face] = 1;
        turned[neighbour.face] = neighbour.agrees ? turned[face] : !turned[face];
        front.push_back(neighbour.face);
      }
    }
  }
  return turned;
}

bool shows_its_back(const Mesh& mesh, const std::vector<FaceSide>& sides) {
  bool closed = true;
  for_each_edge(sides,
                [&](const FaceSide* first, const FaceSide* last) { closed = closed && last - first >= 2; });
  const Eigen::Vector3d& origin = mesh.vertices.front();  // far from 0,0,0 the volumes would drown
  double volume = 0.0;
  bool looks_down = true;
  for (const Mesh::Face& face : mesh.faces) {
    const Eigen::Vector3d a = mesh.vertices[face[0]] - origin;
    const Eigen::Vector3d b = mesh.vertices[face[1]] - origin;
    const Eigen::Vector3d c = mesh.vertices[face[2]] - origin;
    const Eigen::Vector3d normal = (b - a).cross(c - a);
    volume += a.dot(normal);
    looks_down = looks_down && normal.z() < 0.0;
  }
  return closed ? volume < 0.0 : looks_down;
}

}  // namespace

void orient(Mesh& mesh, std::vector<FaceSide>& sides) {
  turn(disagreeing(mesh, sides), mesh, sides);
  if (shows_its_back(mesh, sides)) turn(TurnedFaces(mesh.faces.size(), 1), mesh, sides);
}

}  // namespace ray
