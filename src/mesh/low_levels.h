#pragma once
/// The lowest ends of each cell of a map.

#include "plan_raster.h"

#include <raycloud/exec/stream.h>

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

namespace ray {

inline constexpr std::size_t kLowLevels = 6;  // of a cell that are remembered
inline constexpr std::uint8_t kNoLevel = 255;

/// The ends of a cell within a height of half its width.
struct LowLevel {
  std::int32_t number = std::numeric_limits<std::int32_t>::max();
  std::uint32_t count = 0;
  std::array<float, 3> lowest{};     ///< of the ends; m from the corner of the cell and the foot of the level
  std::array<float, 3> to_sensor{};  ///< m; from the lowest end to where it was seen from
};

using LowLevels = std::array<LowLevel, kLowLevels>;  ///< of a cell, from the lowest up

/// Of the cells of a raster.
class LowestEnds {
 public:
  /// Reads the source to its end. 200 bytes a cell that has ends, 8 for any other.
  LowestEnds(const Context& context, RaySource& source, const PlanRaster& raster);

  [[nodiscard]] const PlanRaster& raster() const { return raster_; }
  /// Of all ends of a cell.
  [[nodiscard]] std::uint32_t count(std::size_t cell) const { return counts_[cell]; }
  /// Precondition: the cell has ends.
  [[nodiscard]] const LowLevels& levels(std::size_t cell) const {
    const std::uint32_t number = numbers_[cell];
    return blocks_[number / kBlock][number % kBlock];
  }
  [[nodiscard]] double level_height() const { return 0.5 * raster_.width; }

  /// The lowest end of a level that has ends.
  [[nodiscard]] Eigen::Vector3d place(std::size_t cell, std::size_t level) const {
    const LowLevel& own = levels(cell)[level];
    const Eigen::Vector2d corner = raster_.centre(cell).array() - 0.5 * raster_.width;
    return {corner.x() + static_cast<double>(own.lowest[0]), corner.y() + static_cast<double>(own.lowest[1]),
            own.number * level_height() + static_cast<double>(own.lowest[2])};
  }

 private:
  static constexpr std::uint32_t kBlock = 4096;

  LowLevels& made(std::size_t cell);

  const PlanRaster& raster_;
  std::vector<std::uint32_t> counts_;                 ///< of each cell
  std::vector<std::uint32_t> numbers_;                ///< of each cell that has ends, as they came first
  std::vector<std::unique_ptr<LowLevels[]>> blocks_;  ///< of kBlock each, so that none ever moves
  std::uint32_t occupied_ = 0;
};

}  // namespace ray
