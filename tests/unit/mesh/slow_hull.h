#pragma once
/// Hulls without any structure: a sheet is folded around the points edge by edge, trying all points for each.

#include <raycloud/core/mesh.h>

#include <Eigen/Geometry>
#include <set>
#include <utility>
#include <vector>

namespace ray::test {

/// Faces of the lower hull, anticlockwise as seen from above. Points in general position.
inline std::vector<Mesh::Face> slow_lower_hull(const std::vector<Eigen::Vector3d>& points) {
  using Edge = std::pair<std::uint32_t, std::uint32_t>;
  const auto count = static_cast<std::uint32_t>(points.size());
  const auto turn = [&](std::uint32_t a, std::uint32_t b, std::uint32_t p) {
    const Eigen::Vector3d u = points[b] - points[a], v = points[p] - points[a];
    return u.x() * v.y() - u.y() * v.x();
  };
  const auto below = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t p) {
    return (points[b] - points[a]).cross(points[c] - points[a]).dot(points[p] - points[a]) < 0;
  };
  std::vector<Edge> open;
  std::uint32_t first = 0;
  for (std::uint32_t i = 1; i < count; ++i)
    if (points[i].x() < points[first].x()) first = i;
  std::uint32_t from = first;
  do {  // around the border of the plan
    std::uint32_t to = from == 0 ? 1 : 0;
    for (std::uint32_t i = 0; i < count; ++i)
      if (i != from && turn(from, to, i) < 0) to = i;
    open.emplace_back(from, to);
    from = to;
  } while (from != first);
  std::vector<Mesh::Face> hull;
  std::set<Edge> done;
  while (!open.empty()) {
    const Edge edge = open.back();
    const auto a = edge.first, b = edge.second;
    open.pop_back();
    if (!done.insert(edge).second) continue;
    std::uint32_t c = count;
    for (std::uint32_t i = 0; i < count; ++i) {
      if (i == a || i == b || turn(a, b, i) <= 0) continue;
      if (c == count || below(a, b, c, i)) c = i;
    }
    if (c == count) continue;  // the border
    hull.push_back({a, b, c});
    for (const Edge& side : {Edge{b, c}, Edge{c, a}}) {
      done.insert(side);
      open.emplace_back(side.second, side.first);
    }
  }
  return hull;
}

inline std::set<std::size_t> corners_of(const std::vector<Mesh::Face>& faces) {
  std::set<std::size_t> corners;
  for (const Mesh::Face& face : faces)
    corners.insert(face.begin(), face.end());
  return corners;
}

}  // namespace ray::test
