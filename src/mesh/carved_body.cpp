#include "carved_body.h"

#include <raycloud/exec/parallel.h>
#include <raycloud/exec/random.h>

#include <algorithm>
#include <bit>

namespace ray {
namespace {

using Index = Tetrahedra::Index;

constexpr std::size_t kFirstRound = 500;  // points, about
constexpr std::size_t kChunk = 4096;      // points

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

/// The last point before p that is there, or any.
Index near_point(const Tetrahedra& cells, Index p) {
  for (Index q = p; q > 0; --q)
    if (cells.has(q - 1)) return q - 1;
  while (!cells.has(p))
    ++p;
  return p;
}

std::vector<std::uint8_t> cells_with_a_say(const Tetrahedra& cells, const std::vector<std::uint8_t>& outside,
                                           const std::vector<Index>& witnesses) {
  std::vector<std::uint8_t> say(cells.places(), 0);
  for (Index at = 0; at < say.size(); ++at) {
    if (outside[at] == 0) continue;
    say[at] = 1;
    for (const Index other : cells.cell(at).neighbours)
      say[other] = 1;
  }
  for (const Index at : witnesses)
    say[at] = 1;
  return say;
}

/// Of the points, in order, those that lie in the sphere of a marked cell.
std::vector<Index> in_spheres(const Context& context, const Tetrahedra& cells,
                              const std::vector<std::uint8_t>& marked, const std::vector<Index>& points) {
  using Found = std::vector<Index>;
  return parallel_reduce(
      context, points.size(), kChunk, Found{},
      [&](std::size_t begin, std::size_t end) {
        Found found;
        std::vector<Index> region;
        Index from = cells.cell_of(near_point(cells, points[begin]));
        for (std::size_t i = begin; i < end; ++i) {
          if (cells.any_in_conflict(points[i], from, region, [&](Index at) { return marked[at] != 0; }))
            found.push_back(points[i]);
          from = region.front();
        }
        return found;
      },
      [](Found all, const Found& more) {
        all.insert(all.end(), more.begin(), more.end());
        return all;
      });
}

void insert(const Context& context, Tetrahedra& cells, const std::vector<Index>& points) {
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (i % kChunk == 0) check_cancelled(context);
    cells.insert(points[i], i > 0 ? points[i - 1] : near_point(cells, points[i]));
  }
}

}  // namespace

CarvedBody carve_body(const Context& context, std::span<const LatticePoint> points,
                      double least_squared_radius, const FirstOutside& first_outside,
                      const FirstOutside& witnesses) {
  CarvedBody body{Tetrahedra(points), {}};
  Tetrahedra& cells = body.cells;
  const Rounds rounds(points.size());
  insert(context, cells, rounds.points_of(0, cells));
  for (int round = 1;; ++round) {
    body.outside = carve(cells, least_squared_radius, first_outside(cells));
    const bool in_rounds = round <= rounds.last();
    const std::vector<Index> next =
        in_spheres(context, cells, cells_with_a_say(cells, body.outside, witnesses(cells)),
                   in_rounds ? rounds.points_of(round, cells) : Rounds::all_that_remain(cells));
    if (!in_rounds && next.empty()) return body;
    insert(context, cells, next);
  }
}

}  // namespace ray
