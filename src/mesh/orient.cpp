#include "orient.h"

#include "edges.h"

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

void turn(Mesh::Face& face) {
  std::swap(face[1], face[2]);
}

void make_neighbours_agree(Mesh& mesh) {
  std::vector<std::array<FaceNeighbour, 3>> neighbours(mesh.faces.size());
  for_each_edge(sorted_sides(mesh), [&](const FaceSide* first, const FaceSide* last) {
    if (last - first != 2) return;
    const bool agree = first[0].forwards != first[1].forwards;
    neighbours[first[0].face][first[0].side] = {first[1].face, agree};
    neighbours[first[1].face][first[1].side] = {first[0].face, agree};
  });
  enum : std::uint8_t { unseen, kept, turned };
  std::vector<std::uint8_t> state(mesh.faces.size(), unseen);
  std::vector<std::uint32_t> front;
  for (std::uint32_t seed = 0; seed < mesh.faces.size(); ++seed) {
    if (state[seed] != unseen) continue;
    state[seed] = kept;
    front.assign(1, seed);
    while (!front.empty()) {
      const std::uint32_t face = front.back();
      front.pop_back();
      for (const FaceNeighbour& neighbour : neighbours[face]) {
        if (neighbour.face == kNoFace || state[neighbour.face] != unseen) continue;
        state[neighbour.face] = (state[face] == kept) == neighbour.agrees ? kept : turned;
        front.push_back(neighbour.face);
      }
    }
  }
  for (std::size_t f = 0; f < mesh.faces.size(); ++f)
    if (state[f] == turned) turn(mesh.faces[f]);
}

bool shows_its_back(const Mesh& mesh) {
  bool closed = true;
  for_each_edge(sorted_sides(mesh),
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

void orient(Mesh& mesh) {
  make_neighbours_agree(mesh);
  if (!shows_its_back(mesh)) return;
  for (Mesh::Face& face : mesh.faces)
    turn(face);
}

}  // namespace ray
