#pragma once
/// Where the rays of one cloud contradict what another holds.

#include "encounters.h"

#include <raycloud/volume/merge_clouds.h>

#include <cstddef>
#include <span>
#include <vector>

namespace ray {

/// An ellipsoid whose passes contradict it, and the number of rays up to which they do.
struct PassConflict {
  std::uint32_t slot = 0;
  float score = 0.0F;
  float opacity = 0.0F;  ///< the share of its own rays that ended in it
};

struct CloudConflicts {
  std::vector<float> ends;  ///< by slot, the number of rays up to which it gives way; empty: none does
  std::vector<PassConflict> passes;  ///< those to which the rays of the other cloud give way
};

/// What gives way: `own` and `other` are the places of the two clouds on the command line. Where both an end
/// and the rays that pass it might, as for `oldest` beside a place with another order in time, both are
/// given.
///
/// `of_own` and `of_other` tell how the rays of the two clouds met the ellipsoids `some` of the tree; others
/// were not passed. Of rays that go through a place as opaque as its own cloud says, passes · opacity would
/// have ended there; twice the hits that the other cloud has are taken off that: what both saw is still
/// there. Evidence of neighbours is brought together as within one cloud (transient_regions.h).
[[nodiscard]] CloudConflicts cloud_conflicts(const Context& context, const EllipsoidTree& tree,
                                             const SomeEllipsoids& some, std::span<const Encounters> of_own,
                                             std::span<const Encounters> of_other, const MergeRule& rule,
                                             std::size_t own, std::size_t other);

}  // namespace ray
