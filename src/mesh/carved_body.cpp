#include "carved_body.h"

#include "points_in_spheres.h"
#include "reach.h"

#include <raycloud/exec/random.h>

#include <algorithm>
#include <bit>

namespace ray {
namespace {

using Index = Tetrahedra::Index;
using Cells = std::vector<Index>;

constexpr std::size_t kFirstRound = 500;  // points, about

/// Numbers of the points that are not there yet, by round.
class Rounds {
 public:
  explicit Rounds(std::size_t points) : points_(points) {
    while (points >> (2 * last_) > kFirstRound)
      ++last_;
  }
  [[nodiscard]] int last() const { return last_; }
  [[nodiscard]] std::vector<Index> points_of(int round, const Tetrahedra& cells) const {
    std::vector<Index> found;
    for (Index p = 0; p < points_; ++p) {
      const int late = std::countl_zero(random_.bits(p) | 1) / 2;  // a quarter comes before the last round
      if (std::max(0, last_ - late) == round && !cells.has(p)) found.push_back(p);
    }
    return found;
  }
  static std::vector<Index> all_that_remain(const Tetrahedra& cells) {
    std::vector<Index> found;
    for (Index p = 0; p < cells.infinity(); ++p)
      if (!cells.has(p)) found.push_back(p);
    return found;
  }

 private:
  std::size_t points_;
  int last_ = 0;
  RandomStream random_{1, "rounds of points in space"};
};

void insert(const Context& context, Tetrahedra& cells, const Cells& points) {
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (i % 4096 == 0) check_cancelled(context);
    cells.insert(points[i], i > 0 ? points[i - 1] : cells.near_point(points[i]));
  }
}

/// The same, and all places whose cells change, some several times.
Cells places_changed_by(const Cells& points, Tetrahedra& cells) {
  Cells changed;
  for (const Index p : points) {
    cells.insert(p, cells.near_point(p));
    changed.insert(changed.end(), cells.removed().begin(), cells.removed().end());
    changed.insert(changed.end(), cells.created().begin(), cells.created().end());
  }
  return changed;
}

void mark(std::vector<std::uint8_t>& marks, const Cells& cells) {
  for (const Index at : cells)
    marks[at] = 1;
}

Cells marked(const std::vector<std::uint8_t>& marks) {
  Cells cells;
  for (Index at = 0; at < marks.size(); ++at)
    if (marks[at] != 0) cells.push_back(at);
  return cells;
}

}  // namespace

CarvedBody carve_body(const Context& context, std::span<const LatticePoint> points,
                      double least_squared_radius, const FirstOutside& first_outside,
                      const FirstOutside& witnesses) {
  CarvedBody body{Tetrahedra(points), {}};
  Tetrahedra& cells = body.cells;
  const auto with_a_say = [&](Reach& reach) {
    reach.extend(first_outside(cells));
    std::vector<std::uint8_t> say = reach.with_neighbours();
    mark(say, witnesses(cells));
    return say;
  };
  const Rounds rounds(points.size());
  insert(context, cells, rounds.points_of(0, cells));
  for (int round = 1; round <= rounds.last(); ++round) {
    Reach reach(context, cells, least_squared_radius);
    insert(context, cells,
           points_in_spheres(context, cells, marked(with_a_say(reach)), rounds.points_of(round, cells)));
  }
  // Those of the rounds before that have a say only now, until no point lies in a sphere.
  Reach reach(context, cells, least_squared_radius);
  std::vector<std::uint8_t> asked;
  while (true) {
    std::vector<std::uint8_t> say = with_a_say(reach);
    asked.resize(say.size(), 0);
    for (std::size_t at = 0; at < say.size(); ++at) {
      if (asked[at] != 0) say[at] = 0;
      asked[at] |= say[at];
    }
    const Cells next = points_in_spheres(context, cells, marked(say), Rounds::all_that_remain(cells));
    if (next.empty()) break;
    const Cells changed = places_changed_by(next, cells);
    asked.resize(cells.places(), 0);
    for (const Index at : changed)
      asked[at] = 0;
    reach.renew(changed);
  }
  body.outside = carve(cells, least_squared_radius, first_outside(cells));
  return body;
}

}  // namespace ray
