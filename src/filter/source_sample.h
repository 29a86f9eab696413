#pragma once
/// What a few chunks of a source tell of the whole, so that an import can be refused or planned before it
/// starts.

#include <raycloud/core/ray_stream.h>
#include <raycloud/exec/context.h>
#include <raycloud/filter/intensity.h>
#include <raycloud/filter/time_base.h>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace ray {

struct SourceSample {
  std::uint64_t rays = 0;  ///< valid ones
  std::uint64_t invalid = 0;
  bool complete = false;  ///< every chunk was looked at
  TimeSpan times;
  IntensityRange intensity;
  std::vector<std::uint8_t> recorded;  ///< for each extra column: 1 if a value is not zero
  std::optional<Eigen::Vector3d> first_start;
};

/// Whether a value of the column is not zero.
[[nodiscard]] bool is_recorded(const Column& column);

/// Fetches all and decodes at most 4 chunks, the first and the last among them, evenly spread; leaves the
/// source rewound. Deterministic. `intensity` is the name of a column, empty for none.
[[nodiscard]] SourceSample sample_source(const Context& context, RaySource& source,
                                         const std::string& intensity);

}  // namespace ray
