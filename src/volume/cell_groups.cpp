#include "region_cells.h"
#include "transient_regions.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <utility>

namespace ray {

/// Divides cells among groups until each fits.
class CellGrouping {
 public:
  CellGrouping(const RegionCells& cells, std::span<const CellState> states, std::size_t most)
      : cells_(cells), states_(states), most_(most), stamps_(cells.size()), kinds_(cells.size()) {
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

  /// Whether an ellipsoid of `other` may hold a centre of the cell.
  [[nodiscard]] bool holds(std::uint32_t other, std::uint32_t cell) const {
    return cells_.gap(cell, other) <= static_cast<double>(cells_.cells_[other].semi);
  }
  [[nodiscard]] bool are_awake_together(std::uint32_t a, std::uint32_t b) const {
    const float of_a = states_[a].awake_semi, of_b = states_[b].awake_semi;
    return of_a > 0.0F && of_b > 0.0F && cells_.gap(a, b) <= static_cast<double>(std::max(of_a, of_b));
  }

  /// All cells in which a number may be above 0 at the end.
  std::vector<std::uint32_t> find_scored() {
    std::vector<std::uint32_t> sources, scored;
    for (std::uint32_t i = 0; i < states_.size(); ++i)
      if (states_[i].is_source) sources.push_back(i);
    Region spread(*this, sources);
    for (int step = 0; step < kSpreads; ++step)
      spread.grow([this](std::uint32_t a, std::uint32_t b) { return are_awake_together(a, b); });
    for (const std::uint32_t cell : spread.cells())
      kinds_[cell].spreads = true;
    for (std::uint32_t i = 0; i < states_.size(); ++i) {
      kinds_[i].scores = kinds_[i].spreads || states_[i].has_evidence;
      if (kinds_[i].scores) scored.push_back(i);
    }
    Region filled(*this, scored);
    filled.grow([this](std::uint32_t cell, std::uint32_t other) { return holds(other, cell); });
    return filled.cells();
  }

  /// All that the numbers in some cells depend on: the steps of transient_regions, the last one first.
  std::vector<std::uint32_t> depended_on(std::span<const std::uint32_t> cells) {
    Region region(*this, cells);
    region.grow([this](std::uint32_t cell, std::uint32_t other) {
      return holds(other, cell) || (kinds_[other].scores && holds(cell, other));
    });
    region.from_all();
    for (int step = 0; step < kSpreads; ++step)
      region.grow([this](std::uint32_t cell, std::uint32_t other) {
        return kinds_[cell].spreads && kinds_[other].spreads && are_awake_together(cell, other);
      });
    region.from_all();
    region.grow([this](std::uint32_t cell, std::uint32_t other) {
      return states_[cell].has_evidence && holds(other, cell);
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
    const std::size_t axis = longest_axis(cells);
    const std::size_t middle = cells.size() / 2;
    const auto before = [&](std::uint32_t a, std::uint32_t b) {
      const double at_a = place(a, axis), at_b = place(b, axis);
      return at_a != at_b ? at_a < at_b : a < b;
    };
    std::nth_element(cells.begin(), cells.begin() + static_cast<std::ptrdiff_t>(middle), cells.end(), before);
    divide(cells.first(middle), halvings - 1);
    divide(cells.subspan(middle), halvings - 1);
  }

  [[nodiscard]] std::size_t longest_axis(std::span<const std::uint32_t> cells) const {
    Eigen::AlignedBox3d box;
    for (const std::uint32_t cell : cells)
      box.extend(Eigen::Vector3d(place(cell, 0), place(cell, 1), place(cell, 2)));
    Eigen::Index longest = 0;
    box.sizes().maxCoeff(&longest);
    return static_cast<std::size_t>(longest);
  }
  /// m, along an axis.
  [[nodiscard]] double place(std::uint32_t cell, std::size_t axis) const {
    const auto& key = cells_.cells_[cell].key;
    return static_cast<double>(key[axis + 1]) * RegionCells::width_of(key[0]);
  }

  const RegionCells& cells_;
  std::span<const CellState> states_;
  std::size_t most_;
  std::vector<std::uint32_t> stamps_;  ///< by cell: the last region that it was in
  std::uint32_t stamp_ = 0;
  std::vector<Kinds> kinds_;
  CellGroups groups_;
};

CellGroups RegionCells::groups(std::span<const CellState> states, std::size_t most) const {
  return CellGrouping(*this, states, most).run();
}

}  // namespace ray
