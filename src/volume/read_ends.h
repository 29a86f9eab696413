#pragma once
/// What one reading of a cloud tells: its ends, how dense they lie, and its times.

#include <raycloud/exec/blocks.h>
#include <raycloud/spatial/seen_point.h>

#include <cstdint>
#include <limits>
#include <vector>

namespace ray {

[[nodiscard]] inline SeenPoint seen_end(const RayCloud& rays, std::size_t i) {
  return {rays.ends[i], pack_direction(rays.starts[i] - rays.ends[i])};
}

struct ReadEnds {
  std::vector<SeenPoint> points;  ///< of the bounded rays, in order; empty where they are too many
  EndSample sample;
  double spacing = 0.0;                                    ///< m; 0 if unknown
  double reach = std::numeric_limits<double>::infinity();  ///< m, of neighbours
  std::uint64_t rays = 0;                                  ///< unbounded ones too
  std::uint64_t rows = 0;                                  ///< of the source, invalid ones too
  std::uint64_t dropped = 0;                               ///< of these, invalid ones
  /// s, of all rays; first above last where there are none.
  double first_time = std::numeric_limits<double>::infinity();
  double last_time = -std::numeric_limits<double>::infinity();

  [[nodiscard]] bool fits() const { return points.size() == sample.bounded; }
};

/// Reads `source` once and rewinds it. Keeps the points unless they are more than `most`.
[[nodiscard]] ReadEnds read_ends(const Context& context, RaySource& source, std::size_t most);

}  // namespace ray
