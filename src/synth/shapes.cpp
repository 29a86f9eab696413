#include "shapes.h"

#include "turn.h"

#include <cmath>
#include <map>
#include <utility>

namespace ray {

AcrossAxes across(const Eigen::Vector3d& axis) {
  const Eigen::Vector3d other =
      std::abs(axis.z()) < 0.9 ? Eigen::Vector3d::UnitZ().eval() : Eigen::Vector3d::UnitX().eval();
  const Eigen::Vector3d first = other.cross(axis).normalized();
  return {first, axis.cross(first)};
}

Pose placed(const Eigen::Vector3d& position, double turns) {
  const Eigen::Vector2d direction = turned(turns);
  Pose pose;
  pose.rotation << direction.x(), -direction.y(), 0, direction.y(), direction.x(), 0, 0, 0, 1;
  pose.translation = position;
  return pose;
}

double surface_area(const Mesh& mesh) {
  double area = 0.0;
  for (const Mesh::Face& face : mesh.faces) {
    const Eigen::Vector3d& a = mesh.vertices[face[0]];
    area += (mesh.vertices[face[1]] - a).cross(mesh.vertices[face[2]] - a).norm() / 2;
  }
  return area;
}

double enclosed_volume(const Mesh& mesh) {
  if (mesh.empty()) return 0.0;
  const Eigen::Vector3d origin = mesh.vertices[mesh.faces[0][0]];  // near, for small rounding errors
  double volume = 0.0;
  for (const Mesh::Face& face : mesh.faces) {
    const Eigen::Vector3d a = mesh.vertices[face[0]] - origin;
    volume += a.dot((mesh.vertices[face[1]] - origin).cross(mesh.vertices[face[2]] - origin)) / 6;
  }
  return volume;
}

std::uint32_t MeshBuilder::vertex(const Eigen::Vector3d& position) {
  mesh_.vertices.push_back(pose_ * position);
  return static_cast<std::uint32_t>(mesh_.vertices.size() - 1);
}

void MeshBuilder::box(const Eigen::Vector3d& low, const Eigen::Vector3d& high) {
  const auto corner = [&](bool x, bool y, bool z) {
    return Eigen::Vector3d(x ? high.x() : low.x(), y ? high.y() : low.y(), z ? high.z() : low.z());
  };
  hexahedron({corner(false, false, false), corner(true, false, false), corner(true, true, false),
              corner(false, true, false), corner(false, false, true), corner(true, false, true),
              corner(true, true, true), corner(false, true, true)});
}

void MeshBuilder::hexahedron(const std::array<Eigen::Vector3d, 8>& corners) {
  const auto first = static_cast<std::uint32_t>(mesh_.vertices.size());
  for (const Eigen::Vector3d& corner : corners)
    vertex(corner);
  const auto quad = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
    mesh_.faces.push_back({first + a, first + b, first + c});
    mesh_.faces.push_back({first + a, first + c, first + d});
  };
  quad(3, 2, 1, 0);
  quad(4, 5, 6, 7);
  for (std::uint32_t side = 0; side < 4; ++side)
    quad(side, (side + 1) % 4, 4 + (side + 1) % 4, 4 + side);
}

void MeshBuilder::tube(const Eigen::Vector3d& from, double from_radius, const Eigen::Vector3d& to,
                       double to_radius, std::size_t sides) {
  const AcrossAxes axes = across((to - from).normalized());
  const double angle = 1.0 / static_cast<double>(sides);
  const double circle_over_polygon = 2 * 3.141592653589793 * angle / turned(angle).y();  // areas
  const double widen = std::sqrt(circle_over_polygon);
  const auto first = static_cast<std::uint32_t>(mesh_.vertices.size());
  const auto count = static_cast<std::uint32_t>(sides);
  for (std::uint32_t side = 0; side < count; ++side) {
    const Eigen::Vector2d direction = turned(side * angle);
    const Eigen::Vector3d outwards = widen * (direction.x() * axes.first + direction.y() * axes.second);
    vertex(from + from_radius * outwards);
    vertex(to + to_radius * outwards);
  }
  for (std::uint32_t side = 0; side < count; ++side) {
    const std::uint32_t low = first + 2 * side;
    const std::uint32_t next = first + 2 * ((side + 1) % count);
    mesh_.faces.push_back({low, next, next + 1});
    mesh_.faces.push_back({low, next + 1, low + 1});
  }
  for (std::uint32_t side = 1; side + 1 < count; ++side) {
    mesh_.faces.push_back({first, first + 2 * (side + 1), first + 2 * side});
    mesh_.faces.push_back({first + 1, first + 2 * side + 1, first + 2 * (side + 1) + 1});
  }
}

void MeshBuilder::triangle(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c) {
  const std::uint32_t first = vertex(a);
  vertex(b);
  vertex(c);
  mesh_.faces.push_back({first, first + 1, first + 2});
}

void MeshBuilder::leaf(const Eigen::Vector3d& stem, const Eigen::Vector3d& tip, const Eigen::Vector3d& flat,
                       const Eigen::Vector3d& up, double area, double fold) {
  const double half_width = area / (tip - stem).norm() / std::sqrt(1 + fold * fold);
  const Eigen::Vector3d middle = stem + 0.45 * (tip - stem);
  const std::uint32_t first = vertex(stem);
  vertex(tip);
  vertex(middle + half_width * (flat + fold * up));
  vertex(middle + half_width * (fold * up - flat));
  mesh_.faces.push_back({first, first + 1, first + 2});
  mesh_.faces.push_back({first, first + 3, first + 1});
}

void MeshBuilder::mesh(const Mesh& other) {
  const auto first = static_cast<std::uint32_t>(mesh_.vertices.size());
  for (const Eigen::Vector3d& position : other.vertices)
    vertex(position);
  for (const Mesh::Face& face : other.faces)
    mesh_.faces.push_back({first + face[0], first + face[1], first + face[2]});
}

namespace {

Mesh icosahedron() {
  const double g = (1 + std::sqrt(5.0)) / 2;
  Mesh mesh;
  mesh.vertices = {{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
                   {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
  mesh.faces = {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
                {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
                {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}};
  return mesh;
}

Mesh split_in_four(const Mesh& coarse) {
  Mesh fine;
  fine.vertices = coarse.vertices;
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
  const auto middle = [&](std::uint32_t a, std::uint32_t b) {
    const auto [place, added] =
        middles.try_emplace(std::minmax(a, b), static_cast<std::uint32_t>(fine.vertices.size()));
    if (added) fine.vertices.push_back((coarse.vertices[a] + coarse.vertices[b]) / 2);
    return place->second;
  };
  for (const auto& [a, b, c] : coarse.faces) {
    const std::uint32_t ab = middle(a, b);
    const std::uint32_t bc = middle(b, c);
    const std::uint32_t ca = middle(c, a);
    fine.faces.insert(fine.faces.end(), {{a, ab, ca}, {b, bc, ab}, {c, ca, bc}, {ab, bc, ca}});
  }
  return fine;
}

}  // namespace

Mesh icosphere(int splits) {
  Mesh mesh = icosahedron();
  for (int i = 0; i < splits; ++i)
    mesh = split_in_four(mesh);
  for (Eigen::Vector3d& vertex : mesh.vertices)
    vertex.normalize();
  return mesh;
}

}  // namespace ray
