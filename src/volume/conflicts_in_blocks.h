#pragma once
/// Where rays of other clouds contradict a cloud that does not fit the memory.

#include "cloud_conflicts.h"
#include "read_ends.h"

namespace ray {

/// As find_conflicts, with the same result. `ends` are those of the own cloud without the points. Reads the
/// own cloud once for each other one, and twice besides; the others once each.
void find_conflicts_in_blocks(const Context& context, const ConflictQuestion& question, const ReadEnds& ends,
                              const TellConflicts& tell);

}  // namespace ray
