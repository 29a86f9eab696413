#pragma once
/// The triangulation of Delaunay in space: tetrahedra whose spheres hold no point. Built point by point, and
/// exact (`lattice_tests.h`), so it is the same whatever the order. Around it are tetrahedra with a vertex at
/// infinity, one on each face of the hull, so every face has one on both sides.

#include "lattice_tests.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace ray {

class Tetrahedra {
 public:
  using Index = std::uint32_t;
  struct Cell {
    std::array<Index, 4> vertices{};    ///< the last is in front of the others
    std::array<Index, 4> neighbours{};  ///< each beyond the face opposite the vertex of that place
  };
  /// Of the face opposite each place, the places of its vertices, anticlockwise as seen from there.
  static constexpr std::array<std::array<std::size_t, 3>, 4> kFaces{
      {{1, 3, 2}, {0, 2, 3}, {0, 3, 1}, {0, 1, 2}}};

  /// Of four points; nothing of them if all are in one plane (`cells()` is empty). Precondition: no two
  /// points are the same, and `points` stays.
  explicit Tetrahedra(std::span<const LatticePoint> points);

  /// Adds a point; one that is there stays. Quick if point `near`, which must be there, is near. About 3 µs.
  void insert(Index p, Index near);

  [[nodiscard]] bool has(Index p) const { return cell_of_[p] != kNone; }
  /// A cell of a point that is there.
  [[nodiscard]] Index cell_of(Index p) const { return cell_of_[p]; }
  [[nodiscard]] Index any_cell() const { return cell_of_[first_]; }

  /// Dead ones are among them.
  [[nodiscard]] std::size_t places() const { return cells_.size(); }
  [[nodiscard]] const Cell& cell(Index at) const { return cells_[at]; }
  [[nodiscard]] bool is_alive(Index at) const { return cells_[at].vertices[0] != cells_[at].vertices[1]; }
  [[nodiscard]] bool is_infinite(Index at) const { return cells_[at].vertices[3] == infinity(); }
  [[nodiscard]] Index infinity() const { return static_cast<Index>(points_.size()); }
  [[nodiscard]] const LatticePoint& point(Index p) const { return points_[p]; }
  [[nodiscard]] std::array<LatticePoint, 4> corners(Index at) const {
    const auto& [a, b, c, d] = cells_[at].vertices;
    return {points_[a], points_[b], points_[c], points_[d]};
  }

  /// A cell that the place is in or on, or an infinite one if it is outside of the hull. Quick if `from` is
  /// near. Thread-safe.
  [[nodiscard]] Index locate(const LatticePoint& place, Index from) const;

  /// Whether the cell would go if p were added. Thread-safe.
  [[nodiscard]] bool conflicts(Index at, Index p) const;

  /// For the cells that would go if p were added: `visit(cell)` until one says true, and whether one did.
  /// `region` holds them afterwards, first the one that p is in. `from` as above. Thread-safe.
  template <class Visit>
  bool any_in_conflict(Index p, Index from, std::vector<Index>& region, const Visit& visit) const {
    region.assign(1, locate(points_[p], from));
    for (std::size_t done = 0; done < region.size(); ++done) {
      if (visit(region[done])) return true;
      for (const Index other : cells_[region[done]].neighbours) {
        if (std::find(region.begin(), region.end(), other) == region.end() && conflicts(other, p))
          region.push_back(other);
      }
    }
    return false;
  }

  /// Places of the cells that the last insertion took and made; some may be the same.
  [[nodiscard]] std::span<const Index> removed() const { return removed_; }
  [[nodiscard]] std::span<const Index> created() const { return created_; }

  /// The last point before p that is there, or any.
  [[nodiscard]] Index near_point(Index p) const;

  /// `visit(cell)` for all cells around an edge of `at`, that of its vertices at places i and j; ends early
  /// with the first that says true, and says whether one did.
  template <class Visit>
  bool any_around_edge(Index at, std::size_t i, std::size_t j, const Visit& visit) const {
    const Index a = cells_[at].vertices[i], b = cells_[at].vertices[j];
    std::size_t next = 0;
    while (next == i || next == j)
      ++next;
    for (Index here = at, to = cells_[at].neighbours[next]; to != at;) {
      if (visit(to)) return true;
      // On to the face that has the edge and is not the one just passed.
      const Cell& cell = cells_[to];
      for (next = 0; cell.vertices[next] == a || cell.vertices[next] == b || cell.neighbours[next] == here;)
        ++next;
      here = to;
      to = cell.neighbours[next];
    }
    return visit(at);
  }

 private:
  static constexpr Index kNone = ~Index{0};
  struct OpenFace {
    Index beyond;                  ///< the cell that stays
    std::size_t place;             ///< of its neighbour that goes
    std::array<Index, 3> corners;  ///< anticlockwise as seen from the new point
  };
  struct OpenEdge {
    std::uint64_t key = 0;
    std::uint32_t stamp = 0;
    Index cell = 0;
    std::size_t place = 0;
  };

  [[nodiscard]] bool in_sphere(Index at, Index p) const {
    return side_of_sphere(corners(at), cells_[at].vertices, points_[p], p) > 0;
  }
  void begin(const std::array<Index, 4>& first);
  void remove_in_conflict(Index at, Index p);
  void fill(Index p);
  Index place_for_cell();
  void join_at_edge(Index u, Index v, Index cell, std::size_t place);

  std::span<const LatticePoint> points_;
  std::vector<Cell> cells_;
  std::vector<Index> cell_of_;  ///< one of the cells of each point
  Index first_ = 0;             ///< a point that is there
  std::vector<Index> free_;
  std::vector<std::uint32_t> seen_;  ///< 2 stamp + 1: in conflict with the point of that stamp
  std::uint32_t stamp_ = 0;
  std::vector<Index> removed_, created_;
  std::vector<OpenFace> open_faces_;
  std::vector<OpenEdge> open_edges_;  ///< a hash table
};

}  // namespace ray
