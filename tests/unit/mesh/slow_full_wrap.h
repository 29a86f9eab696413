#pragma once
/// The full wrap as a ball would do it: pushed through each face until it meets an end, trying all of them;
/// then the face with the largest ball gives way, if the surface stays whole. No triangulation, no order but
/// that of the radii. Points in general position.

#include "slow_hull.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>

namespace ray::test {

class SlowFullWrap {
 public:
  using Vector = Eigen::Vector3d;
  using Cell = std::array<std::uint32_t, 4>;  ///< in order

  explicit SlowFullWrap(const std::vector<Vector>& points) : points_(points) {}

  /// From below for 1, from above for -1: faces to begin with, anticlockwise as seen from outside.
  [[nodiscard]] std::vector<Mesh::Face> hull_seen_from(double sign) const {
    std::vector<Vector> seen = points_;
    for (Vector& point : seen)
      point.z() *= sign;
    std::vector<Mesh::Face> faces = slow_lower_hull(seen);
    for (Mesh::Face& face : faces)
      if (sign > 0) std::swap(face[1], face[2]);
    return faces;
  }

  /// The tetrahedron around a place.
  [[nodiscard]] Cell cell_at(const Vector& place) const {
    Mesh::Face face = hull_seen_from(1).front();
    while (true) {
      const std::uint32_t apex = push_through(face);
      Mesh::Face next = face;
      for (const Mesh::Face& side : sides_behind(face, apex))
        if (in_front(side, place) < 0) next = side;
      if (next == face) return sorted(face, apex);
      face = next;
    }
  }

  /// What is left of a surface, for balls of at least this radius.
  [[nodiscard]] std::set<Mesh::Face> wrap(const std::vector<Mesh::Face>& first, double radius) {
    for (const Mesh::Face& face : first)
      add(face);
    while (true) {
      const Cell* best = nullptr;
      double largest = radius;
      for (const auto& [cell, behind] : cells_)
        if (behind.radius >= largest && may_go(cell, behind.faces)) best = &cell, largest = behind.radius;
      if (best == nullptr) break;
      const std::vector<Mesh::Face> faces = cells_.at(*best).faces;
      for (const Mesh::Face& face : sides_left(*best, faces))
        add(face);
      for (const Mesh::Face& face : faces)
        remove(face);
    }
    std::set<Mesh::Face> result;
    for (const auto& [face, cell] : faces_)
      result.insert(face);
    return result;
  }

  static Mesh::Face turned(Mesh::Face face) {
    std::rotate(face.begin(), std::min_element(face.begin(), face.end()), face.end());
    return face;
  }

  /// All four faces, anticlockwise as seen from inside.
  [[nodiscard]] std::vector<Mesh::Face> faces_from_inside(const Cell& cell) const {
    std::vector<Mesh::Face> faces;
    for (std::size_t i = 0; i < 4; ++i) {
      Mesh::Face face{cell[(i + 1) % 4], cell[(i + 2) % 4], cell[(i + 3) % 4]};
      if (in_front(face, points_[cell[i]]) < 0) std::swap(face[1], face[2]);
      faces.push_back(face);
    }
    return faces;
  }

  [[nodiscard]] double radius_of(const Cell& cell) const {
    const Vector& a = points_[cell[0]];
    const Vector u = points_[cell[1]] - a, v = points_[cell[2]] - a, w = points_[cell[3]] - a;
    return (u.squaredNorm() * v.cross(w) + v.squaredNorm() * w.cross(u) + w.squaredNorm() * u.cross(v))
               .norm() /
           std::abs(2 * u.dot(v.cross(w)));
  }

 private:
  static constexpr std::uint32_t kNone = ~0u;
  struct CellBehind {
    double radius = 0.0;
    std::vector<Mesh::Face> faces;
  };

  [[nodiscard]] double in_front(const Mesh::Face& face, const Vector& p) const {
    const Vector& a = points_[face[0]];
    return (points_[face[1]] - a).cross(points_[face[2]] - a).dot(p - a);
  }

  /// The first point that a ball on the face meets that grows behind it.
  [[nodiscard]] std::uint32_t push_through(const Mesh::Face& face) const {
    const Vector& a = points_[face[0]];
    const Vector u = points_[face[1]] - a, v = points_[face[2]] - a;
    const Vector normal = u.cross(v);
    const Vector centre =
        (u.squaredNorm() * v.cross(normal) + v.squaredNorm() * normal.cross(u)) / (2 * normal.squaredNorm());
    std::uint32_t best = kNone;
    double least = std::numeric_limits<double>::infinity();
    for (std::uint32_t i = 0; i < points_.size(); ++i) {
      const Vector p = points_[i] - a;
      const double depth = -normal.dot(p);
      if (depth <= 0 || i == face[0] || i == face[1] || i == face[2]) continue;
      const double along = (p.squaredNorm() - 2 * p.dot(centre)) / depth;  // of the centre of the ball
      if (along < least) best = i, least = along;
    }
    return best;
  }

  static Cell sorted(const Mesh::Face& face, std::uint32_t apex) {
    Cell cell{face[0], face[1], face[2], apex};
    std::sort(cell.begin(), cell.end());
    return cell;
  }

  /// The other faces of the tetrahedron behind a face, anticlockwise as seen from it.
  static std::array<Mesh::Face, 3> sides_behind(const Mesh::Face& face, std::uint32_t apex) {
    const auto& [a, b, c] = face;
    return {{{a, b, apex}, {b, c, apex}, {c, a, apex}}};
  }

  [[nodiscard]] std::vector<Mesh::Face> sides_left(const Cell& cell,
                                                   const std::vector<Mesh::Face>& gone) const {
    std::vector<Mesh::Face> left;
    for (const Mesh::Face& face : faces_from_inside(cell)) {
      // Those that are gone are seen from outside, the other way round.
      if (std::find(gone.begin(), gone.end(), turned({face[0], face[2], face[1]})) == gone.end())
        left.push_back(face);
    }
    return left;
  }

  [[nodiscard]] bool may_go(const Cell& cell, const std::vector<Mesh::Face>& faces) const {
    if (faces.size() > 2) return false;
    std::vector<std::uint32_t> others;  // what the one face lacks, or each of the two
    for (const std::uint32_t vertex : cell) {
      for (const Mesh::Face& face : faces)
        if (std::find(face.begin(), face.end(), vertex) == face.end()) others.push_back(vertex);
    }
    if (faces.size() == 1) return surface_[{others[0], others[0]}] == 0;
    return surface_[{std::min(others[0], others[1]), std::max(others[0], others[1])}] == 0;
  }

  void add(Mesh::Face face) {
    face = turned(face);
    const std::uint32_t apex = push_through(face);
    count(face, 1);
    faces_[face] = apex == kNone ? Cell{} : sorted(face, apex);
    if (apex == kNone) return;
    CellBehind& own = cells_[faces_[face]];
    own.radius = radius_of(faces_[face]);
    own.faces.push_back(face);
  }
  void remove(const Mesh::Face& face) {
    count(face, -1);
    auto& own = cells_[faces_[face]].faces;
    own.erase(std::find(own.begin(), own.end(), face));
    if (own.empty()) cells_.erase(faces_[face]);
    faces_.erase(face);
  }
  void count(const Mesh::Face& face, int by) {
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t a = face[i], b = face[(i + 1) % 3];
      surface_[{std::min(a, b), std::max(a, b)}] += by;
      surface_[{a, a}] += by;
    }
  }

  const std::vector<Vector>& points_;
  std::map<Mesh::Face, Cell> faces_;                                        ///< with what is behind
  std::map<Cell, CellBehind> cells_;                                        ///< behind faces
  mutable std::map<std::pair<std::uint32_t, std::uint32_t>, int> surface_;  ///< edges, and vertices as a, a
};

}  // namespace ray::test
