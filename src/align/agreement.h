#pragma once
/// Whether two clouds agree when one lies on the other: where both have surfaces these are the same, and
/// neither has any in what the other has seen to be empty.

#include "free_cubes.h"
#include "patches.h"

#include <raycloud/core/pose.h>

#include <span>

namespace ray::align {

/// Of patches of one cloud, what the other says. Counted apart for upright surfaces, which tell of the turn
/// and the horizontal shift, and others.
struct Agreement {
  struct Counts {
    double same = 0.0;     ///< on a surface that heads the same way
    double other = 0.0;    ///< beside a surface, but not on it or not heading as it does
    double empty = 0.0;    ///< in space that was seen to be empty
    double unknown = 0.0;  ///< where the other cloud tells nothing
    double squares = 0.0;  ///< m², of the distances of those that are the same
    [[nodiscard]] double known() const { return same + other + empty; }
    Counts& operator+=(const Counts& more);
  };
  Counts upright, others;

  [[nodiscard]] Counts all() const {
    Counts sum = upright;
    return sum += others;
  }
  Agreement& operator+=(const Agreement& more);
};

struct Observed {
  const PatchLevel& level;
  const FreeCubes& free;
};

/// `tolerance` (m): how far from a surface is on it.
[[nodiscard]] Agreement agreement_of(std::span<const Patch> patches, const Pose& pose, const Observed& other,
                                     double tolerance);

}  // namespace ray::align
