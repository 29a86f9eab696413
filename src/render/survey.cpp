#include "survey.h"

#include <raycloud/spatial/point_sample.h>

#include <algorithm>
#include <optional>
#include <tuple>

namespace ray {
namespace {

struct Part {
  Bounds bounds;
  std::optional<Colour> first;  // of a point
  bool one_colour = true;
  std::array<std::uint64_t, 256> intensities{};
  std::uint64_t count = 0;
  std::vector<Eigen::Vector3d> sample;
};

bool same_rgb(const Colour& a, const Colour& b) {
  return a.red == b.red && a.green == b.green && a.blue == b.blue;
}

Part survey_chunk(RenderStyle style, const RayCloud& rays, const PointSample& sample) {
  Part part;
  if (style == RenderStyle::rays) {
    for (const auto* points : {&rays.starts, &rays.ends}) {
      for (const Eigen::Vector3d& point : *points)
        part.bounds.add(point);
    }
    part.count = rays.size();
    return part;
  }
  each_drawn_point(style, rays, [&](const Eigen::Vector3d& point, const Colour& colour) {
    if (!part.first) part.first = colour;
    part.one_colour = part.one_colour && same_rgb(*part.first, colour);
    part.bounds.add(point);
    part.intensities[colour.intensity]++;
    part.count++;
  });
  part.sample = style == RenderStyle::starts
                    ? sample.candidates(rays.starts, std::vector<std::uint8_t>(rays.size(), 1))
                    : sample.candidates(rays.ends, rays.bounded);
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

}  // namespace

Survey survey_cloud(const Context& context, RaySource& source, RenderStyle style) {
  constexpr std::size_t kSamplePoints = std::size_t{1} << 16;
  PointSample sample(kSamplePoints);
  Survey survey;
  std::optional<Colour> first;
  std::uint64_t count = 0;
  survey.counts = stream(
      context, source, nullptr, [&](const RayCloud& rays) { return survey_chunk(style, rays, sample); },
      [&](const RayCloud&, const Part& part) {
        if (part.count == 0) return;
        if (!first) first = part.first;
        survey.one_colour = survey.one_colour && part.one_colour && (!first || same_rgb(*first, *part.first));
        survey.bounds.add(part.bounds);
        for (std::size_t i = 0; i < 256; i++)
          survey.intensities[i] += part.intensities[i];
        count += part.count;
        sample.add(part.sample);
      });
  survey.counts.rays_out = count;
  if (count == 0) return survey;
  std::tie(survey.low, survey.high) = sample.points().empty()
                                          ? std::pair{survey.bounds.min.z(), survey.bounds.max.z()}
                                          : height_range(sample.points(), 0.005);
  return survey;
}

}  // namespace ray
