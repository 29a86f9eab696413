#pragma once
/// Pictures as plain values: `render` makes them, `io` reads and writes them. Rows go from the top left;
/// `pixels.size() == width * height`.

#include <cstddef>
#include <cstdint>
#include <vector>

namespace ray {

struct Pixel {
  std::uint8_t red = 0;
  std::uint8_t green = 0;
  std::uint8_t blue = 0;
  std::uint8_t alpha = 0;
  friend bool operator==(const Pixel&, const Pixel&) = default;
};

/// 8 bits a channel.
struct Image {
  std::size_t width = 0;
  std::size_t height = 0;
  std::vector<Pixel> pixels;
};

/// Linear values of any size.
struct FloatPixel {
  float red = 0.0F;
  float green = 0.0F;
  float blue = 0.0F;
  friend bool operator==(const FloatPixel&, const FloatPixel&) = default;
};

/// For measured values rather than for looking at. It has no alpha: 0 is also where nothing is.
struct FloatImage {
  std::size_t width = 0;
  std::size_t height = 0;
  std::vector<FloatPixel> pixels;
};

}  // namespace ray
