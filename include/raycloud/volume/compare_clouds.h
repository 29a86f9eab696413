#pragma once
/// What is different between two clouds of one place: what came, what went, and what only one of them saw.
/// docs/algorithms/differences.md.

#include <raycloud/core/ray_stream.h>
#include <raycloud/exec/stream.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace ray {

struct DifferenceRule {
  double distance = 0.0;  ///< m; ends with one of the other cloud that near are the same. 0: usual_distance()
  double rays = 10.0;     ///< above 0; so many rays must see through a place, as for merging
};

/// Three times the larger of two point spacings (m), at least 5 cm: points of one surface, which two scans do
/// not meet at the same places, with a noise of 2 cm, have one of the other scan within it.
[[nodiscard]] double usual_distance(double spacing_of_first, double spacing_of_second);

/// What an end is, seen from the other cloud. The values are those of the column `difference`.
enum class Difference : std::uint8_t {
  none,       ///< it is of an unbounded ray
  same,       ///< an end of the other cloud is within the distance
  removed,    ///< only the first cloud has it, and the second one saw through its place
  added,      ///< only the second cloud has it, and the first one saw through its place
  unobserved  ///< only one has it, and the other one did not look there
};
inline constexpr std::size_t kDifferences = 5;

struct ComparedEnds {
  std::vector<Difference> differences;  ///< of each bounded ray, in order
  std::vector<float> distances;         ///< m, to the nearest end of the other cloud; infinity above twice
                                        ///< the distance of the comparison
};

struct DifferenceTotals {
  std::uint64_t rays = 0;
  double area = 0.0;    ///< m²; of what is the same, the mean of both clouds
  double volume = 0.0;  ///< m³ of the cubes, as wide as the distance, that hold its ends
};

struct CloudComparison {
  double distance = 0.0;  ///< m, by which ends are the same
  std::array<ComparedEnds, 2> clouds;
  std::array<DifferenceTotals, kDifferences> totals;  ///< by Difference
  /// same / (same + removed + added), by areas, or by rays where all areas are 0; none if nothing was seen by
  /// both.
  std::optional<double> similarity;
  std::uint64_t dropped = 0;  ///< rows left out because of a NaN or infinite value

  [[nodiscard]] const DifferenceTotals& of(Difference difference) const {
    return totals[static_cast<std::size_t>(difference)];
  }
};

/// Compares every end of each cloud with the other cloud. Exchanging the clouds exchanges what was removed
/// and added.
///
/// An end with one of the other cloud within the distance is the same, whatever rays say; the distance is
/// exact. Of the others those are different that `merge_clouds` with CloudMerge::min would take out of these
/// two clouds, if they have no ray in common.
///
/// The area that an end stands for is π r² / 16, where r is the distance of its 16th neighbour in its own
/// cloud, within 32 spacings: true on average whatever the density. One with fewer neighbours has as many as
/// it has; one with none, a square as wide as the distance.
///
/// Reads each cloud twice, and four times more where there are differences. Neighbourhood shape: O(n log n),
/// 1 µs of one core a ray where nothing is different, else 4.5; 140 bytes for each bounded ray of the larger
/// cloud and 18 for each of both. Where that is more than context.memory, blocks of space are worked on one
/// after the other, in temporary files, in half as much time again: then 6 bytes for each bounded ray are
/// needed besides. The result depends neither on threads nor on memory, and on the order of the rays only as
/// far as samples of large clouds do, from which come spacing and noise, and the rounding of areas.
///
/// Throws Error(usage) if the distance is below 0 or the rays are not above 0, Error(out_of_range) if the
/// distance is too small for the coordinates (2^62 of it) or there are more than 4 billion rays.
[[nodiscard]] CloudComparison compare_clouds(const Context& context, RaySource& first, RaySource& second,
                                             const DifferenceRule& rule);

/// The columns of `source` and `difference`, uint8. Throws Error(wrong_content) if it has one of that name
/// and another type.
[[nodiscard]] std::vector<ColumnInfo> difference_columns(std::vector<ColumnInfo> source);

/// Streams every ray of one of the clouds to a sink made with the columns of difference_columns(). Ends that
/// are removed blend into (255, 0, 127), ends that are added into (0, 255, 127): half of it at the distance,
/// all at twice the distance. What is unobserved is grey; all else keeps its colour, and everything its
/// intensity. Rewinds the source; does not finish the sink.
StreamCounts write_differences(const Context& context, RaySource& source, const ComparedEnds& ends,
                               double distance, RaySink& sink);

}  // namespace ray
