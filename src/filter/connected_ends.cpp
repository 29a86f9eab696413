#include "connected_ends.h"

#include <raycloud/core/bounds.h>
#include <raycloud/core/error.h>
#include <raycloud/exec/parallel.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <span>

namespace ray {
namespace {

using Points = std::span<Eigen::Vector3d>;

struct Cell {
  std::uint64_t key = 0;
  std::size_t begin = 0;     ///< its first point, in the order of the cells
  std::size_t earliest = 0;  ///< its first point, in the order of the source
};

Bounds bounds_of(Points points) {
  Bounds bounds;
  for (const Eigen::Vector3d& point : points)
    bounds.add(point);
  return bounds;
}

/// Whether a point of `a` is nearer than `gap` to one of `b`: the larger set is halved until the boxes
/// decide. Reorders the points.
bool any_nearer(Points a, Points b, double gap) {
  if (a.size() < b.size()) std::swap(a, b);
  const Bounds box_a = bounds_of(a), box_b = bounds_of(b);
  const auto apart = (box_a.min - box_b.max).cwiseMax(box_b.min - box_a.max);
  if (!(apart.cwiseMax(0.0).norm() < gap)) return false;
  if (a.size() == 1) return true;  // and so is b: the boxes are the points
  const auto across = (box_a.max - box_b.min).cwiseMax(box_b.max - box_a.min);
  if (across.norm() < gap) return true;
  Eigen::Index axis = 0;
  box_a.extent().maxCoeff(&axis);
  const auto middle = a.begin() + static_cast<std::ptrdiff_t>(a.size() / 2);
  std::nth_element(a.begin(), middle, a.end(),
                   [axis](const Eigen::Vector3d& p, const Eigen::Vector3d& q) { return p[axis] < q[axis]; });
  return any_nearer({a.begin(), middle}, b, gap) || any_nearer({middle, a.end()}, b, gap);
}

/// Disjoint sets with path halving; the smaller number becomes the root.
class Sets {
 public:
  explicit Sets(std::size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), 0); }
  std::size_t root(std::size_t i) {
    while (parent_[i] != i)
      i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(std::size_t a, std::size_t b) {
    const auto [low, high] = std::minmax({root(a), root(b)});
    parent_[high] = low;
  }

 private:
  std::vector<std::size_t> parent_;
};

CellGrid grid_for(const std::vector<Eigen::Vector3d>& points, double gap) {
  Bounds bounds;
  for (const Eigen::Vector3d& point : points)
    bounds.add(point);
  // A hair less than gap / sqrt(3), for the rounding of the division. One cell of margin below, so that the
  // neighbours of the first have keys too.
  const double width = gap / std::sqrt(3.0) * (1.0 - 1e-6);
  if (!(bounds.extent().maxCoeff() / width < static_cast<double>(CellGrid::kMost - 8))) {
    throw Error(ErrorCode::out_of_range,
                "the cloud is too large for so small a gap: at most " +
                    std::to_string(static_cast<double>(CellGrid::kMost) * width / 1000.0) + " km across");
  }
  return {(bounds.empty() ? Eigen::Vector3d::Zero() : bounds.min) - Eigen::Vector3d::Constant(4.0 * width),
          width};
}

/// Brings the points into the order of their cells.
std::vector<Cell> sort_into_cells(const Context& context, const CellGrid& grid,
                                  std::vector<Eigen::Vector3d>& points) {
  struct Entry {
    std::uint64_t key = 0;
    std::size_t index = 0;
  };
  std::vector<Entry> order(points.size());
  parallel_for(context, points.size(), 1 << 16, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      order[i] = {*grid.key(points[i]), i};
  });
  parallel_sort(context, order.begin(), order.end(),
                [](const Entry& a, const Entry& b) { return a.key < b.key; });
  std::vector<Eigen::Vector3d> sorted(points.size());
  std::vector<Cell> cells;
  for (std::size_t i = 0; i < order.size(); ++i) {
    if (i == 0 || order[i].key != order[i - 1].key) cells.push_back({order[i].key, i, order[i].index});
    sorted[i] = points[order[i].index];
  }
  points = std::move(sorted);
  return cells;
}

/// Calls `join(a, b)` for each pair of cells that are near enough to hold points nearer than the gap. Cells
/// with the same x and y are neighbours in the list, and as one goes through it, so do those of each
/// neighbouring column.
template <class Join>
void each_neighbour(const std::vector<Cell>& cells, const Join& join) {
  struct Column {
    std::int64_t offset;  ///< of the key
    std::int64_t reach;   ///< in z, for cells that may be near enough
    std::size_t cursor;
  };
  constexpr std::int64_t kX = std::int64_t{1} << (2 * CellGrid::kBits);
  constexpr std::int64_t kY = std::int64_t{1} << CellGrid::kBits;
  std::vector<Column> columns;
  for (std::int64_t x = 0; x <= 2; ++x) {
    for (std::int64_t y = x == 0 ? 0 : -2; y <= 2; ++y) {
      // Cells two apart leave a cell's width between them: three of those are a gap.
      const bool far = x == 2 && std::abs(y) == 2;
      columns.push_back({x * kX + y * kY, far ? 1 : 2, 0});
    }
  }
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const auto key = static_cast<std::int64_t>(cells[i].key);
    for (Column& column : columns) {
      const std::int64_t first = key + column.offset - column.reach;
      const std::int64_t last = key + column.offset + column.reach;
      const auto key_at = [&](std::size_t c) { return static_cast<std::int64_t>(cells[c].key); };
      while (column.cursor < cells.size() && key_at(column.cursor) < first)
        ++column.cursor;
      for (std::size_t c = column.cursor; c < cells.size() && key_at(c) <= last; ++c) {
        if (c > i) join(i, c);
      }
    }
  }
}

}  // namespace

ConnectedCells largest_connected_set(const Context& context, std::vector<Eigen::Vector3d> points,
                                     double gap) {
  const CellGrid grid = grid_for(points, gap);
  const std::vector<Cell> cells = sort_into_cells(context, grid, points);
  const auto end_of = [&](std::size_t c) {
    return c + 1 < cells.size() ? cells[c + 1].begin : points.size();
  };
  const auto points_of = [&](std::size_t c) {
    return Points(points).subspan(cells[c].begin, end_of(c) - cells[c].begin);
  };
  Sets sets(cells.size());
  std::size_t passed = 0;
  each_neighbour(cells, [&](std::size_t a, std::size_t b) {
    if (a - passed > 4096) {
      check_cancelled(context);
      passed = a;
    }
    if (sets.root(a) != sets.root(b) && any_nearer(points_of(a), points_of(b), gap)) sets.join(a, b);
  });

  struct Size {
    std::size_t points = 0;
    std::size_t earliest = ~std::size_t{0};
  };
  std::vector<Size> sizes(cells.size());
  for (std::size_t c = 0; c < cells.size(); ++c) {
    Size& size = sizes[sets.root(c)];
    size.points += end_of(c) - cells[c].begin;
    size.earliest = std::min(size.earliest, cells[c].earliest);
  }
  const auto largest = std::max_element(sizes.begin(), sizes.end(), [](const Size& a, const Size& b) {
    return a.points != b.points ? a.points < b.points : a.earliest > b.earliest;
  });
  ConnectedCells set{grid, {}};
  for (std::size_t c = 0; c < cells.size(); ++c) {
    if (sets.root(c) == static_cast<std::size_t>(largest - sizes.begin())) set.keys.push_back(cells[c].key);
  }
  return set;
}

}  // namespace ray
