#pragma once
/// Noise by the surface of the neighbours: the `sigmas` form of denoising.

#include <raycloud/filter/denoise.h>

namespace ray {

/// As remove_noise.
[[nodiscard]] Denoised outside_neighbours(const Context& context, RaySource& source, RaySink& sink,
                                          double sigmas);

}  // namespace ray
