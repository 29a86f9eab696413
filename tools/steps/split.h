#pragma once
/// The forms of raysplit that are no step, as they make any number of clouds.

#include "cli/match.h"

namespace ray::tools {

/// A cloud for each cell or colour.
[[nodiscard]] bool splits_in_parts(const cli::Match& match);

}  // namespace ray::tools
