#include "convex_region.h"
#include "part_sorter.h"
#include "require.h"

#include <raycloud/core/error.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace ray {
namespace {

constexpr std::int64_t kMostCells = 4096;  // that a ray may cross

[[noreturn]] void fail_small() {
  throw Error(ErrorCode::out_of_range, "the cells are too small: a ray crosses more than " +
                                           std::to_string(kMostCells) + " of them: use wider cells");
}

/// One split axis of space or time.
struct Axis {
  int index = 0;  ///< in a PartKey; 3 is time
  double width = 0.0;

  /// The cell of a coordinate.
  [[nodiscard]] std::int64_t cell(double x) const {
    const double number = std::floor(x / width + 0.5);
    if (!(std::abs(number) < 0x1p52)) {
      throw Error(ErrorCode::out_of_range,
                  "the cells are too small: there are more than 2^52 of them "
                  "between the cloud and the origin");
    }
    return static_cast<std::int64_t>(number);
  }
  /// The first cell whose upper border is not below.
  [[nodiscard]] std::int64_t first_cell(double x) const {
    const std::int64_t number = cell(x);
    return border(number) == x ? number - 1 : number;
  }
  /// Where that cell begins.
  [[nodiscard]] double border(std::int64_t number) const {
    return (static_cast<double>(number) - 0.5) * width;
  }
};

/// A border that a ray crosses.
struct BorderCrossing {
  double t = 0.0;  ///< 0 at the start, 1 at the end
  int axis = 0;
  double at = 0.0;        ///< m
  std::int64_t cell = 0;  ///< of the axis, from there on
};

class GridRule : public PartitionRule {
 public:
  explicit GridRule(const GridOptions& options) : stored_(options.stored) {
    for (int axis = 0; axis < 3; ++axis) {
      if (options.widths[axis] > 0.0) axes_.push_back({axis, options.widths[axis]});
    }
    if (options.period > 0.0) period_ = {3, options.period};
  }

  std::vector<ColumnInfo> columns(std::vector<ColumnInfo> source) const override {
    return cuts() ? with_clipped(std::move(source)) : source;
  }

 protected:
  /// A grid in time alone sorts rays whole.
  [[nodiscard]] bool cuts() const { return !axes_.empty(); }
  [[nodiscard]] PartKey key_of(const Eigen::Vector3d& point, double time) const {
    PartKey key{};
    for (const Axis& axis : axes_)
      key[static_cast<std::size_t>(axis.index)] = axis.cell(point[axis.index]);
    if (period_.width > 0.0) key[3] = period_.cell(time);
    return key;
  }

  std::vector<Axis> axes_;  ///< of space
  Axis period_;
  Precision stored_;
};

/// Cells side by side.
class CellRule final : public GridRule {
 public:
  using GridRule::GridRule;

  void apply(const RayCloud& rays, PartitionedChunk& parts) const override {
    PartSorter sorter;
    std::vector<BorderCrossing> crossings;
    std::vector<Stretch> way;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const PartKey first = key_of(rays.starts[i], rays.times[i]);
      const PartKey last = key_of(rays.ends[i], rays.times[i]);
      if (first == last) {
        sorter.add(sorter.part(last), i);
        continue;
      }
      find_crossings(rays.starts[i], rays.ends[i], first, last, crossings);
      follow(rays.starts[i], rays.ends[i], first, crossings, sorter, way);
      each_piece(rays.starts[i], rays.bounded[i] != 0, way,
                 [&](std::uint32_t part, const Eigen::Vector3d& start, const Eigen::Vector3d& end,
                     std::uint8_t flags) { sorter.add(part, i, start, end, flags); });
    }
    sorter.gather(rays, cuts(), parts);
  }

 private:
  void find_crossings(const Eigen::Vector3d& start, const Eigen::Vector3d& end, const PartKey& first,
                      const PartKey& last, std::vector<BorderCrossing>& crossings) const {
    crossings.clear();
    for (const Axis& axis : axes_) {
      const auto a = static_cast<std::size_t>(axis.index);
      if (std::abs(last[a] - first[a]) > kMostCells) fail_small();
      const std::int64_t step = last[a] > first[a] ? 1 : -1;
      for (std::int64_t cell = first[a]; cell != last[a]; cell += step) {
        const double at = axis.border(step > 0 ? cell + 1 : cell);
        const double t = (at - start[axis.index]) / (end[axis.index] - start[axis.index]);
        crossings.push_back({t, axis.index, at, cell + step});
      }
    }
    if (crossings.size() > static_cast<std::size_t>(kMostCells)) fail_small();
    // Borders of an axis stay in their order where rounding makes them equal.
    std::stable_sort(crossings.begin(), crossings.end(),
                     [](const BorderCrossing& a, const BorderCrossing& b) { return a.t < b.t; });
  }

  void follow(const Eigen::Vector3d& start, const Eigen::Vector3d& end, PartKey key,
              const std::vector<BorderCrossing>& crossings, PartSorter& sorter,
              std::vector<Stretch>& way) const {
    way.clear();
    for (const BorderCrossing& crossing : crossings) {
      // Start and end are judged by themselves, so rounding may put a border before the one or behind the
      // other.
      Eigen::Vector3d point = crossing.t <= 0.0 ? start : end;
      if (crossing.t > 0.0 && crossing.t < 1.0) {
        point = start + crossing.t * (end - start);
        point[crossing.axis] = crossing.at;
        point = cut_point(start, end, point, stored_);
      }
      way.push_back({sorter.part(key), point});
      key[static_cast<std::size_t>(crossing.axis)] = crossing.cell;
    }
    way.push_back({sorter.part(key), end});
  }
};

/// Cells that reach into each other.
class OverlapRule final : public GridRule {
 public:
  explicit OverlapRule(const GridOptions& options) : GridRule(options), half_(options.overlap / 2.0) {}

  void apply(const RayCloud& rays, PartitionedChunk& parts) const override {
    PartSorter sorter;
    std::vector<Stretch> way;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const Eigen::Vector3d low = rays.starts[i].cwiseMin(rays.ends[i]).array() - half_;
      const Eigen::Vector3d high = rays.starts[i].cwiseMax(rays.ends[i]).array() + half_;
      PartKey first = key_of(low, rays.times[i]);
      const PartKey last = key_of(high, rays.times[i]);
      for (const Axis& axis : axes_)
        first[static_cast<std::size_t>(axis.index)] = axis.first_cell(low[axis.index]);
      std::int64_t crossed = 1;
      for (std::size_t a = 0; a < 3; ++a)
        crossed += last[a] - first[a];
      if (crossed > kMostCells) fail_small();
      add_cells(rays, i, first, last, sorter, way);
    }
    sorter.gather(rays, cuts(), parts);
  }

 private:
  [[nodiscard]] Box box_of(const PartKey& key) const {
    Box box{Eigen::Vector3d::Constant(-HUGE_VAL), Eigen::Vector3d::Constant(HUGE_VAL)};
    for (const Axis& axis : axes_) {
      const std::int64_t cell = key[static_cast<std::size_t>(axis.index)];
      box.low[axis.index] = axis.border(cell) - half_;
      box.high[axis.index] = axis.border(cell + 1) + half_;
    }
    return box;
  }

  /// Halves the block of cells until it is one cell or the ray passes it by.
  void add_cells(const RayCloud& rays, std::size_t i, const PartKey& first, const PartKey& last,
                 PartSorter& sorter, std::vector<Stretch>& way) const {
    const Box low = box_of(first), high = box_of(last);
    const Box block{low.low, high.high};
    const std::uint32_t end_part = way_through(block, rays.starts[i], rays.ends[i], stored_, way);
    if (way.empty() && end_part == 1) return;
    std::size_t widest = 0;
    for (std::size_t a = 1; a < 3; ++a) {
      if (last[a] - first[a] > last[widest] - first[widest]) widest = a;
    }
    if (last[widest] == first[widest]) {
      add_inside(rays, i, first, sorter, way);
      return;
    }
    PartKey middle_last = last, middle_first = first;
    middle_last[widest] = first[widest] + (last[widest] - first[widest]) / 2;
    middle_first[widest] = middle_last[widest] + 1;
    add_cells(rays, i, first, middle_last, sorter, way);
    add_cells(rays, i, middle_first, last, sorter, way);
  }

  /// The piece of the ray in one cell, whose way through the cell is `way`.
  void add_inside(const RayCloud& rays, std::size_t i, const PartKey& key, PartSorter& sorter,
                  std::vector<Stretch>& way) const {
    const std::uint32_t part = sorter.part(key);
    if (way.empty()) {
      sorter.add(part, i);
      return;
    }
    each_piece(rays.starts[i], rays.bounded[i] != 0, way,
               [&](std::uint32_t side, const Eigen::Vector3d& start, const Eigen::Vector3d& end,
                   std::uint8_t flags) {
                 if (side == 0) sorter.add(part, i, start, end, flags);
               });
  }

  double half_;  // m
};

}  // namespace

PartitionRulePtr partition_by_grid(const GridOptions& options) {
  const auto require = [](bool sensible, const char* message) {
    if (!sensible) throw Error(ErrorCode::usage, message);
  };
  require(options.widths.allFinite() && (options.widths.array() >= 0.0).all() &&
              std::isfinite(options.period) && options.period >= 0.0,
          "the widths of the cells must be 0 or more");
  require((options.widths.array() > 0.0).any() || options.period > 0.0,
          "at least one width of the cells must be more than 0");
  require(std::isfinite(options.overlap) && options.overlap >= 0.0, "the overlap must be 0 or more");
  for (const double width : options.widths)
    require(width == 0.0 || options.overlap <= width, "the overlap must not be larger than a cell");
  if (options.overlap > 0.0) return std::make_unique<OverlapRule>(options);
  return std::make_unique<CellRule>(options);
}

}  // namespace ray
