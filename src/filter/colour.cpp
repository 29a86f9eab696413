#include "colour_by_surface.h"

#include <raycloud/core/error.h>
#include <raycloud/filter/colour.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace ray {
namespace {

constexpr double kMinute = 60.0;        // s
constexpr double kHeightPeriod = 10.0;  // m
constexpr std::uint8_t kOpaque = 128;   // alpha of an image from which on its colour counts
constexpr std::size_t kHues = 1536;     // all that 8 bits a channel can tell apart

void set_rgb(Colour& colour, const Colour& rgb) {
  colour = {rgb.red, rgb.green, rgb.blue, colour.intensity};
}

/// All hues, from red over green and blue almost back to red.
class HueTable {
 public:
  HueTable() {
    for (std::size_t i = 0; i < kHues; ++i) {
      const auto rise = static_cast<std::uint8_t>(i % 256);
      const auto fall = static_cast<std::uint8_t>(255 - rise);
      const std::array<Colour, 6> sixths{
          {{255, rise, 0}, {fall, 255, 0}, {0, 255, rise}, {0, fall, 255}, {rise, 0, 255}, {255, 0, fall}}};
      hues_[i] = sixths[i / 256];
    }
  }
  [[nodiscard]] const Colour& operator()(double turns) const {
    const double fraction = turns - floored(turns);
    return hues_[std::min(static_cast<std::size_t>(fraction * static_cast<double>(kHues)), kHues - 1)];
  }

 private:
  /// std::floor is a function call on the baseline instruction set.
  static double floored(double value) {
    if (!(std::abs(value) < 0x1p62)) return std::floor(value);
    const auto whole = static_cast<double>(static_cast<std::int64_t>(value));
    return whole - (value < whole ? 1.0 : 0.0);
  }

  std::array<Colour, kHues> hues_;
};

const HueTable& hues() {
  static const HueTable kTable;
  return kTable;
}

void colour_chunk(const ColourByTime&, RayCloud& rays) {
  const HueTable& hue = hues();
  for (std::size_t i = 0; i < rays.size(); ++i)
    set_rgb(rays.colours[i], hue(rays.times[i] / kMinute));
}

void colour_chunk(const ColourByHeight&, RayCloud& rays) {
  const HueTable& hue = hues();
  for (std::size_t i = 0; i < rays.size(); ++i)
    set_rgb(rays.colours[i], hue(rays.ends[i].z() / kHeightPeriod));
}

void colour_chunk(const ColourByIntensity&, RayCloud& rays) {
  for (std::size_t i = 0; i < rays.size(); ++i) {
    // An unbounded ray is stored with intensity 0; whatever it had before must not come back as grey.
    const std::uint8_t grey = rays.bounded[i] != 0 ? rays.colours[i].intensity : std::uint8_t{0};
    set_rgb(rays.colours[i], {grey, grey, grey});
  }
}

void colour_chunk(const OneColour& one, RayCloud& rays) {
  for (Colour& colour : rays.colours)
    set_rgb(colour, one.colour);
}

void colour_chunk(const SetIntensity& set, RayCloud& rays) {
  for (std::size_t i = 0; i < rays.size(); ++i) {
    if (rays.bounded[i] == 0) continue;
    rays.colours[i].intensity = set.intensity;
    rays.bounded[i] = set.intensity != 0 ? 1 : 0;
  }
}

/// Where each point is in the image.
class ImageMap {
 public:
  ImageMap(const Image& image, const Bounds& bounds) : image_(image), corner_(bounds.min) {
    const Eigen::Vector3d extent = bounds.extent();
    pixel_width_ = std::max(extent.x() / static_cast<double>(image.width),
                            extent.y() / static_cast<double>(image.height));
  }

  /// Ends of unbounded rays may lie outside: null.
  [[nodiscard]] const Pixel* at(const Eigen::Vector3d& point) const {
    const double column = pixels(point.x() - corner_.x());
    const double row = pixels(point.y() - corner_.y());
    const auto width = static_cast<double>(image_.width);
    const auto height = static_cast<double>(image_.height);
    if (!(column >= 0.0 && row >= 0.0 && column <= width && row <= height)) return nullptr;
    const std::size_t x = std::min(static_cast<std::size_t>(column), image_.width - 1);
    const std::size_t y = std::min(static_cast<std::size_t>(row), image_.height - 1);
    return &image_.pixels[(image_.height - 1 - y) * image_.width + x];
  }

 private:
  /// A cloud without extent lies in the corner.
  [[nodiscard]] double pixels(double metres) const {
    return pixel_width_ > 0.0 ? metres / pixel_width_ : metres;
  }

  const Image& image_;
  Eigen::Vector3d corner_;
  double pixel_width_ = 0.0;
};

Bounds bounded_ends(const Context& context, RaySource& source) {
  Bounds bounds;
  static_cast<void>(stream(
      context, source, nullptr,
      [](const RayCloud& rays) {
        Bounds part;
        for (std::size_t i = 0; i < rays.size(); ++i)
          if (rays.bounded[i] != 0) part.add(rays.ends[i]);
        return part;
      },
      [&](const RayCloud&, const Bounds& part) { bounds.add(part); }));
  return bounds;
}

void colour_chunk(const ImageMap& map, RayCloud& rays) {
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const Pixel* pixel = map.at(rays.ends[i]);
    if (pixel != nullptr && pixel->alpha >= kOpaque)
      set_rgb(rays.colours[i], {pixel->red, pixel->green, pixel->blue});
  }
}

}  // namespace

Colour hue_colour(double turns) {
  return hues()(turns);
}

StreamCounts colour_rays(const Context& context, RaySource& source, RaySink& sink, const Colouring& colouring,
                         Shading shading) {
  const auto run = [&](const auto& rule) {
    const auto paint = [&](RayCloud& rays) { colour_chunk(rule, rays); };
    return shading == Shading::none ? stream_each(context, source, sink, paint)
                                    : colour_by_surface(context, source, sink, colouring, shading, paint);
  };
  return std::visit(
      [&]<class Rule>(const Rule& rule) {
        if constexpr (ColouredBySurface<Rule>) {
          return colour_by_surface(context, source, sink, colouring, shading, {});
        } else if constexpr (std::is_same_v<Rule, ColourByImage>) {
          if (rule.image.pixels.empty())
            throw Error(ErrorCode::usage, "an image without pixels has no colours");
          const Bounds bounds = bounded_ends(context, source);
          source.rewind();
          return run(ImageMap(rule.image, bounds));
        } else {
          return run(rule);
        }
      },
      colouring);
}

}  // namespace ray
