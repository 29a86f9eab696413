#include "ground_sites.h"

#include "disjoint_sets.h"

#include <raycloud/mesh/cone_envelope.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace ray {
namespace {

constexpr std::size_t kLevels = 6;     // the lowest of a cell that are remembered
constexpr double kLeastWindow = 0.15;  // m; ends this much higher or lower support each other
constexpr double kLeastShare = 0.005;  // of the ends of a neighbourhood
constexpr std::uint32_t kLeastEnds = 3;

/// The ends of a cell within a height of half its width.
struct Level {
  std::int32_t number = std::numeric_limits<std::int32_t>::max();
  std::uint32_t count = 0;
  std::array<float, 3> sum{};  ///< of coordinates from the corner of the cell and the foot of the level, m
};

struct LowLevels {
  std::array<Level, kLevels> levels;  ///< from the lowest up
  std::uint32_t count = 0;

  void add(std::int32_t number, const Eigen::Vector3f& at) {
    ++count;
    std::size_t i = 0;
    while (i < kLevels && levels[i].number < number)
      ++i;
    if (i == kLevels) return;
    if (levels[i].number != number) {
      std::move_backward(levels.begin() + static_cast<std::ptrdiff_t>(i), levels.end() - 1, levels.end());
      levels[i] = {number, 0, {}};
    }
    ++levels[i].count;
    for (std::size_t axis = 0; axis < 3; ++axis)
      levels[i].sum[axis] += at[static_cast<Eigen::Index>(axis)];
  }
};

struct LowEnd {
  std::uint32_t cell = 0;
  std::int32_t level = 0;
  Eigen::Vector3f at;
};

std::vector<LowEnd> low_ends(const RayCloud& rays, const PlanRaster& raster, double level_height) {
  std::vector<LowEnd> ends;
  ends.reserve(rays.size());
  for (std::size_t i = 0; i < rays.size(); ++i) {
    if (rays.bounded[i] == 0) continue;
    const Eigen::Vector3d& end = rays.ends[i];
    const auto cell = raster.find(end.x(), end.y());
    const double level = std::floor(end.z() / level_height);
    if (!cell || std::abs(level) > 1e9) continue;
    const Eigen::Vector2d corner = raster.centre(*cell).array() - 0.5 * raster.width;
    ends.push_back(
        {static_cast<std::uint32_t>(*cell), static_cast<std::int32_t>(level),
         Eigen::Vector3d(end.x() - corner.x(), end.y() - corner.y(), end.z() - level * level_height)
             .cast<float>()});
  }
  return ends;
}

std::vector<LowLevels> columns_of(const Context& context, RaySource& source, const PlanRaster& raster,
                                  double level_height) {
  std::vector<LowLevels> columns(raster.size());
  stream(
      context, source, nullptr, [&](RayCloud& rays) { return low_ends(rays, raster, level_height); },
      [&](RayCloud&, const std::vector<LowEnd>& ends) {
        for (const LowEnd& end : ends)
          columns[end.cell].add(end.level, end.at);
      });
  return columns;
}

}  // namespace

std::vector<GroundSite> ground_sites(const Context& context, RaySource& source, const PlanRaster& raster,
                                     double gradient) {
  const double level_height = 0.5 * raster.width;
  const std::vector<LowLevels> columns = columns_of(context, source, raster, level_height);
  const double window = std::max(kLeastWindow, gradient * raster.width);
  const auto reach = static_cast<std::int64_t>(std::ceil(window / level_height));
  std::vector<GroundSite> sites(raster.size());
  parallel_for(context, raster.size(), 4096, [&](std::size_t begin, std::size_t end) {
    for (std::size_t cell = begin; cell < end; ++cell) {
      for (const Level& level : columns[cell].levels) {
        if (level.count == 0) break;
        std::uint64_t support = 0;
        std::uint64_t all = 0;
        raster.around(cell, [&](std::size_t near) {
          all += columns[near].count;
          for (const Level& other : columns[near].levels) {
            if (other.count == 0) break;
            if (std::abs(std::int64_t{other.number} - level.number) <= reach) support += other.count;
          }
        });
        if (support < kLeastEnds || static_cast<double>(support) < kLeastShare * static_cast<double>(all))
          continue;
        const Eigen::Vector2d corner = raster.centre(cell).array() - 0.5 * raster.width;
        const Eigen::Vector3d mean = Eigen::Vector3d(level.sum[0], level.sum[1], level.sum[2]) / level.count;
        sites[cell] = {mean + Eigen::Vector3d(corner.x(), corner.y(), level.number * level_height), true};
        break;
      }
    }
  });
  return sites;
}

void remove_raised(std::vector<GroundSite>& sites, const PlanRaster& raster, double gradient) {
  constexpr double kStep = 0.15;  // m; no step at all
  DisjointSets parts(sites.size());
  const auto connected = [&](const GroundSite& a, const GroundSite& b) {
    const Eigen::Vector3d between = b.place - a.place;
    return std::abs(between.z()) <= gradient * between.head<2>().norm() + kStep;
  };
  for (std::size_t cell = 0; cell < sites.size(); ++cell) {
    if (!sites[cell].is_there) continue;
    raster.around(cell, [&](std::size_t near) {
      if (near < cell && sites[near].is_there && connected(sites[cell], sites[near]))
        parts.unite(static_cast<std::uint32_t>(cell), static_cast<std::uint32_t>(near));
    });
  }
  std::vector<std::uint32_t> part(sites.size());
  std::vector<std::uint32_t> size(sites.size(), 0);
  for (std::uint32_t cell = 0; cell < sites.size(); ++cell) {
    part[cell] = parts.find(cell);
    if (sites[cell].is_there) ++size[part[cell]];
  }
  const auto largest = static_cast<std::uint32_t>(std::max_element(size.begin(), size.end()) - size.begin());
  std::vector<std::int32_t> raised(sites.size());
  for (bool changed = true; changed;) {
    changed = false;
    std::fill(raised.begin(), raised.end(),
              0);  // borders where the part is higher, less those where it is lower
    for (std::size_t cell = 0; cell < sites.size(); ++cell) {
      if (!sites[cell].is_there) continue;
      raster.around(cell, [&](std::size_t near) {
        if (!sites[near].is_there || part[near] == part[cell]) return;
        raised[part[cell]] += sites[cell].place.z() > sites[near].place.z() ? 1 : -1;
      });
    }
    for (std::size_t cell = 0; cell < sites.size(); ++cell) {
      if (!sites[cell].is_there || part[cell] == largest || raised[part[cell]] <= 0) continue;
      sites[cell].is_there = false;
      changed = true;
    }
  }
}

void remove_above_cones(std::vector<GroundSite>& sites, double gradient) {
  std::vector<Eigen::Vector3d> places;
  for (const GroundSite& site : sites)
    if (site.is_there) places.push_back(site.place);
  const std::vector<std::uint8_t> kept = cone_envelope(places, gradient);
  std::size_t i = 0;
  for (GroundSite& site : sites)
    if (site.is_there) site.is_there = kept[i++] != 0;
}

}  // namespace ray
