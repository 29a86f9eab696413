#include "carving.h"

#include <algorithm>
#include <queue>

namespace ray {
namespace {

using Index = Tetrahedra::Index;

std::array<Index, 4> in_order(std::array<Index, 4> vertices) {
  std::sort(vertices.begin(), vertices.end());
  return vertices;
}

struct Candidate {
  double squared_radius;
  Index cell;
};

/// Of cells with the same radius the one with the largest vertices goes first.
struct GoesLater {
  const Tetrahedra& cells;
  bool operator()(const Candidate& a, const Candidate& b) const {
    if (a.squared_radius != b.squared_radius) return a.squared_radius < b.squared_radius;
    return in_order(cells.cell(a.cell).vertices) < in_order(cells.cell(b.cell).vertices);
  }
};

class Carver {
 public:
  Carver(const Tetrahedra& cells, double least_squared_radius, const std::vector<Index>& outside);
  [[nodiscard]] std::vector<std::uint8_t> run();

 private:
  /// Places of a cell's neighbours that are outside, and of the others.
  struct Sides {
    std::array<std::size_t, 4> open{}, closed{};
    std::size_t opens = 0;
  };
  [[nodiscard]] Sides sides_of(Index at) const;
  void join(Index at);
  void consider(Index at);
  /// But for the sixth edge.
  [[nodiscard]] bool may_join_nearly(Index at, const Sides& sides) const;
  [[nodiscard]] bool may_join(Index at) const;
  [[nodiscard]] bool is_outside(Index at) const { return outside_[at] != 0; }

  const Tetrahedra& cells_;
  double least_squared_radius_;
  std::vector<std::uint8_t> outside_;
  std::vector<std::uint8_t> on_surface_;  ///< by vertex
  std::vector<std::uint8_t> is_waiting_;  ///< among the candidates, or too small for ever
  std::priority_queue<Candidate, std::vector<Candidate>, GoesLater> candidates_;
};

Carver::Carver(const Tetrahedra& cells, double least_squared_radius, const std::vector<Index>& outside)
    : cells_(cells),
      least_squared_radius_(least_squared_radius),
      outside_(cells.places(), 0),
      on_surface_(cells.infinity() + std::size_t{1}, 0),
      is_waiting_(cells.places(), 0),
      candidates_(GoesLater{cells}) {
  for (const Index at : outside) {
    outside_[at] = 1;
    for (const Index vertex : cells.cell(at).vertices)
      on_surface_[vertex] = 1;
  }
  for (const Index at : outside) {
    for (const Index other : cells.cell(at).neighbours)
      consider(other);
  }
}

std::vector<std::uint8_t> Carver::run() {
  while (!candidates_.empty()) {
    const Index at = candidates_.top().cell;
    candidates_.pop();
    is_waiting_[at] = 0;
    if (may_join(at)) join(at);
  }
  return std::move(outside_);
}

Carver::Sides Carver::sides_of(Index at) const {
  Sides sides;
  std::size_t closes = 0;
  for (std::size_t i = 0; i < 4; ++i)
    is_outside(cells_.cell(at).neighbours[i]) ? sides.open[sides.opens++] = i : sides.closed[closes++] = i;
  return sides;
}

bool Carver::may_join_nearly(Index at, const Sides& sides) const {
  if (is_outside(at) || cells_.is_infinite(at)) return false;
  return sides.opens == 2 || (sides.opens == 1 && on_surface_[cells_.cell(at).vertices[sides.open[0]]] == 0);
}

bool Carver::may_join(Index at) const {
  const Sides sides = sides_of(at);
  if (!may_join_nearly(at, sides)) return false;
  return sides.opens == 1 || !cells_.any_around_edge(at, sides.open[0], sides.open[1],
                                                     [&](Index other) { return is_outside(other); });
}

void Carver::consider(Index at) {
  if (is_waiting_[at] != 0 || !may_join_nearly(at, sides_of(at))) return;
  is_waiting_[at] = 1;
  const double squared_radius = squared_radius_of(cells_, at);
  if (squared_radius >= least_squared_radius_) candidates_.push({squared_radius, at});
}

void Carver::join(Index at) {
  const Sides sides = sides_of(at);
  const Tetrahedra::Cell& cell = cells_.cell(at);
  outside_[at] = 1;
  for (const Index vertex : cell.vertices)
    on_surface_[vertex] = 1;
  for (std::size_t i = 0; i < 4 - sides.opens; ++i)
    consider(cell.neighbours[sides.closed[i]]);
  // The edge of the two faces is not on the surface any more, so it keeps no cell from joining.
  if (sides.opens == 2) {
    cells_.any_around_edge(at, sides.closed[0], sides.closed[1], [&](Index other) {
      consider(other);
      return false;
    });
  }
}

}  // namespace

std::vector<std::uint8_t> carve(const Tetrahedra& cells, double least_squared_radius,
                                const std::vector<Index>& outside) {
  return Carver(cells, least_squared_radius, outside).run();
}

double squared_radius_of(const Tetrahedra& cells, Index at) {
  const auto [a, b, c, d] = in_order(cells.cell(at).vertices);
  return sphere_of({cells.point(a), cells.point(b), cells.point(c), cells.point(d)}).squared_radius;
}

}  // namespace ray
