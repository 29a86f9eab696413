#include "survey.h"

#include <raycloud/spatial/point_sample.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <tuple>

namespace ray {
namespace {

struct Part {
  Bounds bounds;
  std::optional<Colour> first;  // of a bounded end
  bool one_colour = true;
  std::array<std::uint64_t, 256> intensities{};
  std::vector<Eigen::Vector3d> sample;
};

bool same_rgb(const Colour& a, const Colour& b) {
  return a.red == b.red && a.green == b.green && a.blue == b.blue;
}

Part survey_chunk(const RayCloud& rays, const PointSample& sample) {
  Part part;
  part.sample = sample.candidates(rays.ends, rays.bounded);
  for (std::size_t i = 0; i < rays.size(); i++) {
    if (rays.bounded[i] == 0) continue;
    const Colour& colour = rays.colours[i];
    if (!part.first) part.first = colour;
    part.one_colour = part.one_colour && same_rgb(*part.first, colour);
    part.bounds.add(rays.ends[i]);
    part.intensities[colour.intensity]++;
  }
  return part;
}

/// The range of z that `outside` of the points are below and as many above.
std::pair<double, double> height_range(const std::vector<Eigen::Vector3d>& points, double outside) {
  std::vector<double> heights(points.size());
  std::transform(points.begin(), points.end(), heights.begin(), [](const auto& point) { return point.z(); });
  std::sort(heights.begin(), heights.end());
  const auto cut = static_cast<std::size_t>(outside * static_cast<double>(heights.size()));
  return {heights[cut], heights[heights.size() - 1 - cut]};
}

/// The shade of each intensity: its rank among those of the ends, so that a few reflectors do not leave
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

Survey survey_ends(const Context& context, RaySource& source) {
  constexpr std::size_t kSamplePoints = std::size_t{1} << 16;
  PointSample sample(kSamplePoints);
  Survey survey;
  std::optional<Colour> first;
  survey.counts = stream(
      context, source, nullptr, [&](const RayCloud& rays) { return survey_chunk(rays, sample); },
      [&](const RayCloud&, const Part& part) {
        if (!part.first) return;
        if (!first) first = part.first;
        survey.one_colour = survey.one_colour && part.one_colour && same_rgb(*first, *part.first);
        survey.bounds.add(part.bounds);
        for (std::size_t i = 0; i < 256; i++)
          survey.intensities[i] += part.intensities[i];
        sample.add(part.sample);
      });
  if (!first) return survey;
  survey.bounded = std::accumulate(survey.intensities.begin(), survey.intensities.end(), std::uint64_t{0});
  std::tie(survey.low, survey.high) = sample.points().empty()
                                          ? std::pair{survey.bounds.min.z(), survey.bounds.max.z()}
                                          : height_range(sample.points(), 0.005);
  return survey;
}

Painter::Painter(EndsStyle style, const Survey& survey) : low_(survey.low) {
  const bool one_intensity =
      std::count_if(survey.intensities.begin(), survey.intensities.end(), [](auto n) { return n != 0; }) <= 1;
  by_height_ = style == EndsStyle::height || (survey.one_colour && one_intensity);
  const double range = survey.high - survey.low;
  scale_ = range > 0.0 ? 256.0 / range : 0.0;
  for (std::size_t i = 0; i < ramp_.size(); i++) {
    ramp_[i] = height_colour(static_cast<double>(i) / 255.0);
  }
  shades_.fill(255);
  if (survey.one_colour) shades_ = shades_by_rank(survey.intensities, static_cast<double>(survey.bounded));
}

}  // namespace ray
