#pragma once
/// End points moved onto the surface they are samples of (paper, section VIII-C).

#include <raycloud/exec/context.h>
#include <raycloud/exec/stream.h>

namespace ray {

/// Moves the ends of bounded rays to the local surface, along the ray where the surface faces it (noise of
/// range is along the ray), else along the normal. Starts and everything else keep every bit.
///
/// Neighbourhood shape, in two passes: reads, rewinds, reads again. The result depends neither on threads nor
/// on memory. Leaves `sink->finish()` to the caller.
StreamCounts smooth_rays(const Context& context, RaySource& source, RaySink& sink);

}  // namespace ray
