#pragma once
/// Measuring scenes, written apart from the code that builds them.

#include <raycloud/synth/scene.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <utility>
#include <vector>

namespace ray::test {

using Triangle = std::array<Eigen::Vector3d, 3>;

inline Triangle triangle(const Mesh& mesh, const Mesh::Face& face) {
  return {mesh.vertices.at(face[0]), mesh.vertices.at(face[1]), mesh.vertices.at(face[2])};
}

/// Heron's formula in Kahan's stable form.
inline double heron(const Triangle& t) {
  std::array<double, 3> s{(t[0] - t[1]).norm(), (t[1] - t[2]).norm(), (t[2] - t[0]).norm()};
  std::sort(s.begin(), s.end(), std::greater<>());
  const auto [a, b, c] = s;
  return std::sqrt(std::max(0.0, (a + (b + c)) * (c - (a - b)) * (c + (a - b)) * (a + (b - c)))) / 4;
}

inline double area_of(const Mesh& mesh) {
  double area = 0.0;
  for (const Mesh::Face& face : mesh.faces)
    area += heron(triangle(mesh, face));
  return area;
}

/// By prisms down to z = 0 below each face; positive with fronts outside.
inline double volume_of(const Mesh& mesh) {
  double volume = 0.0;
  for (const Mesh::Face& face : mesh.faces) {
    const auto [a, b, c] = triangle(mesh, face);
    const double flat = ((b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x())) / 2;
    volume += flat * (a.z() + b.z() + c.z()) / 3;
  }
  return volume;
}

/// Whether the segment from `a` to `b` crosses the triangle, by the signs of volumes of tetrahedra.
inline bool crosses(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Triangle& t) {
  const auto sign = [](const Eigen::Vector3d& p, const Eigen::Vector3d& q, const Eigen::Vector3d& r,
                       const Eigen::Vector3d& s) { return (q - p).cross(r - p).dot(s - p); };
  if ((sign(t[0], t[1], t[2], a) > 0) == (sign(t[0], t[1], t[2], b) > 0)) return false;
  const bool first = sign(a, b, t[0], t[1]) > 0;
  return first == (sign(a, b, t[1], t[2]) > 0) && first == (sign(a, b, t[2], t[0]) > 0);
}

inline double distance_to_segment(const Eigen::Vector3d& p, const Eigen::Vector3d& a,
                                  const Eigen::Vector3d& b) {
  const double along = std::clamp((p - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
  return (p - a - along * (b - a)).norm();
}

inline double distance(const Eigen::Vector3d& p, const Triangle& t) {
  const Eigen::Vector3d normal = (t[1] - t[0]).cross(t[2] - t[0]).normalized();
  bool above = true;  // the foot of the perpendicular is inside
  for (std::size_t i = 0; i < 3; ++i)
    above = above && (t[(i + 1) % 3] - t[i]).cross(p - t[i]).dot(normal) >= 0;
  if (above) return std::abs(normal.dot(p - t[0]));
  return std::min({distance_to_segment(p, t[0], t[1]), distance_to_segment(p, t[1], t[2]),
                   distance_to_segment(p, t[2], t[0])});
}

inline double fact(const Scene& scene, const std::string& name) {
  for (const SceneFact& one : scene.facts) {
    if (one.name == name) return one.value;
  }
  throw std::runtime_error("no fact " + name);
}

/// The highest surface of a mesh above a place.
inline std::optional<double> height_at(const Mesh& mesh, double x, double y) {
  std::optional<double> highest;
  for (const Mesh::Face& face : mesh.faces) {
    const auto [a, b, c] = triangle(mesh, face);
    if (std::max({a.x(), b.x(), c.x()}) < x || std::min({a.x(), b.x(), c.x()}) > x ||
        std::max({a.y(), b.y(), c.y()}) < y || std::min({a.y(), b.y(), c.y()}) > y)
      continue;
    const Eigen::Vector3d normal = (b - a).cross(c - a);
    const double z = a.z() - (normal.x() * (x - a.x()) + normal.y() * (y - a.y())) / normal.z();
    const Eigen::Vector3d p(x, y, z);
    const bool inside = (b - a).cross(p - a).dot(normal) >= -1e-12 &&
                        (c - b).cross(p - b).dot(normal) >= -1e-12 &&
                        (a - c).cross(p - c).dot(normal) >= -1e-12;
    if (inside) highest = std::max(highest.value_or(z), z);
  }
  return highest;
}

}  // namespace ray::test
