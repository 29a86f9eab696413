#pragma once
/// Square cells over a rectangle of the map.

#include <Eigen/Core>
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>

namespace ray {

struct PlanRaster {
  Eigen::Vector2d low = Eigen::Vector2d::Zero();  ///< m; the corner of cell 0, 0
  double width = 1.0;                             ///< m
  std::int64_t columns = 1;
  std::int64_t rows = 1;

  [[nodiscard]] std::size_t size() const { return static_cast<std::size_t>(columns * rows); }
  [[nodiscard]] std::size_t index(std::int64_t column, std::int64_t row) const {
    return static_cast<std::size_t>(row * columns + column);
  }
  /// The cell of a place; nothing beyond the raster.
  [[nodiscard]] std::optional<std::size_t> find(double x, double y) const {
    const double column = (x - low.x()) / width;
    const double row = (y - low.y()) / width;
    if (!(column >= 0.0 && row >= 0.0)) return std::nullopt;
    if (!(column < static_cast<double>(columns) && row < static_cast<double>(rows))) return std::nullopt;
    return index(static_cast<std::int64_t>(column), static_cast<std::int64_t>(row));
  }
  [[nodiscard]] Eigen::Vector2d centre(std::size_t cell) const {
    const auto row = static_cast<std::int64_t>(cell) / columns;
    const auto column = static_cast<std::int64_t>(cell) % columns;
    return low + width * Eigen::Vector2d(static_cast<double>(column) + 0.5, static_cast<double>(row) + 0.5);
  }
  /// Calls `visit(cell)` for the cell and the up to eight around it, or more `rings`.
  template <class Visit>
  void around(std::size_t cell, const Visit& visit, std::int64_t rings = 1) const {
    const auto row = static_cast<std::int64_t>(cell) / columns;
    const auto column = static_cast<std::int64_t>(cell) % columns;
    for (std::int64_t r = std::max<std::int64_t>(row - rings, 0); r <= std::min(row + rings, rows - 1); ++r) {
      for (std::int64_t c = std::max<std::int64_t>(column - rings, 0);
           c <= std::min(column + rings, columns - 1); ++c)
        visit(index(c, r));
    }
  }
};

}  // namespace ray
