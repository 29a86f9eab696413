#include "ground_sites.h"

#include "free_space_below.h"
#include "low_levels.h"
#include "plane_fit.h"

#include <raycloud/exec/parallel.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <tuple>

namespace ray {
namespace {

constexpr double kLeastWindow = 0.15;  // m; ends this much higher or lower support each other
constexpr double kLeastShare = 0.005;  // of the ends of a neighbourhood
constexpr std::uint32_t kLeastEnds = 3;
constexpr std::uint64_t kNeighbourhood = 12;  // ends that make one
constexpr std::int64_t kMostRings = 6;

/// Which level of each cell is the ground; kNoLevel where none is.
class LevelChoice {
 public:
  LevelChoice(const LowestEnds& cells, double gradient)
      : cells_(cells), raster_(cells.raster()), window_(std::max(kLeastWindow, gradient * raster_.width)) {}

  /// The lowest from level `from` on that has support.
  [[nodiscard]] std::uint8_t lowest_supported(std::size_t cell, std::size_t from) const {
    if (cells_.count(cell) == 0) return kNoLevel;
    const std::int64_t rings = rings_of(cell);
    const LowLevels& levels = cells_.levels(cell);
    for (std::size_t i = from; i < kLowLevels && levels[i].count > 0; ++i)
      if (has_support(cell, i, rings)) return static_cast<std::uint8_t>(i);
    return kNoLevel;
  }

  [[nodiscard]] bool is_pit(std::size_t cell, const std::vector<std::uint8_t>& chosen) const {
    return is_hole_of_few(cell, chosen) || is_below_all(cell, chosen) || is_behind_ground(cell, chosen);
  }

  /// How far under a site a ray must pass for the ground of its cell not to be in between.
  [[nodiscard]] double surely_below() const { return 1.5 * window_; }

  [[nodiscard]] GroundSite site(std::size_t cell, std::size_t level) const {
    return {cells_.place(cell, level), true};
  }

 private:
  /// Whether the level has few of the cell's ends and lies in a hole below the plane through the sites
  /// around; if the cell itself has too few ends to tell, these must be a smooth ground.
  [[nodiscard]] bool is_hole_of_few(std::size_t cell, const std::vector<std::uint8_t>& chosen) const {
    constexpr double kFew = 0.25;
    constexpr std::uint32_t kMany = 4;
    constexpr double kSmooth = 0.3;  // of the depth of the hole
    constexpr std::size_t kLeastSites = 6;
    const LowLevel& level = cells_.levels(cell)[chosen[cell]];
    if (level.count > 1 && static_cast<double>(level.count) > kFew * cells_.count(cell)) return false;
    const Eigen::Vector3d own = cells_.place(cell, chosen[cell]);
    std::vector<Eigen::Vector3d> around;
    for (std::int64_t rings = 1; rings <= kMostRings; ++rings) {
      around.clear();
      raster_.around(
          cell,
          [&](std::size_t near) {
            if (near != cell && chosen[near] != kNoLevel)
              around.push_back(cells_.place(near, chosen[near]) - own);
          },
          rings);
      if (around.size() < kLeastSites) continue;
      if (std::none_of(around.begin(), around.end(), [](const auto& site) { return site.z() > kLeastPit; }))
        return false;
      const double deep = depth(static_cast<double>(rings));
      const PlaneFit::Plane plane = plane_without_pits(around, deep);
      if (plane.error < kSmooth * plane.height) return plane.height > kLeastPit;
      return plane.height > deep && cells_.count(cell) >= kMany;
    }
    return false;
  }

  /// Through the points, but for the few that lie that deep below the others.
  static PlaneFit::Plane plane_without_pits(std::vector<Eigen::Vector3d>& points, double deep) {
    constexpr std::size_t kFewOf = 6;  // one pit among so many
    PlaneFit all;
    for (const Eigen::Vector3d& point : points)
      all.add(point);
    const PlaneFit::Plane plane = all.plane();
    if (plane.error < 0.3 * deep) return plane;
    const auto above = [&](const Eigen::Vector3d& point) {
      return point.z() - plane.height - plane.slope.dot(point.head<2>());
    };
    const auto lowest = points.begin() + static_cast<std::ptrdiff_t>(points.size() / kFewOf);
    std::nth_element(points.begin(), lowest, points.end(), [&](const auto& a, const auto& b) {
      return std::make_tuple(above(a), a.x(), a.y()) < std::make_tuple(above(b), b.x(), b.y());
    });
    PlaneFit others;
    for (auto point = points.begin(); point < points.end(); ++point)
      if (point >= lowest || above(*point) > -0.5 * deep) others.add(*point);
    return others.plane();
  }

  /// Whether it is a lone end below every site of two rings around.
  [[nodiscard]] bool is_below_all(std::size_t cell, const std::vector<std::uint8_t>& chosen) const {
    constexpr int kLeastSites = 6;
    if (cells_.levels(cell)[chosen[cell]].count > 1) return false;
    const Eigen::Vector3d own = cells_.place(cell, chosen[cell]);
    int count = 0;
    bool is_lowest = true;
    raster_.around(
        cell,
        [&](std::size_t near) {
          if (near == cell || chosen[near] == kNoLevel) return;
          ++count;
          if (cells_.place(near, chosen[near]).z() < own.z() + depth(1.0)) is_lowest = false;
        },
        2);
    return is_lowest && count >= kLeastSites;
  }

  /// Whether it is of few ends and the ray to it passes under the sites on its last bit of way, and these
  /// lie smoothly behind each other, as a ground does and the leaves of a crown do not.
  [[nodiscard]] bool is_behind_ground(std::size_t cell, const std::vector<std::uint8_t>& chosen) const {
    constexpr std::uint32_t kFewEnds = 2;
    constexpr int kLeastSites = 3;
    constexpr double kWay = 24.0;    // cells
    constexpr double kSteep = 0.05;  // m beside each m down
    const LowLevel& level = cells_.levels(cell)[chosen[cell]];
    if (level.count > kFewEnds) return false;
    const Eigen::Vector3d to_sensor(level.to_sensor[0], level.to_sensor[1], level.to_sensor[2]);
    const double run = to_sensor.head<2>().norm();
    if (!(run > kSteep * std::abs(to_sensor.z()))) return false;
    const auto way = static_cast<std::int64_t>(std::min(kWay, run / raster_.width));
    const Eigen::Vector3d own = cells_.place(cell, chosen[cell]);
    const Eigen::Vector3d step = raster_.width / run * to_sensor;
    int above = 0;
    Eigen::Vector3d last = own;
    for (std::int64_t i = 1; i <= way && above < kLeastSites; ++i) {
      const Eigen::Vector3d on_ray = own + static_cast<double>(i) * step;
      const auto lowest = lowest_near(on_ray, cell, chosen);
      if (!lowest || *lowest == last) continue;
      if (lowest->z() < on_ray.z() + depth(1.0)) break;
      if (above > 0 && std::abs(lowest->z() - last.z()) > 1.5 * window_) break;
      last = *lowest;
      ++above;
    }
    return above >= kLeastSites;
  }

  /// The lowest site of the cells around a place, but for that of one cell.
  [[nodiscard]] std::optional<Eigen::Vector3d> lowest_near(const Eigen::Vector3d& place, std::size_t but_for,
                                                           const std::vector<std::uint8_t>& chosen) const {
    std::optional<Eigen::Vector3d> lowest;
    const auto cell = raster_.find(place.x(), place.y());
    if (!cell) return lowest;
    raster_.around(*cell, [&](std::size_t near) {
      if (near == but_for || chosen[near] == kNoLevel) return;
      const Eigen::Vector3d site = cells_.place(near, chosen[near]);
      if (!lowest || site.z() < lowest->z()) lowest = site;
    });
    return lowest;
  }

  /// How far below others a pit is: more than `rings` cells of ground fall with the gradient, for which a
  /// third has proved enough.
  [[nodiscard]] double depth(double rings) const { return std::max(kLeastPit, kPitDepth * rings * window_); }

  /// How many rings of cells have enough ends to judge by.
  [[nodiscard]] std::int64_t rings_of(std::size_t cell) const {
    for (std::int64_t rings = 1; rings < kMostRings; ++rings) {
      std::uint64_t ends = 0;
      raster_.around(
          cell, [&](std::size_t near) { ends += cells_.count(near); }, rings);
      if (ends >= kNeighbourhood) return rings;
    }
    return kMostRings;
  }

  [[nodiscard]] bool has_support(std::size_t cell, std::size_t i, std::int64_t rings) const {
    const auto reach =
        static_cast<std::int64_t>(std::ceil(static_cast<double>(rings) * window_ / cells_.level_height()));
    const std::int64_t number = cells_.levels(cell)[i].number;
    std::uint64_t support = 0;
    std::uint64_t all = 0;
    raster_.around(
        cell,
        [&](std::size_t near) {
          if (cells_.count(near) == 0) return;
          all += cells_.count(near);
          for (const LowLevel& other : cells_.levels(near)) {
            if (other.count == 0) break;
            if (std::abs(std::int64_t{other.number} - number) <= reach) support += other.count;
          }
        },
        rings);
    return support >= kLeastEnds && static_cast<double>(support) >= kLeastShare * static_cast<double>(all);
  }

  static constexpr double kLeastPit = 0.2;   // m
  static constexpr double kPitDepth = 0.35;  // of the height that the gradient gives over the neighbourhood

  const LowestEnds& cells_;
  const PlanRaster& raster_;
  double window_;
};

}  // namespace

std::vector<GroundSite> ground_sites(const Context& context, RaySource& source, const PlanRaster& raster,
                                     double gradient) {
  constexpr int kRounds = 3;  // pits beside pits
  const LowestEnds cells(context, source, raster);
  const LevelChoice choice(cells, gradient);
  std::vector<std::uint8_t> chosen(raster.size());
  const auto for_cells = [&](const auto& visit) {
    parallel_for(context, raster.size(), 4096, [&](std::size_t begin, std::size_t end) {
      for (std::size_t cell = begin; cell < end; ++cell)
        visit(cell);
    });
  };
  for_cells([&](std::size_t cell) { chosen[cell] = choice.lowest_supported(cell, 0); });
  std::vector<std::uint8_t> is_asked(raster.size(), 1);
  for (int round = 0; round < kRounds; ++round) {
    std::vector<std::uint8_t> better = chosen;
    for_cells([&](std::size_t cell) {
      if (is_asked[cell] != 0 && chosen[cell] != kNoLevel && choice.is_pit(cell, chosen))
        better[cell] = choice.lowest_supported(cell, chosen[cell] + 1);
    });
    // Next time those that have seen something change.
    std::fill(is_asked.begin(), is_asked.end(), std::uint8_t{0});
    for (std::size_t cell = 0; cell < chosen.size(); ++cell) {
      if (better[cell] != chosen[cell])
        raster.around(
            cell, [&](std::size_t near) { is_asked[near] = 1; }, 2);
    }
    chosen = std::move(better);
  }
  const std::vector<std::uint8_t> refuted =
      sites_over_free_space(context, cells, chosen, choice.surely_below());
  std::vector<GroundSite> sites(raster.size());
  for_cells([&](std::size_t cell) {
    if (chosen[cell] != kNoLevel && refuted[cell] == 0) sites[cell] = choice.site(cell, chosen[cell]);
  });
  return sites;
}

}  // namespace ray
