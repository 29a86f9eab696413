#include "canvas.h"
#include "line_raster.h"
#include "spread.h"

#include <raycloud/render/height_colour.h>

#include <array>
#include <cmath>
#include <vector>

namespace ray {
namespace {

/// Adds up the lengths of the rays within each pixel.
class Lines final : public Canvas {
 public:
  explicit Lines(const Frame& frame) : frame_(frame), raster_(frame.columns, frame.rows) {}

  void draw(const RayCloud& rays) override {
    std::vector<Line> lines(rays.size());
    const auto width = static_cast<double>(frame_.columns);
    const auto height = static_cast<double>(frame_.rows);
    for (std::size_t i = 0; i < rays.size(); i++) {
      lines[i] = {
          std::min(frame_.across(rays.starts[i]), width), std::min(frame_.upwards(rays.starts[i]), height),
          std::min(frame_.across(rays.ends[i]), width), std::min(frame_.upwards(rays.ends[i]), height)};
    }
    raster_.draw(lines);
  }

  [[nodiscard]] Image image() const override {
    const ValueRange range = *shown();
    const double octaves = std::log2(range.brightest / range.darkest);
    const std::array<Pixel, 256> ramp = height_ramp();
    Image image{frame_.columns, frame_.rows, std::vector<Pixel>(frame_.columns * frame_.rows)};
    each_pixel([&](std::size_t pixel, double metres) {
      const double place = octaves > 0.0 ? 255.0 * std::log2(metres / range.darkest) / octaves : 255.0;
      image.pixels[pixel] = ramp[static_cast<std::size_t>(std::clamp(place, 0.0, 255.0))];
    });
    return image;
  }

  [[nodiscard]] std::optional<ValueRange> shown() const override {
    Spread spread;
    each_pixel([&](std::size_t, double metres) { spread.add(metres); });
    return ValueRange{spread.exceeded_by(0.99), spread.exceeded_by(0.01)};
  }

  [[nodiscard]] FloatImage values() const override {
    FloatImage image{frame_.columns, frame_.rows, std::vector<FloatPixel>(frame_.columns * frame_.rows)};
    each_pixel([&](std::size_t pixel, double metres) {
      const auto value = static_cast<float>(metres);
      image.pixels[pixel] = {value, value, value};
    });
    return image;
  }

 private:
  /// Calls `call(pixel, metres)` where there are any.
  template <class Call>
  void each_pixel(const Call& call) const {
    for (std::size_t row = 0; row < frame_.rows; row++) {
      for (std::size_t column = 0; column < frame_.columns; column++) {
        const double length = raster_.length_in(column, frame_.rows - 1 - row);
        if (length > 0.0) call(row * frame_.columns + column, length * frame_.pixel_width);
      }
    }
  }

  Frame frame_;
  LineRaster raster_;
};

}  // namespace

std::unique_ptr<Canvas> make_lines(const Frame& frame) {
  return std::make_unique<Lines>(frame);
}

}  // namespace ray
