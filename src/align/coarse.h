#pragma once
/// Where one cloud may lie on another: every turn about the vertical and every shift, by correlation of what
/// both look like from above (paper, section VIII-E).

#include "footprint.h"

#include <raycloud/exec/context.h>

#include <vector>

namespace ray::align {

/// p' = turn by yaw · p + shift, in the plane, from the origin of one cloud to that of the other.
struct Candidate {
  double yaw = 0.0;  ///< rad
  Eigen::Vector2d shift = Eigen::Vector2d::Zero();
  double score = 0.0;  ///< correlation, 1 for a footprint with itself
};

/// At most `most` candidates, the best first, no two within three cells and three steps of yaw of each other.
/// O(side² log side) for each of some 250 turns: 0.3 s of two cores.
[[nodiscard]] std::vector<Candidate> find_candidates(const Context& context, const Footprint& cloud,
                                                     const Footprint& reference, std::size_t most);

}  // namespace ray::align
