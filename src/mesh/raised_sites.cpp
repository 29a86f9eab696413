#include "raised_sites.h"

#include "plan_opening.h"
#include "plane_fit.h"

#include <raycloud/exec/parallel.h>
#include <raycloud/mesh/cone_envelope.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace ray {
namespace {

constexpr std::int64_t kWidestRings = 6;

/// How many rings of cells around each site hold enough others to lay a plane through.
std::vector<std::uint8_t> neighbourhoods(const Context& context, const std::vector<GroundSite>& sites,
                                         const PlanRaster& raster) {
  constexpr int kEnough = 12;
  std::vector<std::uint8_t> rings(sites.size(), 2);
  parallel_for(context, sites.size(), 4096, [&](std::size_t begin, std::size_t end) {
    for (std::size_t cell = begin; cell < end; ++cell) {
      if (!sites[cell].is_there) continue;
      for (; rings[cell] < kWidestRings; ++rings[cell]) {
        int count = 0;
        raster.around(
            cell, [&](std::size_t near) { count += sites[near].is_there ? 1 : 0; }, rings[cell]);
        if (count > kEnough) break;
      }
    }
  });
  return rings;
}

}  // namespace

std::vector<std::uint8_t> raised_sites(const Context& context, const std::vector<GroundSite>& sites,
                                       const PlanRaster& raster) {
  constexpr double kLeastStep = 0.1;  // m
  constexpr double kSlope = 0.15;     // m for each m of the window's half width
  constexpr double kWidest = 30.0;    // m
  constexpr double kGrowth = 1.2;
  constexpr float kNone = std::numeric_limits<float>::infinity();
  std::vector<std::uint8_t> raised(sites.size(), 0);
  std::vector<float> heights(sites.size(), kNone);
  const auto first =
      std::find_if(sites.begin(), sites.end(), [](const GroundSite& site) { return site.is_there; });
  if (first == sites.end()) return raised;
  const double base = first->place.z();
  for (std::size_t i = 0; i < sites.size(); ++i)
    if (sites[i].is_there) heights[i] = static_cast<float>(sites[i].place.z() - base);
  const std::int64_t most =
      std::min(static_cast<std::int64_t>(kWidest / raster.width), std::max(raster.columns, raster.rows));
  std::vector<float> opened(heights.size());
  std::int64_t radius = 1;
  while (radius <= most) {
    std::copy(heights.begin(), heights.end(), opened.begin());
    opened = plan_opening(context, std::move(opened), raster, radius);
    const auto step = static_cast<float>(kLeastStep + kSlope * static_cast<double>(radius) * raster.width);
    parallel_for(context, sites.size(), 16384, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        if (heights[i] == kNone) continue;
        if (heights[i] - opened[i] > step) raised[i] = 1;
        heights[i] = opened[i];
      }
    });
    radius = std::max(radius + 1, static_cast<std::int64_t>(static_cast<double>(radius) * kGrowth));
  }
  return raised;
}

std::vector<std::uint8_t> sites_above_cones(const Context& context, const std::vector<GroundSite>& sites,
                                            double gradient) {
  std::vector<Eigen::Vector3d> places;
  for (const GroundSite& site : sites)
    if (site.is_there) places.push_back(site.place);
  const std::vector<std::uint8_t> kept = cone_envelope(context, places, gradient);
  std::vector<std::uint8_t> above(sites.size(), 0);
  std::size_t next = 0;
  for (std::size_t i = 0; i < sites.size(); ++i)
    if (sites[i].is_there) above[i] = kept[next++] != 0 ? 0 : 1;
  return above;
}

void grow_ground(const Context& context, const std::vector<GroundSite>& sites, const PlanRaster& raster,
                 std::vector<std::uint8_t>& doubtful) {
  constexpr double kNear = 0.05;         // m; above or below the plane
  constexpr double kNearOfRadius = 0.1;  // and so much of the radius of the neighbourhood
  constexpr int kLeastSites = 5;
  const auto is_doubtful = [&](std::size_t cell) { return sites[cell].is_there && doubtful[cell] == 1; };
  const std::vector<std::uint8_t> rings = neighbourhoods(context, sites, raster);
  std::vector<std::uint32_t> front;
  for (std::size_t cell = 0; cell < sites.size(); ++cell)
    if (is_doubtful(cell)) front.push_back(static_cast<std::uint32_t>(cell));
  std::vector<std::uint8_t> waiting(sites.size(), 0);
  while (!front.empty()) {
    std::vector<std::uint8_t> joins(front.size(), 0);
    parallel_for(context, front.size(), 1024, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        const std::size_t cell = front[i];
        PlaneFit fit;
        raster.around(
            cell,
            [&](std::size_t near) {
              if (sites[near].is_there && doubtful[near] == 0) fit.add(sites[near].place - sites[cell].place);
            },
            rings[cell]);
        const double near = kNear + kNearOfRadius * raster.width * rings[cell];
        joins[i] = fit.count >= kLeastSites && std::abs(fit.plane().height) <= near ? 1 : 0;
      }
    });
    std::vector<std::uint32_t> next;
    for (std::size_t i = 0; i < front.size(); ++i)
      if (joins[i] != 0) doubtful[front[i]] = 0;
    for (std::size_t i = 0; i < front.size(); ++i) {
      if (joins[i] == 0) continue;
      raster.around(
          front[i],
          [&](std::size_t near) {
            if (!is_doubtful(near) || waiting[near] != 0) return;
            waiting[near] = 1;
            next.push_back(static_cast<std::uint32_t>(near));
          },
          rings[front[i]]);
    }
    for (const std::uint32_t cell : next)
      waiting[cell] = 0;
    front = std::move(next);
  }
}

}  // namespace ray
