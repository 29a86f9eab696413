#include "tetrahedra.h"

namespace ray {
namespace {

/// Four points that are not in a plane, or fewer.
std::vector<std::uint32_t> four_corners(std::span<const LatticePoint> points) {
  std::vector<std::uint32_t> found;
  const auto on_line = [&](std::uint32_t i) {
    const LatticePoint &a = points[found[0]], &b = points[found[1]], &c = points[i];
    __extension__ using Wide = __int128;
    for (std::size_t x = 0; x < 3; ++x) {
      const std::size_t y = (x + 1) % 3;
      if (Wide{b[x] - a[x]} * (c[y] - a[y]) != Wide{b[y] - a[y]} * (c[x] - a[x])) return false;
    }
    return true;
  };
  for (std::uint32_t i = 0; i < points.size() && found.size() < 4; ++i) {
    if (found.size() < 2) {
      found.push_back(i);
    } else if (found.size() == 2) {
      if (!on_line(i)) found.push_back(i);
    } else {
      const int side = side_of_plane(points[found[0]], points[found[1]], points[found[2]], points[i]);
      if (side == 0) continue;
      if (side < 0) std::swap(found[0], found[1]);
      found.push_back(i);
    }
  }
  return found;
}

}  // namespace

Tetrahedra::Tetrahedra(std::span<const LatticePoint> points)
    : points_(points), cell_of_(points.size() + 1, kNone), open_edges_(64) {
  const std::vector<Index> first = four_corners(points);
  if (first.size() == 4) begin({first[0], first[1], first[2], first[3]});
}

void Tetrahedra::begin(const std::array<Index, 4>& first) {
  first_ = first[0];
  cells_.resize(5);
  seen_.resize(5, 0);
  cells_[0].vertices = first;
  cells_[0].neighbours = {1, 2, 3, 4};
  for (std::size_t i = 0; i < 4; ++i) {
    // Of the face's other side: clockwise as seen from the fourth.
    const auto& [x, y, z] = kFaces[i];
    Cell& outer = cells_[i + 1];
    outer.vertices = {first[y], first[x], first[z], infinity()};
    const auto beyond = [](std::size_t place) { return static_cast<Index>(place + 1); };
    outer.neighbours = {beyond(y), beyond(x), beyond(z), 0};
    cell_of_[first[i]] = 0;
  }
}

Tetrahedra::Index Tetrahedra::locate(const LatticePoint& place, Index from) const {
  Index at = from;
  if (is_infinite(at)) at = cells_[at].neighbours[3];
  from = at;
  while (true) {
    const Cell& cell = cells_[at];
    Index next = at;
    for (std::size_t i = 0; i < 4; ++i) {
      if (cell.neighbours[i] == from && from != at) continue;
      const auto& [x, y, z] = kFaces[i];
      if (side_of_plane(points_[cell.vertices[x]], points_[cell.vertices[y]], points_[cell.vertices[z]],
                        place) < 0) {
        next = cell.neighbours[i];
        break;
      }
    }
    if (next == at || is_infinite(next)) return next;
    from = at;
    at = next;
  }
}

bool Tetrahedra::conflicts(Index at, Index p) const {
  if (!is_infinite(at)) return in_sphere(at, p);
  const auto& [a, b, c, d] = cells_[at].vertices;
  const int side = side_of_plane(points_[a], points_[b], points_[c], points_[p]);
  // In the plane of the hull's face, the circle decides, and that is one with the sphere behind the face.
  return side != 0 ? side > 0 : in_sphere(cells_[at].neighbours[3], p);
}

Tetrahedra::Index Tetrahedra::near_point(Index p) const {
  for (Index q = p; q > 0; --q)
    if (has(q - 1)) return q - 1;
  return first_;
}

void Tetrahedra::insert(Index p, Index near) {
  removed_.clear();
  created_.clear();
  if (has(p)) return;
  remove_in_conflict(locate(points_[p], cell_of_[near]), p);
  fill(p);
}

void Tetrahedra::remove_in_conflict(Index at, Index p) {
  if (++stamp_ == std::uint32_t{1} << 31) {
    std::fill(seen_.begin(), seen_.end(), 0);
    std::fill(open_edges_.begin(), open_edges_.end(), OpenEdge{});
    stamp_ = 1;
  }
  removed_.assign(1, at);
  open_faces_.clear();
  seen_[at] = 2 * stamp_ + 1;
  for (std::size_t done = 0; done < removed_.size(); ++done) {
    const Index own = removed_[done];
    for (std::size_t i = 0; i < 4; ++i) {
      const Index other = cells_[own].neighbours[i];
      if (seen_[other] < 2 * stamp_) {
        seen_[other] = 2 * stamp_ + (conflicts(other, p) ? 1 : 0);
        if (seen_[other] % 2 == 1) removed_.push_back(other);
      }
      if (seen_[other] % 2 == 1) continue;
      const auto& vertices = cells_[own].vertices;
      const auto& [x, y, z] = kFaces[i];
      std::size_t place = 0;
      while (cells_[other].neighbours[place] != own)
        ++place;
      open_faces_.push_back({other, place, {vertices[x], vertices[y], vertices[z]}});
    }
  }
}

Tetrahedra::Index Tetrahedra::place_for_cell() {
  if (free_.empty()) {
    cells_.emplace_back();
    seen_.push_back(0);
    return static_cast<Index>(cells_.size() - 1);
  }
  const Index place = free_.back();
  free_.pop_back();
  return place;
}

void Tetrahedra::fill(Index p) {
  for (const Index at : removed_)
    cells_[at].vertices[1] = cells_[at].vertices[0];
  free_.insert(free_.end(), removed_.begin(), removed_.end());
  if (open_edges_.size() < 8 * open_faces_.size()) {
    std::size_t size = open_edges_.size();
    while (size < 8 * open_faces_.size())
      size *= 2;
    open_edges_.assign(size, {});
  }
  for (const OpenFace& open : open_faces_) {
    const Index place = place_for_cell();
    created_.push_back(place);
    Cell& cell = cells_[place];
    cell.vertices = {open.corners[0], open.corners[1], open.corners[2], p};
    std::size_t own = 3;
    for (std::size_t i = 0; i < 3; ++i) {
      if (cell.vertices[i] != infinity()) continue;
      std::swap(cell.vertices[i], cell.vertices[3]);
      std::swap(cell.vertices[(i + 1) % 3], cell.vertices[(i + 2) % 3]);
      own = i;
      break;
    }
    cell.neighbours[own] = open.beyond;
    cells_[open.beyond].neighbours[open.place] = place;
    for (std::size_t i = 0; i < 4; ++i) {
      if (i == own) continue;
      if (cell.vertices[i] != infinity()) cell_of_[cell.vertices[i]] = place;
      // The face opposite place i has p and two others.
      std::array<Index, 2> edge{};
      std::size_t found = 0;
      for (std::size_t j = 0; j < 4; ++j)
        if (j != i && j != own) edge[found++] = cell.vertices[j];
      join_at_edge(edge[0], edge[1], place, i);
    }
    cell_of_[p] = place;
  }
}

void Tetrahedra::join_at_edge(Index u, Index v, Index cell, std::size_t place) {
  const std::uint64_t key = std::uint64_t{std::min(u, v)} << 32 | std::max(u, v);
  const std::size_t mask = open_edges_.size() - 1;
  for (std::size_t at = key * 0x9E3779B97F4A7C15u >> 40 & mask;; at = (at + 1) & mask) {
    OpenEdge& edge = open_edges_[at];
    if (edge.stamp != stamp_) {
      edge = {key, stamp_, cell, place};
      return;
    }
    if (edge.key != key) continue;
    cells_[cell].neighbours[place] = edge.cell;
    cells_[edge.cell].neighbours[edge.place] = cell;
    return;
  }
}

}  // namespace ray
