#include "region_cells.h"
#include "transient_regions.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <utility>

namespace ray {

/// Divides cells among groups until each fits.
class CellGrouping {
 public:
  CellGrouping(const RegionCells& cells, std::span<const CellState> states, int spreads, std::size_t most)
      : cells_(cells),
        states_(states),
        spreads_(spreads),
        most_(most),
        stamps_(cells.size()),
        kinds_(cells.size()) {
    groups_.owner.assign(cells.size(), CellGroups::kNone);
    groups_.needed_by.resize(cells.size());
  }

  CellGroups run() {
    constexpr int kMostHalvings = 10;
    std::vector<std::uint32_t> cells = find_scored();
    divide(cells, kMostHalvings);
    return std::move(groups_);
  }

 private:
  struct Kinds {
    bool spreads = false;  ///< what is awake there may be reached from a source, or is one
    bool scores = false;   ///< a number may be above 0 before holes are filled
  };

  /// A set of cells that grows.
  class Region {
   public:
    Region(CellGrouping& of, std::span<const std::uint32_t> cells) : of_(of), stamp_(++of.stamp_) {
      for (const std::uint32_t cell : cells)
        add(cell);
    }
    void add(std::uint32_t cell) {
      if (std::exchange(of_.stamps_[cell], stamp_) != stamp_) cells_.push_back(cell);
    }
    /// All `other` of which `wanted(cell, other)`, near cells that the region has so far.
    template <class Wanted>
    void grow(const Wanted& wanted) {
      const std::size_t end = cells_.size();
      for (std::size_t i = std::exchange(begin_, end); i < end; ++i)
        for (const std::uint32_t other : of_.cells_.overlapping(cells_[i]))
          if (of_.stamps_[other] != stamp_ && wanted(cells_[i], other)) add(other);
    }
    /// The next step starts from all cells again, not only from those that were added last.
    void from_all() { begin_ = 0; }
    [[nodiscard]] const std::vector<std::uint32_t>& cells() const { return cells_; }

   private:
    CellGrouping& of_;
    std::uint32_t stamp_;
    std::vector<std::uint32_t> cells_;
    std::size_t begin_ = 0;
  };

  /// Whether an ellipsoid of `other` may hold a centre of the cell, or one that is awake.
  [[nodiscard]] bool holds(std::uint32_t other, std::uint32_t cell) const {
    return box(cell).exteriorDistance(box(other)) <= semi_axis(other);
  }
  [[nodiscard]] bool holds_awake(std::uint32_t other, std::uint32_t cell) const {
    const Eigen::AlignedBox3d& awake = states_[cell].awake;
    return !awake.isEmpty() && awake.exteriorDistance(box(other)) <= semi_axis(other);
  }
  [[nodiscard]] bool are_awake_together(std::uint32_t a, std::uint32_t b) const {
    const CellState &of_a = states_[a], &of_b = states_[b];
    return !of_a.awake.isEmpty() && !of_b.awake.isEmpty() &&
           of_a.awake.exteriorDistance(of_b.awake) <=
               static_cast<double>(std::max(of_a.awake_semi, of_b.awake_semi));
  }
  [[nodiscard]] Eigen::AlignedBox3d box(std::uint32_t cell) const {
    return RegionCells::box_of(cells_.cells_[cell].key);
  }
  [[nodiscard]] double semi_axis(std::uint32_t cell) const {
    return static_cast<double>(cells_.cells_[cell].semi);
  }

  /// All cells in which a number may be above 0 at the end.
  std::vector<std::uint32_t> find_scored() {
    std::vector<std::uint32_t> sources, scored;
    for (std::uint32_t i = 0; i < states_.size(); ++i)
      if (states_[i].is_source) sources.push_back(i);
    Region spread(*this, sources);
    for (int step = 0; step < spreads_; ++step)
      spread.grow([this](std::uint32_t a, std::uint32_t b) { return are_awake_together(a, b); });
    for (const std::uint32_t cell : spread.cells())
      kinds_[cell].spreads = true;
    for (std::uint32_t i = 0; i < states_.size(); ++i) {
      kinds_[i].scores = kinds_[i].spreads || states_[i].has_evidence;
      if (kinds_[i].scores) scored.push_back(i);
    }
    Region filled(*this, scored);
    filled.grow([this](std::uint32_t cell, std::uint32_t other) { return holds_awake(other, cell); });
    return filled.cells();
  }

  /// All that the numbers in some cells depend on: the steps of transient_regions, the last one first.
  std::vector<std::uint32_t> depended_on(std::span<const std::uint32_t> cells) {
    Region region(*this, cells);
    region.grow([this](std::uint32_t cell, std::uint32_t other) {
      return holds(other, cell) || (kinds_[other].scores && holds_awake(cell, other));
    });
    region.from_all();
    for (int step = 0; step < spreads_; ++step)
      region.grow([this](std::uint32_t cell, std::uint32_t other) {
        return kinds_[cell].spreads && kinds_[other].spreads && are_awake_together(cell, other);
      });
    region.from_all();
    region.grow([this](std::uint32_t cell, std::uint32_t other) {
      return states_[cell].has_evidence && holds_awake(other, cell);
    });
    return region.cells();
  }

  void divide(std::span<std::uint32_t> cells, int halvings) {
    if (cells.empty()) return;
    const std::vector<std::uint32_t> region = depended_on(cells);
    std::size_t count = 0;
    for (const std::uint32_t cell : region)
      count += cells_.cells_[cell].count;
    if (count <= most_ || cells.size() == 1 || halvings == 0) {
      const auto group = static_cast<std::uint32_t>(groups_.count++);
      for (const std::uint32_t cell : cells)
        groups_.owner[cell] = group;
      for (const std::uint32_t cell : region)
        groups_.needed_by[cell].push_back(group);
      return;
    }
    const Eigen::Index axis = longest_axis(cells);
    const std::size_t middle = cells.size() / 2;
    const auto before = [&](std::uint32_t a, std::uint32_t b) {
      const double at_a = box(a).min()[axis], at_b = box(b).min()[axis];
      return at_a != at_b ? at_a < at_b : a < b;
    };
    std::nth_element(cells.begin(), cells.begin() + static_cast<std::ptrdiff_t>(middle), cells.end(), before);
    divide(cells.first(middle), halvings - 1);
    divide(cells.subspan(middle), halvings - 1);
  }

  [[nodiscard]] Eigen::Index longest_axis(std::span<const std::uint32_t> cells) const {
    Eigen::AlignedBox3d all;
    for (const std::uint32_t cell : cells)
      all.extend(box(cell).min());
    Eigen::Index longest = 0;
    all.sizes().maxCoeff(&longest);
    return longest;
  }

  const RegionCells& cells_;
  std::span<const CellState> states_;
  int spreads_;
  std::size_t most_;
  std::vector<std::uint32_t> stamps_;  ///< by cell: the last region that it was in
  std::uint32_t stamp_ = 0;
  std::vector<Kinds> kinds_;
  CellGroups groups_;
};

CellGroups RegionCells::groups(std::span<const CellState> states, int spreads, std::size_t most) const {
  return CellGrouping(*this, states, spreads, most).run();
}

}  // namespace ray
