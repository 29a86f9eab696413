#pragma once
/// Thinning: fewer rays, each of them an untouched ray of the input (paper, section VII-A).
///
/// All are streaming, keep every bit of all columns of a kept ray, and treat the end of an unbounded ray as
/// any other. The result depends on neither threads, memory nor chunks. All read `source` from where it
/// stands to its end and leave `sink->finish()` to the caller. What they remember is bounded by the context's
/// memory (less 100 MB for the chunks, but at least half of it): where that does not suffice they go through
/// the source several times, remember a part of space each time, and take one bit a ray besides. The source
/// is rewound then, so that it must have stood at its first ray; a 64th of space must fit.

#include <raycloud/core/units.h>
#include <raycloud/exec/context.h>
#include <raycloud/exec/stream.h>

#include <cstdint>

namespace ray {

/// Keeps the first ray, in the order of the source, that ends in each cube of the grid floor(end / width).
///
/// Memory: at most 18 bytes a kept ray besides the chunks. Throws Error(usage) unless width is finite and
/// > 0, Error(out_of_range) where a coordinate is more than 2^62 widths from the origin.
StreamCounts decimate_voxels(const Context& context, RaySource& source, RaySink& sink, Metres width);

/// Keeps the first `most` rays that end in each cube of the grid. Memory: at most 27 bytes a cube besides the
/// chunks. Throws as decimate_voxels, and Error(usage) unless `most` is from 1 to 2^32 - 1.
StreamCounts decimate_to_count(const Context& context, RaySource& source, RaySink& sink, Metres width,
                               std::uint64_t most);

/// Drops a ray if every cube that it crosses, from its start to its end, is crossed by a ray before it; which
/// cubes those are says spatial/crossed_cubes.h. So all free space stays seen, and all surface.
///
/// Time: for each cube that a ray crosses, about 4 ns of a core where most were crossed by rays before (a
/// street seen often, 20 cm), 30 to 40 where few (seen once, 2 to 5 cm: the tables outgrow the caches).
/// Memory: at most 36 bytes for each 4³ cubes of which one is crossed, and 16 MB (a quarter of what is
/// allowed, if that is less), besides the chunks. Throws as decimate_voxels, and Error(out_of_range) where a
/// ray crosses more than 2^30 cubes along an axis.
StreamCounts decimate_paths(const Context& context, RaySource& source, RaySink& sink, Metres width);

/// Keeps a ray unless a kept ray before it, seen from as near or nearer, ends in the same cube, where the
/// width of the cube goes with the range of the ray: it is the largest power of two (of metres) that is not
/// above `per_metre` times the range. So what is near is dense, what is far is sparse, and what was seen from
/// near and far is as dense as from near. A ray whose cube would be smaller than a micrometre stays and
/// counts for no other.
///
/// Memory: about 40 bytes a kept ray besides the chunks; where it is short, a pass for each power of two
/// besides. Throws Error(usage) unless per_metre is finite and > 0, Error(out_of_range) as decimate_voxels.
StreamCounts decimate_by_range(const Context& context, RaySource& source, RaySink& sink, double per_metre);

/// Keeps rays 0, n, 2n … of the valid rays of the source. Memory: the chunks. Throws Error(usage) if n is 0.
StreamCounts decimate_every(const Context& context, RaySource& source, RaySink& sink, std::uint64_t n);

}  // namespace ray
