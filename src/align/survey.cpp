#include "survey.h"

#include <raycloud/exec/stream.h>
#include <raycloud/spatial/point_sample.h>
#include <raycloud/spatial/point_spacing.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace ray::align {

Survey survey_ends(const Context& context, RaySource& source) {
  constexpr std::size_t kSample = std::size_t{1} << 16;
  struct OfChunk {
    std::vector<Eigen::Vector3d> candidates;
    std::uint64_t bounded = 0;
  };
  Survey survey;
  PointSample sample(kSample);
  const StreamCounts counts = stream(
      context, source, nullptr,
      [&](const RayCloud& rays) {
        return OfChunk{sample.candidates(rays.ends, rays.bounded),
                       rays.size() - static_cast<std::uint64_t>(
                                         std::count(rays.bounded.begin(), rays.bounded.end(), 0))};
      },
      [&](const RayCloud&, const OfChunk& chunk) {
        sample.add(chunk.candidates);
        survey.bounded += chunk.bounded;
      });
  source.rewind();
  survey.rays = counts.rays_in;
  survey.dropped = counts.dropped;
  const std::vector<Eigen::Vector3d>& points = sample.points();
  if (points.empty()) return survey;
  std::vector<double> values(points.size());
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    std::transform(points.begin(), points.end(), values.begin(),
                   [axis](const Eigen::Vector3d& point) { return point[axis]; });
    std::sort(values.begin(), values.end());
    survey.origin[axis] = std::round(values[values.size() / 2]);
    const std::size_t aside = values.size() / 100;
    survey.extent = std::max(survey.extent, values[values.size() - 1 - aside] - values[aside]);
  }
  survey.spacing = estimate_spacing(points, survey.bounded).value;
  return survey;
}

double patch_width(const Survey& survey) {
  constexpr double kSpacings = 4.0;
  constexpr double kUsual = 0.2;  // m
  constexpr double kShare = 0.02;
  return std::max(kSpacings * survey.spacing, std::min(kUsual, kShare * survey.extent));
}

}  // namespace ray::align
