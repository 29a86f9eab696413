#pragma once
/// The first pass over a cloud to be drawn: where its ends are and how to colour them.

#include <raycloud/core/bounds.h>
#include <raycloud/core/image.h>
#include <raycloud/exec/stream.h>
#include <raycloud/render/render_ends.h>

#include <array>

namespace ray {

/// What the bounded ends of a cloud have in common.
struct Survey {
  Bounds bounds;
  double low = 0.0;  ///< m; the range of z without the lowest and highest 0.5 %
  double high = 0.0;
  std::array<std::uint64_t, 256> intensities{};  ///< how many ends have each
  std::uint64_t bounded = 0;
  bool one_colour = true;  ///< red, green and blue are the same everywhere
  StreamCounts counts;
};

[[nodiscard]] Survey survey_ends(const Context& context, RaySource& source);

/// How to colour an end: the rules of EndsStyle, decided once.
class Painter {
 public:
  Painter(EndsStyle style, const Survey& survey);
  [[nodiscard]] Pixel colour(const Eigen::Vector3d& end, const Colour& colour) const {
    if (by_height_) {
      const double place = (end.z() - low_) * scale_;
      return ramp_[static_cast<std::size_t>(place < 0.0 ? 0.0 : place < 255.0 ? place : 255.0)];
    }
    const unsigned shade = shades_[colour.intensity];
    return {tint(colour.red, shade), tint(colour.green, shade), tint(colour.blue, shade), 255};
  }

 private:
  [[nodiscard]] static std::uint8_t tint(unsigned value, unsigned shade) {
    return static_cast<std::uint8_t>((value * shade + 127) / 255);
  }

  bool by_height_;
  double low_;
  double scale_;  // entries of the ramp for a metre
  std::array<Pixel, 256> ramp_;
  std::array<std::uint8_t, 256> shades_;  // by intensity
};

}  // namespace ray
