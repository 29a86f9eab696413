#pragma once
/// Lines by exact coverage: how long each runs inside each pixel.

#include <cstddef>
#include <cstdint>
#include <mutex>
#include <span>
#include <vector>

namespace ray {

/// From (x0, y0) to (x1, y1), in pixels from the bottom left corner.
struct Line {
  double x0, y0, x1, y1;
};

/// Sums of lengths in fixed point, so the same in any order: 2^-20 pixel widths, with the lines themselves
/// rounded to 2^-31. 8 bytes a pixel. Each side less than 2^31 pixels, each sum less than 10^13 pixel widths.
class LineRaster {
 public:
  LineRaster(std::size_t columns, std::size_t rows);

  /// Thread-safe: the raster is cut into bands across its longer side, each drawn to by one thread at a time.
  /// What is outside the raster by rounding counts for the pixels at its edge. Cost: O(pixels crossed).
  void draw(std::span<const Line> lines);

  /// The sum of the lengths within a pixel, in pixel widths. `row` from the bottom.
  [[nodiscard]] double length_in(std::size_t column, std::size_t row) const {
    return static_cast<double>(cells_[wide_ ? column * breadth_ + row : row * breadth_ + column]) / kUnits;
  }

 private:
  static constexpr double kUnits = 1 << 20;  // for the width of a pixel
  struct Segment;
  class Band;
  class Bins;
  [[nodiscard]] Segment segment_of(const Line& line) const;
  [[nodiscard]] Band band(std::size_t number);

  bool wide_;            // the image is wider than high, and stored column by column
  std::size_t breadth_;  // the shorter side, consecutive in memory
  std::size_t length_;   // the longer side, cut into bands
  std::size_t band_length_;
  std::vector<std::uint64_t> cells_;
  std::vector<std::mutex> locks_;  // one a band
};

}  // namespace ray
