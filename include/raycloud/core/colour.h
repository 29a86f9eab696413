#pragma once
/// The colour of a ray's end point.

#include <cstdint>

namespace ray {

/// Red, green, blue and the 8-bit intensity that a ray cloud keeps in its alpha channel. Whether the ray is
/// bounded is a column of its own (RayCloud::bounded); files encode it as alpha 0, which is the business of
/// `io` alone.
struct Colour {
  std::uint8_t red = 255;
  std::uint8_t green = 255;
  std::uint8_t blue = 255;
  std::uint8_t intensity = 255;
  friend bool operator==(const Colour&, const Colour&) = default;
};

}  // namespace ray
