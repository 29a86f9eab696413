#pragma once
/// Pictures as plain values: `render` makes them, `io` writes them.

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

/// 8 bits a channel, row by row from the top left; `pixels.size() == width * height`.
struct Image {
  std::size_t width = 0;
  std::size_t height = 0;
  std::vector<Pixel> pixels;
};

}  // namespace ray
