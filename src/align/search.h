#pragma once
/// All poses that may be right, judged.

#include "hypotheses.h"

#include <vector>

namespace ray::align {

/// Hypotheses, the best first. What slides along walls is fitted to many places: so those beside the best few
/// are looked for too, and those beside the best of all until there is no better.
[[nodiscard]] std::vector<Hypothesis> judged_poses(const Context& context, const Known& cloud,
                                                   const Known& reference, const Jury& jury, bool local);

}  // namespace ray::align
