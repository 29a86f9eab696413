#pragma once
/// The colours of a number between low and high.

#include <raycloud/core/image.h>

#include <array>

namespace ray {

/// Dark blue for 0 over green to bright yellow for 1, clamped outside: lightness rises evenly in OKLab
/// (Ottosson 2020), so that it reads in grey too.
[[nodiscard]] Pixel height_colour(double fraction);

/// The same in 256 even steps, for many.
[[nodiscard]] std::array<Pixel, 256> height_ramp();

}  // namespace ray
