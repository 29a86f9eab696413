#pragma once
/// Thinning: fewer rays, each of them an untouched ray of the input (paper, section VII-A).

#include <raycloud/core/units.h>
#include <raycloud/exec/context.h>
#include <raycloud/exec/stream.h>

#include <cstdint>

namespace ray {

/// Keeps the first ray, in the order of the source, that ends in each cube of the grid floor(end / width).
/// The end of an unbounded ray counts as any other. All columns of a kept ray keep every bit.
///
/// Streaming; memory: at most 18 bytes a kept ray besides the chunks. The result depends on neither threads
/// nor chunks. Reads `source` from where it stands to its end and leaves `sink->finish()` to the caller.
/// Throws Error(usage) unless width is finite and > 0, Error(out_of_range) where a coordinate is more than
/// 2^62 widths from the origin.
StreamCounts decimate_voxels(const Context& context, RaySource& source, RaySink& sink, Metres width);

/// Keeps rays 0, n, 2n … of the valid rays of the source. Otherwise as decimate_voxels; memory: the chunks.
/// Throws Error(usage) if n is 0.
StreamCounts decimate_every(const Context& context, RaySource& source, RaySink& sink, std::uint64_t n);

}  // namespace ray
