#pragma once
/// What is transient comes in regions: evidence of neighbours is brought together.

#include "transience.h"

#include <raycloud/exec/context.h>
#include <raycloud/volume/ellipsoid_tree.h>

#include <span>
#include <vector>

namespace ray {

/// Which of the three kinds of passes contradict.
struct Contradiction {
  bool before = true;
  bool between = true;
  bool after = true;
};

/// An ellipsoid's number depends on the evidence of those that are up to so many steps away: from centre to
/// centre, of which one lies in the ellipsoid of the other.
inline constexpr int kRegionSteps = 5;

/// For each ellipsoid, by slot, the number of rays below which it is transient. Every step treats all numbers
/// at once: it takes medians, minima and maxima, and multiples of them.
///
/// 1. Its own transience, less what a hedge of even opacity would have by chance, but not above the median of
///    the ellipsoids around its centre. Or, if it was opaque, two and a half times that, but not above as
///    much of the least tenth of them: together they cover some four times its area, and so many more rays
///    went through.
/// 2. From where it is above 14 it spreads, three times, to ellipsoids that overlap, up to ten times their
/// own
///    hint of transience, where that is above 0.7.
/// 3. It is at least the median of the ellipsoids around its centre, whatever its own evidence.
///
/// Memory: 13 bytes an ellipsoid. Time: little where nothing is transient.
[[nodiscard]] std::vector<float> transient_regions(const Context& context, const EllipsoidTree& tree,
                                                   std::span<const Evidence> evidence,
                                                   const Contradiction& which);

}  // namespace ray
