#pragma once
/// What is in a ray cloud, in one pass: the figures that `rayinfo` shows.

#include <raycloud/core/bounds.h>
#include <raycloud/core/column.h>
#include <raycloud/core/ray_stream.h>
#include <raycloud/core/units.h>
#include <raycloud/exec/context.h>

#include <cstdint>
#include <vector>

namespace ray {

/// Of the values that are not NaN; all 0 where there are none.
struct Statistics {
  std::uint64_t count = 0;
  double min = 0.0;
  double mean = 0.0;
  double max = 0.0;
  [[nodiscard]] bool constant() const { return min == max; }
  friend bool operator==(const Statistics&, const Statistics&) = default;
};

struct ColumnSummary {
  ColumnInfo column;
  Statistics values;  ///< of all rays; 64-bit integers beyond 2^53 are rounded
};

struct CloudSummary {
  std::uint64_t rays = 0;  ///< valid ones: bounded + unbounded
  std::uint64_t bounded = 0;
  std::uint64_t unbounded = 0;
  std::uint64_t zero_length = 0;  ///< rays that end where they start
  std::uint64_t dropped = 0;      ///< rows left out because of a NaN or infinite value
  Bounds starts;
  Bounds ends;                 ///< of all rays
  Bounds bounded_ends;         ///< the surfaces
  double earliest_time = 0.0;  ///< s; 0 without rays
  double latest_time = 0.0;
  std::uint64_t backward_steps = 0;  ///< rays with an earlier time than the ray before them in the file
  [[nodiscard]] bool in_time_order() const { return backward_steps == 0; }
  Statistics bounded_lengths;  ///< m, of bounded rays (the length of an unbounded one is a convention)
  /// See estimate_spacing (spatial/point_spacing.h); of the bounded ends, from a sample of at most 2^18. 0 if
  /// unknown.
  Metres mean_spacing;
  /// How far the sensor moved, in order of time whatever the order of the file: the polyline through the
  /// start of the earliest ray of every tenth of a second, and of the latest ray. Jitter between rays does
  /// not add up. (The tenth is doubled until there are at most 2^16 nodes.)
  Metres path_length;
  Statistics red;  ///< 0–255, of bounded rays, as are green, blue and intensity
  Statistics green;
  Statistics blue;
  Statistics intensity;
  std::vector<ColumnSummary> extras;
};

/// Reads `source` from where it stands to its end.
/// Streaming; memory: the chunks and at most 25 MB. Every bit of the result is the same for all threads and
/// chunk sizes. A source without rays gives zeros and empty bounds.
[[nodiscard]] CloudSummary summarise_cloud(const Context& context, RaySource& source);

}  // namespace ray
