#pragma once
/// How to colour a point for the eye: the rules of RenderStyle::ends and height, decided once.

#include "survey.h"

#include <raycloud/core/image.h>

#include <array>

namespace ray {

class Painter {
 public:
  Painter(RenderStyle style, const Survey& survey);

  /// The ramp by z rather than colours.
  [[nodiscard]] bool by_height() const { return by_height_; }

  /// Opaque.
  [[nodiscard]] Pixel operator()(const Eigen::Vector3d& point, const Colour& colour) const {
    if (by_height_) {
      const double place = (point.z() - low_) * scale_;
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
