#pragma once
/// What rays say about sites they do not end at.

#include "low_levels.h"

#include <raycloud/exec/context.h>

#include <cstdint>
#include <vector>

namespace ray {

/// 1 for each cell whose chosen level has free space below it: two rays or more to the chosen levels of other
/// cells pass more than `margin` (m) under it, or under three of those around that are about as high, on
/// their last 48 cells of way, so that it is a crown, an awning or a bridge, and no ground. Only rays to
/// levels of two ends or more are asked: a false return, which seems to have come through the ground, is
/// alone. `chosen` is kNoLevel for cells without a site.
[[nodiscard]] std::vector<std::uint8_t> sites_over_free_space(const Context& context, const LowestEnds& cells,
                                                              const std::vector<std::uint8_t>& chosen,
                                                              double margin);

}  // namespace ray
