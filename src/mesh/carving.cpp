#include "carving.h"

#include <algorithm>
#include <queue>
#include <tuple>

namespace ray {
namespace {

using Index = Tetrahedra::Index;

std::array<Index, 4> in_order(std::array<Index, 4> vertices) {
  std::sort(vertices.begin(), vertices.end());
  return vertices;
}

struct Candidate {
  double squared_radius;
  std::array<Index, 4> vertices;  ///< in order
  Index cell;
  bool operator<(const Candidate& other) const {
    return std::tie(squared_radius, vertices) < std::tie(other.squared_radius, other.vertices);
  }
};

class Carver {
 public:
  Carver(const Tetrahedra& cells, double least_squared_radius, const std::vector<Index>& outside);
  [[nodiscard]] std::vector<std::uint8_t> run();

 private:
  void join(Index at);
  void consider(Index at);
  [[nodiscard]] bool may_join(Index at) const;
  [[nodiscard]] bool is_outside(Index at) const { return outside_[at] != 0; }

  const Tetrahedra& cells_;
  double least_squared_radius_;
  std::vector<std::uint8_t> outside_;
  std::vector<std::uint8_t> on_surface_;  ///< by vertex
  std::priority_queue<Candidate> candidates_;
};

Carver::Carver(const Tetrahedra& cells, double least_squared_radius, const std::vector<Index>& outside)
    : cells_(cells),
      least_squared_radius_(least_squared_radius),
      outside_(cells.places(), 0),
      on_surface_(cells.infinity() + std::size_t{1}, 0) {
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
    if (may_join(at)) join(at);
  }
  return std::move(outside_);
}

bool Carver::may_join(Index at) const {
  if (is_outside(at) || cells_.is_infinite(at)) return false;
  const Tetrahedra::Cell& cell = cells_.cell(at);
  std::array<std::size_t, 4> open{};
  std::size_t count = 0;
  for (std::size_t i = 0; i < 4; ++i)
    if (is_outside(cell.neighbours[i])) open[count++] = i;
  if (count == 1) return on_surface_[cell.vertices[open[0]]] == 0;
  return count == 2 &&
         !cells_.any_around_edge(at, open[0], open[1], [&](Index other) { return is_outside(other); });
}

void Carver::consider(Index at) {
  if (!may_join(at)) return;
  const double squared_radius = squared_radius_of(cells_, at);
  if (squared_radius >= least_squared_radius_)
    candidates_.push({squared_radius, in_order(cells_.cell(at).vertices), at});
}

void Carver::join(Index at) {
  outside_[at] = 1;
  const Tetrahedra::Cell& cell = cells_.cell(at);
  std::array<std::size_t, 4> open{}, closed{};
  std::size_t opens = 0, closes = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    on_surface_[cell.vertices[i]] = 1;
    is_outside(cell.neighbours[i]) ? open[opens++] = i : closed[closes++] = i;
  }
  for (std::size_t i = 0; i < closes; ++i)
    consider(cell.neighbours[closed[i]]);
  // The edge of the two faces is not on the surface any more, so it keeps no cell from joining.
  if (opens == 2) {
    cells_.any_around_edge(at, closed[0], closed[1], [&](Index other) {
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
  return squared_radius({cells.point(a), cells.point(b), cells.point(c), cells.point(d)});
}

}  // namespace ray
