#pragma once
/// Where ellipsoids overlap, cell by cell of space: which others the score of each may depend on.

#include <raycloud/exec/context.h>
#include <raycloud/volume/ellipsoid.h>

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <unordered_map>
#include <utility>
#include <vector>

namespace ray {

/// What the evidence in a cell can bring about (transient_regions.h).
struct CellState {
  Eigen::AlignedBox3d awake;  ///< of the centres of those whose number can change
  float awake_semi = 0.0F;    ///< m, their longest semi-axis
  bool has_evidence = false;  ///< something has evidence of its own
  bool is_source = false;     ///< something has so much that it may spread
};

/// Cells that are judged together, in groups.
struct CellGroups {
  static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
  std::size_t count = 0;
  std::vector<std::uint32_t> owner;  ///< by cell: the group that judges it; kNone: its numbers are 0
  std::vector<std::vector<std::uint32_t>> needed_by;  ///< by cell: all groups that depend on it
};

/// Space in cubes, of a size for each size of ellipsoids: an ellipsoid is in a cube two to four times as wide
/// as its longest semi-axis, so that cubes are as small as the points are dense, and a lonely point with a
/// large one makes no difference to others.
///
/// Memory: about 200 bytes for each cube that is not empty, which holds some ten ellipsoids or more where
/// these lie on surfaces. One thread at a time.
class RegionCells {
 public:
  using Key = std::array<std::int64_t, 4>;  ///< of a cube: its level, and where it is, in widths

  /// The longest semi-axis of an ellipsoid, or up to a third more: m.
  [[nodiscard]] static float semi_axis_within(const Ellipsoid& ellipsoid);
  /// The cube in which an ellipsoid is, by its centre and semi_axis_within.
  [[nodiscard]] static Key key_of(const Eigen::Vector3d& centre, float semi_axis);
  /// Adds some ellipsoids in one cube, the largest of which is so large, and returns the number of the cell.
  std::uint32_t add(const Key& key, float semi_axis, std::uint32_t count);
  /// Called when all are there.
  void close(const Context& context);
  [[nodiscard]] std::size_t size() const { return cells_.size(); }

  /// Groups of all cells in which a number can be above 0 after it has spread so many times, such that none
  /// depends on more than `most` ellipsoids where that can be.
  [[nodiscard]] CellGroups groups(std::span<const CellState> states, int spreads, std::size_t most) const;

 private:
  struct Hash {
    std::size_t operator()(const Key& key) const;
  };
  struct Cell {
    Key key{};
    float semi = 0.0F;  ///< m, longest semi-axis
    std::uint32_t count = 0;
  };
  friend class CellGrouping;
  using Pairs = std::vector<std::pair<std::uint32_t, std::uint32_t>>;
  void find_pairs(std::uint32_t cell, std::span<const std::int64_t> levels, Pairs& pairs) const;
  [[nodiscard]] static double width_of(std::int64_t level);
  [[nodiscard]] static Eigen::AlignedBox3d box_of(const Key& key);
  /// The cells whose ellipsoids may hold a centre of this one's, or the other way round; itself among them.
  [[nodiscard]] std::span<const std::uint32_t> overlapping(std::uint32_t cell) const {
    return std::span(overlaps_).subspan(first_overlap_[cell],
                                        first_overlap_[cell + 1] - first_overlap_[cell]);
  }

  std::vector<Cell> cells_;
  std::unordered_map<Key, std::uint32_t, Hash> numbers_;
  std::vector<std::size_t> first_overlap_;
  std::vector<std::uint32_t> overlaps_;
};

}  // namespace ray
