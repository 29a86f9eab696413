#include "ground_sites.h"

#include "disjoint_sets.h"

#include <raycloud/mesh/cone_envelope.h>

#include <Eigen/LU>
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

/// A plane through points by least squares.
struct PlaneFit {
  int count = 0;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  Eigen::Matrix3d products = Eigen::Matrix3d::Zero();

  void add(const Eigen::Vector3d& point) {
    ++count;
    sum += point;
    products += point * point.transpose();
  }
  [[nodiscard]] double height_at_origin() const {
    const Eigen::Vector3d mean = sum / count;
    const Eigen::Matrix3d spread = products - count * mean * mean.transpose();
    const Eigen::Matrix2d plan = spread.topLeftCorner<2, 2>();
    const double extent = plan.trace();
    if (!(plan.determinant() > 0.01 * extent * extent)) return mean.z();  // all on a line
    const Eigen::Vector2d slope = plan.inverse() * spread.topRightCorner<2, 1>();
    return mean.z() - slope.dot(mean.head<2>());
  }
};

/// Which level of each cell is the ground; kLevels where none is.
class LevelChoice {
 public:
  LevelChoice(const std::vector<LowLevels>& cells, const PlanRaster& raster, double gradient)
      : cells_(cells), raster_(raster), window_(std::max(kLeastWindow, gradient * raster.width)) {}

  /// The lowest from level `from` on that has support.
  [[nodiscard]] std::size_t lowest_supported(std::size_t cell, std::size_t from) const {
    if (cells_[cell].count == 0) return kLevels;
    const std::int64_t rings = rings_of(cell);
    for (std::size_t i = from; i < kLevels && cells_[cell].levels[i].count > 0; ++i)
      if (has_support(cell, i, rings)) return i;
    return kLevels;
  }

  /// Whether the level has few of the cell's ends and lies in a hole below the plane through the sites
  /// around.
  [[nodiscard]] bool is_pit(std::size_t cell, const std::vector<std::size_t>& chosen) const {
    const Level& level = cells_[cell].levels[chosen[cell]];
    if (level.count > 1 && static_cast<double>(level.count) > kPitShare * cells_[cell].count) return false;
    const Eigen::Vector3d own = site(cell, chosen[cell]).place;
    for (std::int64_t rings = 1; rings <= kMostRings; ++rings) {
      PlaneFit fit;
      raster_.around(
          cell,
          [&](std::size_t near) {
            if (near != cell && chosen[near] < kLevels) fit.add(site(near, chosen[near]).place - own);
          },
          rings);
      if (fit.count < kPitNeighbours) continue;
      return fit.height_at_origin() > std::max(kLeastPit, kPitDepth * static_cast<double>(rings) * window_);
    }
    return false;
  }

  [[nodiscard]] GroundSite site(std::size_t cell, std::size_t i) const {
    const Level& level = cells_[cell].levels[i];
    const Eigen::Vector2d corner = raster_.centre(cell).array() - 0.5 * raster_.width;
    const Eigen::Vector3d mean = Eigen::Vector3d(level.sum[0], level.sum[1], level.sum[2]) / level.count;
    return {mean + Eigen::Vector3d(corner.x(), corner.y(), level.number * level_height()), true};
  }

 private:
  static constexpr double kPitShare = 0.25;
  static constexpr int kPitNeighbours = 6;
  static constexpr double kLeastPit = 0.2;   // m
  static constexpr double kPitDepth = 0.35;  // of the height that the gradient gives over the neighbourhood
  static constexpr std::uint64_t kNeighbourhood = 12;  // ends that make one
  static constexpr std::int64_t kMostRings = 6;

  /// How many rings of cells have enough ends to judge by.
  [[nodiscard]] std::int64_t rings_of(std::size_t cell) const {
    for (std::int64_t rings = 1; rings < kMostRings; ++rings) {
      std::uint64_t ends = 0;
      raster_.around(
          cell, [&](std::size_t near) { ends += cells_[near].count; }, rings);
      if (ends >= kNeighbourhood) return rings;
    }
    return kMostRings;
  }

  [[nodiscard]] bool has_support(std::size_t cell, std::size_t i, std::int64_t rings) const {
    const auto reach =
        static_cast<std::int64_t>(std::ceil(static_cast<double>(rings) * window_ / level_height()));
    std::uint64_t support = 0;
    std::uint64_t all = 0;
    raster_.around(
        cell,
        [&](std::size_t near) {
          all += cells_[near].count;
          for (const Level& other : cells_[near].levels) {
            const std::int64_t apart = std::int64_t{other.number} - cells_[cell].levels[i].number;
            if (other.count > 0 && std::abs(apart) <= reach) support += other.count;
          }
        },
        rings);
    return support >= kLeastEnds && static_cast<double>(support) >= kLeastShare * static_cast<double>(all);
  }

  [[nodiscard]] double level_height() const { return 0.5 * raster_.width; }
  const std::vector<LowLevels>& cells_;
  const PlanRaster& raster_;
  double window_;
};

}  // namespace

std::vector<GroundSite> ground_sites(const Context& context, RaySource& source, const PlanRaster& raster,
                                     double gradient) {
  constexpr int kRounds = 3;  // pits beside pits
  const std::vector<LowLevels> cells = columns_of(context, source, raster, 0.5 * raster.width);
  const LevelChoice choice(cells, raster, gradient);
  std::vector<std::size_t> chosen(raster.size());
  const auto for_cells = [&](const auto& visit) {
    parallel_for(context, raster.size(), 4096, [&](std::size_t begin, std::size_t end) {
      for (std::size_t cell = begin; cell < end; ++cell)
        visit(cell);
    });
  };
  for_cells([&](std::size_t cell) { chosen[cell] = choice.lowest_supported(cell, 0); });
  for (int round = 0; round < kRounds; ++round) {
    std::vector<std::size_t> better = chosen;
    for_cells([&](std::size_t cell) {
      if (chosen[cell] < kLevels && choice.is_pit(cell, chosen))
        better[cell] = choice.lowest_supported(cell, chosen[cell] + 1);
    });
    if (better == chosen) break;
    chosen = std::move(better);
  }
  std::vector<GroundSite> sites(raster.size());
  for_cells([&](std::size_t cell) {
    if (chosen[cell] < kLevels) sites[cell] = choice.site(cell, chosen[cell]);
  });
  return sites;
}

void remove_raised(std::vector<GroundSite>& sites, const PlanRaster& raster, double gradient) {
  constexpr double kStep = 0.15;  // m; no step at all
  constexpr double kRaisedShare = 0.75;
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
  std::vector<std::uint32_t> borders(sites.size());
  std::vector<std::uint32_t> raised(sites.size());  // borders where the part is higher
  for (bool changed = true; changed;) {
    changed = false;
    std::fill(borders.begin(), borders.end(), 0);
    std::fill(raised.begin(), raised.end(), 0);
    for (std::size_t cell = 0; cell < sites.size(); ++cell) {
      if (!sites[cell].is_there) continue;
      raster.around(cell, [&](std::size_t near) {
        if (!sites[near].is_there || part[near] == part[cell]) return;
        ++borders[part[cell]];
        if (sites[cell].place.z() > sites[near].place.z()) ++raised[part[cell]];
      });
    }
    for (std::size_t cell = 0; cell < sites.size(); ++cell) {
      if (!sites[cell].is_there || part[cell] == largest) continue;
      if (raised[part[cell]] <= kRaisedShare * borders[part[cell]]) continue;
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
