#pragma once
/// Values over a grid of the map.

#include <Eigen/Core>
#include <cstddef>
#include <vector>

namespace ray {

/// Square cells, rows from the north (the largest y) down: `values.size() == width * height`.
struct Raster {
  std::size_t width = 0;
  std::size_t height = 0;
  double cell = 1.0;                                 ///< m
  Eigen::Vector2d corner = Eigen::Vector2d::Zero();  ///< m; the north-west one of all cells
  std::vector<float> values;                         ///< NaN where there is none

  /// The middle of a cell.
  [[nodiscard]] Eigen::Vector2d centre(std::size_t column, std::size_t row) const {
    return {corner.x() + cell * (static_cast<double>(column) + 0.5),
            corner.y() - cell * (static_cast<double>(row) + 0.5)};
  }
};

}  // namespace ray
