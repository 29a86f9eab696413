#include "walk.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>

namespace ray {

WalkMap::WalkMap(const Area& area, Floor floor, const WalkOptions& options)
    : area_(area),
      floor_(std::move(floor)),
      options_(options),
      columns_(static_cast<std::size_t>(std::ceil(area.size().x() / options.cell))),
      rows_(static_cast<std::size_t>(std::ceil(area.size().y() / options.cell))),
      blocked_(columns_ * rows_, 0) {
  for (Cell cell = 0; cell < blocked_.size(); ++cell) {
    const Eigen::Vector2d middle = middle_of(cell);
    const std::optional<double> height = floor_(middle.x(), middle.y());
    if (height)
      highest_floor_ = std::max(highest_floor_, *height);
    else
      blocked_[cell] = 1;
  }
  if (options.steepest < std::numeric_limits<double>::infinity()) block_slopes();
}

void WalkMap::block_slopes() {
  const auto height_beside = [&](Cell cell, double dx, double dy) {
    const Eigen::Vector2d place = middle_of(cell) + options_.cell / 2 * Eigen::Vector2d(dx, dy);
    return floor_(place.x(), place.y());
  };
  for (Cell cell = 0; cell < blocked_.size(); ++cell) {
    const std::optional<double> west = height_beside(cell, -1, 0);
    const std::optional<double> east = height_beside(cell, 1, 0);
    const std::optional<double> south = height_beside(cell, 0, -1);
    const std::optional<double> north = height_beside(cell, 0, 1);
    if (!west || !east || !south || !north ||
        Eigen::Vector2d(*east - *west, *north - *south).norm() > options_.steepest * options_.cell)
      blocked_[cell] = 1;
  }
}

WalkMap::Cell WalkMap::cell_of(const Eigen::Vector2d& place) const {
  const auto index = [&](double offset, std::size_t count) {
    return offset <= 0 ? std::size_t{0}
                       : std::min(static_cast<std::size_t>(offset / options_.cell), count - 1);
  };
  return index(place.y() - area_.low.y(), rows_) * columns_ + index(place.x() - area_.low.x(), columns_);
}

Eigen::Vector2d WalkMap::middle_of(Cell cell) const {
  return area_.low + options_.cell * Eigen::Vector2d(static_cast<double>(cell % columns_) + 0.5,
                                                     static_cast<double>(cell / columns_) + 0.5);
}

bool WalkMap::is_inside(const Eigen::Vector2d& place) const {
  return (place.array() >= area_.low.array()).all() && (place.array() <= area_.high.array()).all();
}

template <class Body>
void WalkMap::for_neighbours(Cell cell, const Body& body) const {
  for (int dy = -1; dy <= 1; ++dy) {
    for (int dx = -1; dx <= 1; ++dx) {
      const std::size_t column = cell % columns_ + static_cast<std::size_t>(dx);  // below 0 wraps far up
      const std::size_t row = cell / columns_ + static_cast<std::size_t>(dy);
      if (column < columns_ && row < rows_ && (dx != 0 || dy != 0))
        body(row * columns_ + column, dx != 0 && dy != 0);
    }
  }
}

void WalkMap::add_obstacle(const Mesh& mesh) {
  for (const auto& [a, b, c] : mesh.faces)
    sample(mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]);
}

void WalkMap::sample(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c) {
  if (std::min({a.z(), b.z(), c.z()}) > highest_floor_ + options_.body) return;
  const double longest =
      std::sqrt(std::max({(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()}));
  const int steps = 1 + static_cast<int>(2 * longest / options_.cell);
  for (int i = 0; i <= steps; ++i) {
    for (int j = 0; j <= steps - i; ++j) {
      const Eigen::Vector3d place = a + (b - a) * i / steps + (c - a) * j / steps;
      if (!is_inside(place.head<2>())) continue;
      const Cell cell = cell_of(place.head<2>());
      if (blocked_[cell] != 0) continue;
      const std::optional<double> floor = floor_(place.x(), place.y());
      if (floor && place.z() > *floor + options_.step && place.z() < *floor + options_.body)
        blocked_[cell] = 1;
    }
  }
}

void WalkMap::measure_clearance() {
  nearest_obstacle_.assign(blocked_.size(), options_.comfort);
  const auto reach = static_cast<std::ptrdiff_t>(options_.comfort / options_.cell);
  for (Cell cell = 0; cell < blocked_.size(); ++cell) {
    if (blocked_[cell] == 0) continue;
    const auto column = static_cast<std::ptrdiff_t>(cell % columns_);
    const auto row = static_cast<std::ptrdiff_t>(cell / columns_);
    for (std::ptrdiff_t j = std::max<std::ptrdiff_t>(0, row - reach);
         j <= std::min(row + reach, static_cast<std::ptrdiff_t>(rows_) - 1); ++j) {
      for (std::ptrdiff_t i = std::max<std::ptrdiff_t>(0, column - reach);
           i <= std::min(column + reach, static_cast<std::ptrdiff_t>(columns_) - 1); ++i) {
        const auto squared = static_cast<double>((i - column) * (i - column) + (j - row) * (j - row));
        double& nearest = nearest_obstacle_[static_cast<Cell>(j) * columns_ + static_cast<Cell>(i)];
        nearest = std::min(nearest, options_.cell * std::sqrt(squared));
      }
    }
  }
}

// What lies in pockets counts as not free.
void WalkMap::keep_largest_part() {
  constexpr std::size_t kUnseen = 0;
  std::vector<std::size_t> part_of(blocked_.size(), kUnseen);
  std::size_t parts = 0;
  std::size_t largest = 0;
  std::size_t largest_size = 0;
  for (Cell seed = 0; seed < part_of.size(); ++seed) {
    if (part_of[seed] != kUnseen || !is_free(seed)) continue;
    part_of[seed] = ++parts;
    std::vector<Cell> cells{seed};
    for (std::size_t i = 0; i < cells.size(); ++i) {
      for_neighbours(cells[i], [&](Cell next, bool) {
        if (part_of[next] != kUnseen || !is_free(next)) return;
        part_of[next] = parts;
        cells.push_back(next);
      });
    }
    if (cells.size() <= largest_size) continue;
    largest = parts;
    largest_size = cells.size();
  }
  for (Cell cell = 0; cell < part_of.size(); ++cell) {
    if (part_of[cell] != largest) nearest_obstacle_[cell] = 0.0;
  }
}

bool WalkMap::is_free(Cell cell) const {
  return nearest_obstacle_[cell] >= options_.clearance;
}

std::optional<WalkMap::Cell> WalkMap::nearest_free(const Eigen::Vector2d& place) const {
  std::optional<Cell> nearest;
  double nearest_squared = std::numeric_limits<double>::infinity();
  for (Cell cell = 0; cell < blocked_.size(); ++cell) {
    if (!is_free(cell)) continue;
    const double squared = (middle_of(cell) - place).squaredNorm();
    if (squared >= nearest_squared) continue;
    nearest_squared = squared;
    nearest = cell;
  }
  return nearest;
}

std::vector<WalkMap::Cell> WalkMap::shortest(Cell from, Cell to) const {
  constexpr auto kNever = std::numeric_limits<std::uint64_t>::max();
  std::vector<std::uint64_t> cost(blocked_.size(), kNever);
  std::vector<Cell> before(blocked_.size(), from);
  using Entry = std::pair<std::uint64_t, Cell>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
  cost[from] = 0;
  open.emplace(0, from);
  while (!open.empty()) {
    const std::uint64_t so_far = open.top().first;
    const Cell cell = open.top().second;
    open.pop();
    if (cell == to) break;
    if (so_far > cost[cell]) continue;
    for_neighbours(cell, [&](Cell next, bool is_diagonal) {
      if (!is_free(next)) return;
      // Whole numbers, so that equal ways are equal on every machine.
      const double nearness = 1 - nearest_obstacle_[next] / options_.comfort;
      const std::uint64_t total =
          so_far + (is_diagonal ? 141 : 100) + static_cast<std::uint64_t>(300 * nearness);
      if (total >= cost[next]) return;
      cost[next] = total;
      before[next] = cell;
      open.emplace(total, next);
    });
  }
  std::vector<Cell> way{to};
  while (way.back() != from)
    way.push_back(before[way.back()]);
  std::reverse(way.begin(), way.end());
  return way;
}

std::vector<Eigen::Vector2d> WalkMap::smoothed(const std::vector<Eigen::Vector2d>& way) const {
  const auto reach = static_cast<std::size_t>(options_.smoothing / (0.5 * options_.cell));
  std::vector<Eigen::Vector2d> result = way;
  for (std::size_t i = 0; i < way.size(); ++i) {
    const std::size_t width = std::min({reach, i, way.size() - 1 - i});
    for (std::size_t half = width; half > 0; half = half / 2) {  // as much as fits
      Eigen::Vector2d sum = Eigen::Vector2d::Zero();
      for (std::size_t j = i - half; j <= i + half; ++j)
        sum += way[j];
      result[i] = sum / static_cast<double>(2 * half + 1);
      if (is_free(cell_of(result[i]))) break;
      result[i] = way[i];
    }
  }
  return result;
}

std::vector<Eigen::Vector3d> WalkMap::route(const std::vector<Eigen::Vector2d>& goals) {
  measure_clearance();
  keep_largest_part();
  std::vector<Cell> cells;
  for (const Eigen::Vector2d& goal : goals) {
    const std::optional<Cell> place = nearest_free(goal);
    if (!place) return {};
    if (cells.empty()) {
      cells.push_back(*place);
      continue;
    }
    const std::vector<Cell> leg = shortest(cells.back(), *place);
    cells.insert(cells.end(), leg.begin() + 1, leg.end());
  }
  std::vector<Eigen::Vector2d> way;
  for (const Cell cell : cells) {
    if (!way.empty()) way.push_back((way.back() + middle_of(cell)) / 2);
    way.push_back(middle_of(cell));
  }
  std::vector<Eigen::Vector3d> route;
  for (const Eigen::Vector2d& place : smoothed(way)) {
    const std::optional<double> height = floor_(place.x(), place.y());
    if (height) route.emplace_back(place.x(), place.y(), *height);
  }
  return route;
}

}  // namespace ray
