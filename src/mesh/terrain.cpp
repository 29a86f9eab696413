#include "greedy_mesh.h"
#include "ground_heights.h"
#include "ground_sites.h"
#include "raised_sites.h"

#include <raycloud/core/error.h>
#include <raycloud/mesh/terrain.h>
#include <raycloud/spatial/point_sample.h>
#include <raycloud/spatial/point_spacing.h>

#include <algorithm>
#include <cmath>

namespace ray {
namespace {

constexpr std::size_t kSample = 100'000;
constexpr double kMostCells = 4194304.0;
constexpr double kLeastCell = 0.1;     // m
constexpr double kCellSpacings = 2.0;  // of points
constexpr double kWideCell = 1.0;      // m; from there on one spacing has to do

struct TerrainSurvey {
  StreamCounts stream;
  std::uint64_t bounded = 0;
  PointSample sample{kSample};
};

void survey_terrain(const Context& context, RaySource& source, TerrainSurvey& survey) {
  survey.stream = stream(
      context, source, nullptr,
      [&](RayCloud& rays) { return survey.sample.candidates(rays.ends, rays.bounded); },
      [&](RayCloud& rays, const std::vector<Eigen::Vector3d>& candidates) {
        survey.sample.add(candidates);
        survey.bounded += static_cast<std::uint64_t>(
            std::count_if(rays.bounded.begin(), rays.bounded.end(), [](auto b) { return b != 0; }));
      });
  survey.stream.rays_out = 0;
}

/// The nearest of four widths in each octave: a cloud with some rays more or less gets the same cells.
double usual_width(double width) {
  return std::exp2(std::round(4.0 * std::log2(width)) / 4.0);
}

/// Where the sample is but for one in a thousand on each side, and half as much again: an end that strayed
/// hundreds of kilometres must not make the cells that wide.
PlanRaster raster_over(const TerrainSurvey& survey) {
  const auto& sample = survey.sample.points();
  PlanRaster raster;
  Eigen::Vector2d size;
  for (int axis = 0; axis < 2; ++axis) {
    std::vector<double> sorted;
    for (const Eigen::Vector3d& point : sample)
      sorted.push_back(point[axis]);
    std::sort(sorted.begin(), sorted.end());
    const std::size_t cut = sorted.size() / 1000;
    const double low = sorted[cut];
    const double high = sorted[sorted.size() - 1 - cut];
    const double margin = 0.5 * (high - low);
    raster.low[axis] = std::max(sorted.front(), low - margin);
    size[axis] = std::min(sorted.back(), high + margin) - raster.low[axis];
  }
  const double spacing = estimate_spacing(sample, survey.bounded).value;
  const double wide = std::min(kCellSpacings * spacing, std::max(spacing, kWideCell));
  raster.width = std::max({usual_width(std::max(wide, kLeastCell)),
                           std::sqrt(size.x() * size.y() / kMostCells), size.maxCoeff() / kMostCells * 2.0});
  const Eigen::Vector2d low = raster.low / raster.width;
  raster.low = raster.width * low.array().floor().matrix();
  raster.columns = static_cast<std::int64_t>(size.x() / raster.width) + 2;
  raster.rows = static_cast<std::int64_t>(size.y() / raster.width) + 2;
  return raster;
}

/// Of the points, one in each square of 16 by 16 cells.
std::vector<std::uint32_t> spread_evenly(const std::vector<Eigen::Vector3d>& ground,
                                         const PlanRaster& raster) {
  constexpr std::size_t kApart = 16;
  std::vector<std::uint32_t> some;
  for (std::uint32_t i = 0; i < ground.size(); ++i) {
    const auto cell = raster.find(ground[i].x(), ground[i].y());
    const auto columns = static_cast<std::size_t>(raster.columns);
    if (cell && *cell / columns % kApart == 0 && *cell % columns % kApart == 0) some.push_back(i);
  }
  return some;
}

/// Leaves the sites that are ground.
void keep_ground(const Context& context, std::vector<GroundSite>& sites, const PlanRaster& raster,
                 double gradient) {
  std::vector<std::uint8_t> doubtful = raised_sites(context, sites, raster);
  const std::vector<std::uint8_t> above = sites_above_cones(context, sites, gradient);
  for (std::size_t cell = 0; cell < sites.size(); ++cell)
    doubtful[cell] |= above[cell];
  grow_ground(context, sites, raster, doubtful);
  for (std::size_t cell = 0; cell < sites.size(); ++cell)
    sites[cell].is_there = sites[cell].is_there && doubtful[cell] == 0;
}

}  // namespace

Terrain extract_terrain(const Context& context, RaySource& source, const TerrainOptions& options) {
  if (!(options.gradient > 0.0 && std::isfinite(options.gradient)))
    throw Error(ErrorCode::usage, "the gradient must be above 0");
  if (!(options.tolerance >= 0.0 && std::isfinite(options.tolerance)))
    throw Error(ErrorCode::usage, "the tolerance must be 0 or more");
  TerrainSurvey survey;
  survey_terrain(context, source, survey);
  if (survey.bounded == 0) throw Error(ErrorCode::no_data, "has no bounded rays, so there is no ground");
  const PlanRaster raster = raster_over(survey);
  source.rewind();
  std::vector<GroundSite> sites = ground_sites(context, source, raster, options.gradient);
  keep_ground(context, sites, raster, options.gradient);
  source.rewind();
  const std::vector<Eigen::Vector3d> ground =
      ground_heights(context, source, sites, raster, options.gradient);
  check_cancelled(context);
  Terrain terrain{.mesh = greedy_mesh(context, ground, options.tolerance, spread_evenly(ground, raster)),
                  .stream = survey.stream,
                  .bounded = survey.bounded,
                  .cell = raster.width,
                  .heights = ground.size()};
  if (terrain.mesh.empty())
    throw Error(
        ErrorCode::no_data,
        "no ground is found: too few ends, all on one line of the map, or all steeper than the gradient");
  return terrain;
}

}  // namespace ray
