#include "edges.h"
#include "embree_faces.h"
#include "known_side.h"
#include "orient.h"

#include <raycloud/mesh/mesh_distance.h>
#include <raycloud/mesh/weld.h>

#include <array>
#include <cmath>
#include <utility>

namespace ray {
namespace {

/// Of the three corners, three sides and the inside of each face. Not of unit length: only signs count.
struct PseudoNormals {
  std::vector<Eigen::Vector3d> of_vertex;
  std::vector<std::array<Eigen::Vector3d, 3>> of_side;
  std::vector<Eigen::Vector3d> of_face;  ///< unit
};

double angle_at(const Eigen::Vector3d& corner, const Eigen::Vector3d& b, const Eigen::Vector3d& c) {
  return std::atan2((b - corner).cross(c - corner).norm(), (b - corner).dot(c - corner));
}

PseudoNormals pseudo_normals(const Mesh& mesh, const std::vector<FaceSide>& sides) {
  PseudoNormals normals;
  normals.of_vertex.assign(mesh.vertices.size(), Eigen::Vector3d::Zero());
  normals.of_side.resize(mesh.faces.size());
  normals.of_face.reserve(mesh.faces.size());
  for (const Mesh::Face& face : mesh.faces) {
    const Eigen::Vector3d& a = mesh.vertices[face[0]];
    const Eigen::Vector3d& b = mesh.vertices[face[1]];
    const Eigen::Vector3d& c = mesh.vertices[face[2]];
    const Eigen::Vector3d normal = (b - a).cross(c - a).normalized();
    normals.of_face.push_back(normal);
    normals.of_vertex[face[0]] += angle_at(a, b, c) * normal;
    normals.of_vertex[face[1]] += angle_at(b, c, a) * normal;
    normals.of_vertex[face[2]] += angle_at(c, a, b) * normal;
  }
  for_each_edge(sides, [&](const FaceSide* first, const FaceSide* last) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (const FaceSide* side = first; side < last; ++side)
      sum += normals.of_face[side->face];
    for (const FaceSide* side = first; side < last; ++side)
      normals.of_side[side->face][side->side] = sum;
  });
  return normals;
}

/// A mesh as turned, with its sides.
struct OrientedMesh {
  explicit OrientedMesh(Mesh given) : mesh(std::move(given)), sides(sorted_sides(mesh)) {
    orient(mesh, sides);
  }
  Mesh mesh;
  std::vector<FaceSide> sides;
};

}  // namespace

struct MeshDistance::Impl {
  explicit Impl(WeldedMesh welded) : Impl(OrientedMesh(std::move(welded.mesh)), welded.without_area) {}
  Impl(OrientedMesh oriented, std::size_t faces_left_out)
      : mesh(std::move(oriented.mesh)),
        without_area(faces_left_out),
        topology(count_topology(mesh, oriented.sides)),
        normals(pseudo_normals(mesh, oriented.sides)),
        known_side(mesh, oriented.sides, topology),
        faces(mesh) {}

  [[nodiscard]] const Eigen::Vector3d& normal_at(const NearestFace& found) const {
    const FacePart part = found.nearest.part;
    if (part == kInside) return normals.of_face[found.face];
    if (part >= 3) return normals.of_side[found.face][part - 3u];
    return normals.of_vertex[mesh.faces[found.face][part]];
  }

  /// `known` is known_side.of(point).
  [[nodiscard]] double signed_distance(const Eigen::Vector3d& point, const NearestFace& found,
                                       int known) const {
    const double distance = std::sqrt(found.nearest.squared);
    if (known != 0) return known < 0 ? -distance : distance;
    return (point - found.nearest.place).dot(normal_at(found)) < 0.0 ? -distance : distance;
  }

  /// Whether signed_distance > distance; `near` is the face found for the point before, and becomes this
  /// one's.
  [[nodiscard]] bool is_beyond(const Eigen::Vector3d& point, double distance, std::uint32_t& near) const {
    // Something surely within the distance decides, whichever side it is on.
    const double within = distance * distance * (1.0 - 1e-14);
    const double perhaps_within = distance * distance * (1.0 + 1e-14);
    NearestFace found = faces.find_within(point, near, perhaps_within, within);
    if (found.nearest.squared < within) {
      near = found.face;
      return distance < 0.0;
    }
    const int known = known_side.of(point);
    if (found.face == EmbreeFaces::kNoFace) {
      if (known != 0) return known > 0;
      found = faces.find(point, near);
    }
    near = found.face;
    return signed_distance(point, found, known) > distance;
  }

  Mesh mesh;
  std::size_t without_area;
  MeshTopology topology;
  PseudoNormals normals;
  KnownSide known_side;
  EmbreeFaces faces;
};

MeshDistance::MeshDistance(const Mesh& mesh) : impl_(std::make_unique<Impl>(weld(mesh))) {}
MeshDistance::~MeshDistance() = default;
MeshDistance::MeshDistance(MeshDistance&&) noexcept = default;
MeshDistance& MeshDistance::operator=(MeshDistance&&) noexcept = default;

std::vector<double> MeshDistance::at(std::span<const Eigen::Vector3d> points) const {
  std::vector<double> distances;
  distances.reserve(points.size());
  std::uint32_t near = 0;
  for (const Eigen::Vector3d& point : points) {
    const NearestFace found = impl_->faces.find(point, near);
    near = found.face;
    distances.push_back(impl_->signed_distance(point, found, impl_->known_side.of(point)));
  }
  return distances;
}

void MeshDistance::are_beyond(std::span<const Eigen::Vector3d> points, double distance,
                              std::span<std::uint8_t> beyond) const {
  std::uint32_t near = 0;
  for (std::size_t i = 0; i < points.size(); ++i)
    beyond[i] = impl_->is_beyond(points[i], distance, near) ? 1 : 0;
}

const Mesh& MeshDistance::mesh() const {
  return impl_->mesh;
}

const MeshTopology& MeshDistance::topology() const {
  return impl_->topology;
}

std::size_t MeshDistance::faces_without_area() const {
  return impl_->without_area;
}

}  // namespace ray
