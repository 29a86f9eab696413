#pragma once
/// Rays whose ends lie off the surface of their neighbours, taken out.

#include <raycloud/filter/denoise.h>

namespace ray {

/// OutsideNeighbours of filter/denoise.h. Precondition: sigmas > 0.
Denoised outside_neighbours(const Context& context, RaySource& source, RaySink& sink, double sigmas);

}  // namespace ray
