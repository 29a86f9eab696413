#pragma once
/// Points to wrap, and their wraps.

#include "shapes.h"

#include <raycloud/core/memory_stream.h>
#include <raycloud/core/ray_cloud.h>
#include <raycloud/mesh/wrap.h>

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <set>
#include <utility>
#include <vector>

namespace ray::test {

inline RayCloud cloud_of(const std::vector<Eigen::Vector3d>& ends,
                         const Eigen::Vector3d& start = Eigen::Vector3d::Zero()) {
  RayCloud cloud;
  cloud.resize(ends.size());
  for (std::size_t i = 0; i < ends.size(); ++i) {
    cloud.ends[i] = ends[i];
    cloud.starts[i] = start;
    cloud.times[i] = 0;
    cloud.bounded[i] = 1;
  }
  return cloud;
}

inline Wrap wrapped(const RayCloud& cloud, WrapDirection direction, double curvature,
                    std::size_t chunk = 1000, const Context& context = {.threads = 1}) {
  MemorySource source(cloud, chunk);
  return wrap(context, source, direction, curvature);
}

/// Numbers of the points that are vertices.
inline std::set<std::size_t> vertices_of(const Mesh& mesh, const std::vector<Eigen::Vector3d>& points) {
  std::set<std::size_t> found;
  for (const Eigen::Vector3d& vertex : mesh.vertices) {
    std::size_t best = 0;
    for (std::size_t i = 1; i < points.size(); ++i)
      if ((points[i] - vertex).squaredNorm() < (points[best] - vertex).squaredNorm()) best = i;
    EXPECT_LT((points[best] - vertex).norm(), 1e-6);
    found.insert(best);
  }
  EXPECT_EQ(found.size(), mesh.vertices.size());
  return found;
}

/// Hills, with things on them.
inline std::vector<Eigen::Vector3d> rough_points(std::uint64_t seed, std::size_t count, double size) {
  const RandomStream random(seed, "rough");
  std::vector<Eigen::Vector3d> points;
  for (std::uint64_t i = 0; i < count; ++i) {
    Eigen::Vector3d point = random_place(random, i, size);
    point.z() = 0.2 * size * std::sin(4 * point.x() / size) * std::cos(3 * point.y() / size) +
                0.2 * size * std::pow(random.uniform(i, 9), 4);
    points.push_back(point);
  }
  return points;
}

/// Around the origin, dented.
inline std::vector<Eigen::Vector3d> star_points(std::uint64_t seed, std::size_t count) {
  const RandomStream random(seed, "star");
  std::vector<Eigen::Vector3d> points;
  for (std::uint64_t i = 0; points.size() < count; ++i) {
    const Eigen::Vector3d place = random_place(random, i, 1.0);
    if (place.norm() < 0.1 || place.norm() > 1.0) continue;
    const Eigen::Vector3d n = place.normalized();
    points.push_back(n * (3.0 + std::sin(5 * n.x()) * std::cos(4 * n.y()) + 0.2 * random.uniform(i, 5)));
  }
  return points;
}

/// As a closed mesh with all ends inside: a sheet gets walls up (or down, where it is seen from above) from
/// its border and a lid at a level.
inline Mesh closed_sheet(const Mesh& sheet, bool upwards, double level) {
  Mesh mesh = sheet;
  if (upwards) {
    for (Mesh::Face& face : mesh.faces)
      std::swap(face[1], face[2]);  // fronts are outside now
  }
  std::map<std::uint32_t, std::uint32_t> next;  // along the border, backwards
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> sides;
  for (const Mesh::Face& face : mesh.faces)
    for (std::size_t i = 0; i < 3; ++i)
      sides[{face[i], face[(i + 1) % 3]}] = 1;
  for (const auto& [side, one] : sides)
    if (sides.count({side.second, side.first}) == 0) next[side.second] = side.first;
  std::map<std::uint32_t, std::uint32_t> raised;
  for (const auto& [from, to] : next) {
    raised[from] = static_cast<std::uint32_t>(mesh.vertices.size());
    mesh.vertices.emplace_back(mesh.vertices[from].x(), mesh.vertices[from].y(), level);
  }
  const auto lid = static_cast<std::uint32_t>(mesh.vertices.size());
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  for (const auto& [from, to] : raised)
    middle += mesh.vertices[to] / static_cast<double>(raised.size());
  mesh.vertices.push_back(middle);
  for (const auto& [from, to] : next) {
    mesh.faces.push_back({from, to, raised[from]});
    mesh.faces.push_back({to, raised[to], raised[from]});
    mesh.faces.push_back({raised[from], raised[to], lid});
  }
  return mesh;
}

}  // namespace ray::test
