#pragma once
/// The lowest ends of each cell of a map.

#include "plan_raster.h"

#include <raycloud/exec/stream.h>

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace ray {

inline constexpr std::size_t kLowLevels = 6;  // of a cell that are remembered

/// The ends of a cell within a height of half its width.
struct LowLevel {
  std::int32_t number = std::numeric_limits<std::int32_t>::max();
  std::uint32_t count = 0;
  std::array<float, 3> lowest{};   ///< of the ends; m from the corner of the cell and the foot of the level
  std::array<float, 3> towards{};  ///< the sensor that saw it, of length 1; 0 for a ray without length
};

struct LowLevels {
  std::array<LowLevel, kLowLevels> levels;  ///< from the lowest up
  std::uint32_t count = 0;                  ///< of all ends of the cell
};

/// Of the cells of a raster.
class LowestEnds {
 public:
  /// Reads the source to its end. 200 bytes a cell.
  LowestEnds(const Context& context, RaySource& source, const PlanRaster& raster);

  [[nodiscard]] const PlanRaster& raster() const { return raster_; }
  [[nodiscard]] const LowLevels& operator[](std::size_t cell) const { return cells_[cell]; }
  [[nodiscard]] double level_height() const { return 0.5 * raster_.width; }

  /// The lowest end of a level.
  [[nodiscard]] Eigen::Vector3d place(std::size_t cell, std::size_t level) const {
    const LowLevel& own = cells_[cell].levels[level];
    const Eigen::Vector2d corner = raster_.centre(cell).array() - 0.5 * raster_.width;
    return {corner.x() + static_cast<double>(own.lowest[0]), corner.y() + static_cast<double>(own.lowest[1]),
            own.number * level_height() + static_cast<double>(own.lowest[2])};
  }

 private:
  const PlanRaster& raster_;
  std::vector<LowLevels> cells_;
};

}  // namespace ray
