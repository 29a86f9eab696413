#pragma once
/// How many blocks a cloud is cut into that does not fit the memory.

#include <raycloud/exec/end_sample.h>
#include <raycloud/exec/space_cuts.h>

#include <cstddef>

namespace ray::blocks {

/// So few that each, with what lies within `reach` (m) around it, has about `fitting` records at most. Where
/// that can't be, as most records of a block are around it, more blocks take more time and hardly less
/// memory: then down to a quarter of those that would fit without what is around, as long as the largest has
/// no more than 1.4 times the records. By the sample; at most 1024.
[[nodiscard]] SpaceCuts cuts_for(const EndSample& sample, double reach, std::size_t fitting);

}  // namespace ray::blocks
