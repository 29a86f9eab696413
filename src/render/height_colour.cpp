#include <raycloud/render/height_colour.h>

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>

namespace ray {
namespace {

using Lab = Eigen::Vector3d;  // OKLab: lightness, green–red, blue–yellow

std::uint8_t to_srgb_byte(double linear) {
  const double v = std::clamp(linear, 0.0, 1.0);
  const double encoded = v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(v, 1.0 / 2.4) - 0.055;
  return static_cast<std::uint8_t>(std::lround(255.0 * encoded));
}

Pixel to_pixel(const Lab& lab) {  // Ottosson, "A perceptual color space for image processing", 2020
  const Eigen::Matrix3d to_lms{{1.0, 0.3963377774, 0.2158037573},
                               {1.0, -0.1055613458, -0.0638541728},
                               {1.0, -0.0894841775, -1.2914855480}};
  const Eigen::Matrix3d to_rgb{{4.0767416621, -3.3077115913, 0.2309699292},
                               {-1.2684380046, 2.6097574011, -0.3413193965},
                               {-0.0041960863, -0.7034186147, 1.7076147010}};
  const Eigen::Vector3d rgb = to_rgb * (to_lms * lab).array().cube().matrix();
  return {to_srgb_byte(rgb.x()), to_srgb_byte(rgb.y()), to_srgb_byte(rgb.z()), 255};
}

}  // namespace

Pixel height_colour(double fraction) {
  struct Stop {
    double chroma;
    double hue_deg;
  };
  // Blue, teal, green, yellow, each about as colourful as its lightness allows on a screen.
  constexpr std::array<Stop, 5> kStops = {{{0.13, 285}, {0.11, 250}, {0.11, 190}, {0.16, 140}, {0.18, 103}}};
  constexpr double kDark = 0.32;
  constexpr double kLight = 0.93;
  const double f = std::clamp(fraction, 0.0, 1.0);
  const double place = f * static_cast<double>(kStops.size() - 1);
  const auto i = std::min(static_cast<std::size_t>(place), kStops.size() - 2);
  const double t = place - static_cast<double>(i);
  const double chroma = std::lerp(kStops[i].chroma, kStops[i + 1].chroma, t);
  const double hue = std::lerp(kStops[i].hue_deg, kStops[i + 1].hue_deg, t) * 3.14159265358979323846 / 180.0;
  return to_pixel({std::lerp(kDark, kLight, f), chroma * std::cos(hue), chroma * std::sin(hue)});
}

std::array<Pixel, 256> height_ramp() {
  std::array<Pixel, 256> ramp;
  for (std::size_t i = 0; i < ramp.size(); i++)
    ramp[i] = height_colour(static_cast<double>(i) / 255.0);
  return ramp;
}

}  // namespace ray
