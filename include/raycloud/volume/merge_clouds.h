#pragma once
/// One map of several: where the rays of one cloud have seen through what another holds, one of the two gives
/// way (paper, section VI-B).

#include <raycloud/core/ray_stream.h>
#include <raycloud/exec/stream.h>

#include <cstdint>
#include <span>

namespace ray {

/// What stays where two clouds contradict each other (paper, figure 6).
enum class CloudMerge : std::uint8_t {
  all,     ///< everything
  min,     ///< what was seen through goes: the free space of the result is the union
  max,     ///< the rays that saw through it go: it is the intersection
  oldest,  ///< what was seen earlier at that place
  newest,  ///< what was seen later there
  order    ///< what the earlier cloud says
};

struct MergeRule {
  CloudMerge merge = CloudMerge::min;
  double rays = 10.0;  ///< above 0: so many rays of the other cloud, divided by the opacity, must pass
  bool paper = false;  ///< every crossing counts, an ellipsoid has only its own evidence
};

struct MergeCounts {
  StreamCounts stream;
  std::uint64_t combined = 0;
  std::uint64_t differences = 0;
  std::uint64_t repeated = 0;  ///< rays that another cloud has too and that came with it
};

/// Sends each distinct ray once to one of two sinks: what stays to `combined`, what gave way to
/// `differences`, which may be null; cloud after cloud, each in its order, every bit as it was. Rays are the
/// same if all their columns are; of those that come several times in a cloud, as many come out as the cloud
/// with most of them has. Rays that two clouds both have contradict neither.
///
/// All sources have the same columns, and there is at least one. Neighbourhood shape, in memory: O(n log n)
/// for two clouds, about 3 µs of one core a ray; each further cloud is walked by the rays of all others. 140
/// bytes for each bounded ray of the largest cloud; where that is more than context.memory, blocks of its
/// space are worked on one after the other, in temporary files, in half as much time again. And 8 bytes for
/// each ray of all clouds. The method is that of docs/algorithms/merging.md. The result depends neither on
/// threads nor on memory nor, but for the order of rays and for `order` itself, on the order of the clouds.
///
/// Throws Error(usage) if `rule.rays` is not above 0, Error(no_data) for `oldest` and `newest` if all rays
/// have one time, Error(out_of_range) for more than 4 billion rays.
MergeCounts merge_clouds(const Context& context, std::span<RaySource* const> clouds, RaySink& combined,
                         RaySink* differences, const MergeRule& rule);

}  // namespace ray
