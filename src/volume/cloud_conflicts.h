#pragma once
/// Where the rays of other clouds contradict what a cloud holds, and who gives way.

#include "numbered_cloud.h"

#include <raycloud/exec/context.h>
#include <raycloud/volume/merge_clouds.h>

#include <cstdint>
#include <functional>
#include <span>

namespace ray {

struct ConflictQuestion {
  std::span<const NumberedCloud> clouds;  ///< in the order in which they are merged
  std::size_t own = 0;                    ///< whose ellipsoids are asked about
  MergeRule rule;
  /// Whether the own cloud has the ray of that number too, so that it contradicts nothing. Empty: none.
  std::function<bool(std::uint32_t number)> is_shared;
};

/// Some rays and, of each, the number of rays of the rule up to which it gives way.
using TellScores = std::function<void(std::span<const std::uint32_t> numbers, std::span<const float> scores)>;

/// Who gives way for an ellipsoid of the own cloud.
struct TellConflicts {
  TellScores ends;    ///< all bounded rays of the own cloud, in order; not called if none does
  TellScores passes;  ///< rays of the other clouds; on any thread, and a ray may come several times
};

/// Where both an end and the rays that pass it might give way, as for `oldest` beside a place with another
/// order in time, and the end does, the rays do not: what gives way contradicts nobody.
///
/// Of rays that go through a place as opaque as its own cloud says, passes · opacity would have ended there;
/// twice the hits that the other cloud has are taken off that: what both saw is still there. Evidence of
/// neighbours is brought together as within one cloud (transient_regions.h).
///
/// Reads and rewinds all clouds, more than once. About 3 µs of one core a ray; 140 bytes a bounded ray of
/// the own cloud, and where that is more than context.memory it is worked on in blocks of space, in temporary
/// files: 10 bytes an end then, besides, and half as much time again. The result depends neither on threads
/// nor on memory.
void find_conflicts(const Context& context, const ConflictQuestion& question, const TellConflicts& tell);

}  // namespace ray
