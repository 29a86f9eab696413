#pragma once
/// The Radiance picture format: four bytes a pixel, three mantissas that share an exponent (Ward, "Real
/// pixels", Graphics Gems II, 1991), each byte of a row run-length coded for itself.

#include <raycloud/core/image.h>

#include <array>
#include <cstdint>
#include <span>
#include <string>

namespace ray {

using Rgbe = std::array<std::uint8_t, 4>;

/// Rounded to nearest, to be read as mantissa · 2^(exponent − 136), without the half that some old readers
/// add: the error is at most 1/256 of the largest channel. Below 2^-128 it is 0, from 2^127 on as at
/// 2^127. Precondition: no channel is negative or NaN.
[[nodiscard]] Rgbe rgbe_of(const FloatPixel& pixel);

[[nodiscard]] std::string rgbe_header(std::size_t width, std::size_t height);

/// Adds a row from the left to the file. Precondition: not empty.
void append_rgbe_row(std::span<const FloatPixel> row, std::string& file);

}  // namespace ray
