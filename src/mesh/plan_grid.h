#pragma once
/// A grid over the plan that lists what lies in each cell.

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace ray {

/// A triangle of the plan, or a line with its last corner twice.
using PlanShape = std::array<Eigen::Vector2d, 3>;

class PlanGrid {
 public:
  /// Lists item `i` in every cell that `shapes[i]` touches. About as many cells as items. Precondition: at
  /// least one shape, all finite.
  explicit PlanGrid(const std::vector<PlanShape>& shapes) {
    low_ = shapes.front()[0];
    Eigen::Vector2d high = low_;
    for (const PlanShape& shape : shapes) {
      for (const Eigen::Vector2d& corner : shape) {
        low_ = low_.cwiseMin(corner);
        high = high.cwiseMax(corner);
      }
    }
    const Eigen::Vector2d size = (high - low_).cwiseMax(1e-9 * (1.0 + high.cwiseAbs().maxCoeff()));
    const double count = std::max(1.0, static_cast<double>(shapes.size()));
    // Neither side may have more than 16 times its share, else a line of items would take millions of cells.
    width_ = std::max(std::sqrt(size.x() * size.y() / count), size.maxCoeff() / (16.0 * count));
    for (int axis = 0; axis < 2; ++axis)
      cells_[axis] = static_cast<std::int64_t>(size[axis] / width_) + 1;
    begins_.assign(static_cast<std::size_t>(cells_[0] * cells_[1]) + 1, 0);
    for (const PlanShape& shape : shapes)
      for_cells(shape, [&](std::size_t cell) { ++begins_[cell + 1]; });
    for (std::size_t cell = 1; cell < begins_.size(); ++cell)
      begins_[cell] += begins_[cell - 1];
    items_.resize(begins_.back());
    std::vector<std::size_t> next(begins_.begin(), begins_.end() - 1);
    for (std::size_t i = 0; i < shapes.size(); ++i)
      for_cells(shapes[i], [&](std::size_t cell) { items_[next[cell]++] = static_cast<std::uint32_t>(i); });
  }

  /// What lies in the cell of the place; nothing beyond the grid.
  [[nodiscard]] std::span<const std::uint32_t> at(const Eigen::Vector2d& place) const {
    const Eigen::Vector2d cell = (place - low_) / width_;
    if (!(cell.x() >= 0.0 && cell.y() >= 0.0)) return {};
    if (!(cell.x() < static_cast<double>(cells_[0]) && cell.y() < static_cast<double>(cells_[1]))) return {};
    return cell_items(static_cast<std::int64_t>(cell.x()), static_cast<std::int64_t>(cell.y()));
  }

  /// Calls `squared(item)`, which returns a squared distance, for items around the place until no other can
  /// be nearer than the least of them.
  template <class Squared>
  void search(const Eigen::Vector2d& place, const Squared& squared) const {
    const Eigen::Vector2d extent(static_cast<double>(cells_[0]), static_cast<double>(cells_[1]));
    const Eigen::Vector2d inside = place.cwiseMax(low_).cwiseMin(low_ + width_ * extent);
    const double away = (place - inside).squaredNorm();
    const std::int64_t x = index(inside.x(), 0);
    const std::int64_t y = index(inside.y(), 1);
    double best = std::numeric_limits<double>::infinity();
    const auto look = [&](std::int64_t column, std::int64_t row) {
      if (column < 0 || row < 0 || column >= cells_[0] || row >= cells_[1]) return;
      for (const std::uint32_t item : cell_items(column, row))
        best = std::min(best, squared(item));
    };
    const std::int64_t rings = std::max(cells_[0], cells_[1]);
    for (std::int64_t ring = 0; ring <= rings; ++ring) {
      // What lies in the ring is this far from `inside`, and by the projection onto a convex set no nearer
      // to `place` than the hypotenuse.
      const double gap = static_cast<double>(std::max<std::int64_t>(ring - 1, 0)) * width_;
      if (away + gap * gap > best) return;
      for (std::int64_t column = x - ring; column <= x + ring; ++column) {
        if (std::abs(column - x) == ring) {
          for (std::int64_t row = y - ring; row <= y + ring; ++row)
            look(column, row);
        } else {
          look(column, y - ring);
          look(column, y + ring);
        }
      }
    }
  }

 private:
  [[nodiscard]] std::int64_t index(double coordinate, int axis) const {
    const auto cell = static_cast<std::int64_t>((coordinate - low_[axis]) / width_);
    return std::clamp<std::int64_t>(cell, 0, cells_[axis] - 1);
  }
  [[nodiscard]] std::span<const std::uint32_t> cell_items(std::int64_t column, std::int64_t row) const {
    const auto cell = static_cast<std::size_t>(row * cells_[0] + column);
    return std::span(items_).subspan(begins_[cell], begins_[cell + 1] - begins_[cell]);
  }
  template <class Visit>
  void for_cells(const PlanShape& shape, const Visit& visit) const {
    const Eigen::Vector2d low = shape[0].cwiseMin(shape[1]).cwiseMin(shape[2]);
    const Eigen::Vector2d high = shape[0].cwiseMax(shape[1]).cwiseMax(shape[2]);
    for (std::int64_t row = index(low.y(), 1); row <= index(high.y(), 1); ++row) {
      for (std::int64_t column = index(low.x(), 0); column <= index(high.x(), 0); ++column)
        if (touches(shape, column, row)) visit(static_cast<std::size_t>(row * cells_[0] + column));
    }
  }

  /// False only if a side of the shape parts it from the cell: the box around a needle has many cells that
  /// the needle itself is far from.
  [[nodiscard]] bool touches(const PlanShape& shape, std::int64_t column, std::int64_t row) const {
    const Eigen::Vector2d middle =
        low_ + width_ * Eigen::Vector2d(static_cast<double>(column) + 0.5, static_cast<double>(row) + 0.5);
    for (std::size_t i = 0; i < 3; ++i) {
      const Eigen::Vector2d along = shape[(i + 1) % 3] - shape[i];
      const Eigen::Vector2d across(-along.y(), along.x());
      const double reach = 0.5001 * width_ * across.cwiseAbs().sum();
      const double cell = across.dot(middle - shape[i]);
      const double third = across.dot(shape[(i + 2) % 3] - shape[i]);
      const bool parted = (cell > reach && third <= 0.0) || (cell < -reach && third >= 0.0);
      if (parted) return false;
    }
    return true;
  }

  Eigen::Vector2d low_;
  double width_ = 1.0;
  std::int64_t cells_[2] = {1, 1};
  std::vector<std::size_t> begins_;
  std::vector<std::uint32_t> items_;
};

}  // namespace ray
