#pragma once
/// What is there only for a part of the time, in clouds that do not fit the memory.

#include "judgement.h"
#include "read_ends.h"

namespace ray {

/// As split_transients, with the same result. `ends` are those of the source without the points. Reads it
/// three times.
TransientCounts split_in_blocks(const Context& context, RaySource& source, RaySink& fixed, RaySink& transient,
                                const ReadEnds& ends, JudgeRule rule);

}  // namespace ray
