#pragma once
/// Which ends the judgement of others depends on, cell by cell: as far as the ellipsoids there really reach.

#include <raycloud/exec/context.h>
#include <raycloud/spatial/point_tree.h>

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <unordered_map>
#include <vector>

namespace ray {

/// Space in cubes. An ellipsoid's score depends on those that overlap it, these on those that overlap them,
/// and so on; and every ellipsoid on the neighbours of its end. Cubes know how far that is in each of them,
/// so one lonely point with a large ellipsoid makes no difference elsewhere.
///
/// Memory: about 100 bytes for each cube that is not empty. One thread at a time, but for parts_for.
class JudgementCells {
 public:
  /// Neighbours are looked for up to `reach`, m.
  explicit JudgementCells(double reach);

  /// Those points that are `own`, by index; they are in this part of space.
  void add(const Context& context, const PointTree& points, std::span<const std::uint8_t> own,
           std::size_t part);
  /// Called when all are there.
  void find_parts(double range_noise);
  /// The parts in which an end must be, so that all of their own ends are judged as in the whole cloud. Its
  /// own part is one of them.
  [[nodiscard]] std::span<const std::uint32_t> parts_for(const Eigen::Vector3d& end) const;

 private:
  using Key = std::array<std::int64_t, 3>;
  struct Hash {
    std::size_t operator()(const Key& key) const;
  };
  struct Cell {
    Key key{};
    double semi = 0.0;        ///< m, longest semi-axis, without the noise of the ranges
    double shift = 0.0;       ///< m, of a centre from its end
    double neighbours = 0.0;  ///< m
    std::vector<std::uint32_t> own_parts, parts;
  };
  [[nodiscard]] Key key_of(const Eigen::Vector3d& point) const;
  [[nodiscard]] std::vector<std::uint32_t> cells_within(std::uint32_t cell, double distance) const;

  double reach_;
  double width_;
  std::vector<Cell> cells_;
  std::unordered_map<Key, std::uint32_t, Hash> numbers_;
};

}  // namespace ray
