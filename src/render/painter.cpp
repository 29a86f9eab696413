#include "painter.h"

#include <raycloud/render/height_colour.h>

#include <algorithm>
#include <cmath>

namespace ray {
namespace {

/// The shade of each intensity: its rank among those of the points, so that a few reflectors do not leave
/// everything else dark.
std::array<std::uint8_t, 256> shades_by_rank(const std::array<std::uint64_t, 256>& counts, double total) {
  constexpr double kDarkest = 0.2;
  std::array<std::uint8_t, 256> shades{};
  double below = 0.0;
  for (std::size_t i = 0; i < 256; i++) {
    const auto here = static_cast<double>(counts[i]);
    const double rank = (below + 0.5 * here) / total;
    shades[i] = static_cast<std::uint8_t>(std::lround(255.0 * std::lerp(kDarkest, 1.0, rank)));
    below += here;
  }
  return shades;
}

}  // namespace

Painter::Painter(RenderStyle style, const Survey& survey) : low_(survey.low), ramp_(height_ramp()) {
  const bool one_intensity =
      std::count_if(survey.intensities.begin(), survey.intensities.end(), [](auto n) { return n != 0; }) <= 1;
  by_height_ = style == RenderStyle::height || (survey.one_colour && one_intensity);
  const double range = survey.high - survey.low;
  scale_ = range > 0.0 ? 256.0 / range : 0.0;
  shades_.fill(255);
  if (survey.one_colour) {
    shades_ = shades_by_rank(survey.intensities, static_cast<double>(survey.counts.rays_out));
  }
}

}  // namespace ray
