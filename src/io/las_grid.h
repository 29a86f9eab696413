#pragma once
/// The steps in which LAS stores coordinates: 32-bit integers times a scale plus an offset.

#include <raycloud/core/bounds.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <functional>

namespace ray {

struct LasAxis {
  double scale = 0.0001;
  double offset = 0.0;

  /// The integer nearest to `value`, as a double that may be beyond 32 bits.
  [[nodiscard]] double steps(double value) const { return std::nearbyint((value - offset) / scale); }
  [[nodiscard]] std::int32_t stored(double value) const { return static_cast<std::int32_t>(steps(value)); }
  [[nodiscard]] double restored(std::int32_t stored) const { return stored * scale + offset; }
  /// `value` is a whole number of steps, but for rounding.
  [[nodiscard]] bool on_grid(double value) const;
  /// 32 bits hold both ends.
  [[nodiscard]] bool holds(double min, double max) const;
};

using LasGrid = std::array<LasAxis, 3>;

/// True if every coordinate of that axis is on the grid.
using OnGrid = std::function<bool(std::size_t axis, const LasAxis& candidate)>;

/// For each axis the source's own `step` (0: unknown) if all coordinates are on such a grid, of which
/// `sample` is a point; else 0.0001, or `step` where that is finer; coarser in steps of 1, 2, 5 as far as 32
/// bits demand. The offset is a whole number of metres near the middle where that fits.
[[nodiscard]] LasGrid choose_las_grid(const Bounds& bounds, double step, const Eigen::Vector3d& sample,
                                      const OnGrid& all_on_grid);

}  // namespace ray
