#include "region_cells.h"

#include "mix_bits.h"

#include <raycloud/exec/parallel.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace ray {

std::size_t RegionCells::Hash::operator()(const Key& key) const {
  std::uint64_t hash = 0;
  for (const std::int64_t at : key)
    hash = mix_bits(hash + static_cast<std::uint64_t>(at));
  return hash;
}

double RegionCells::width_of(std::int64_t level) {
  return std::ldexp(2.0, static_cast<int>(level));
}

float RegionCells::semi_axis_within(const Ellipsoid& ellipsoid) {
  constexpr double kRounding = 1.001, kThinnest = 1e-6;
  // The norm of a matrix is no less than its largest eigenvalue.
  const double most = Eigen::Matrix3d(ellipsoid.shape.inverse()).norm();
  return static_cast<float>(kRounding * std::sqrt(most) + kThinnest);
}

RegionCells::Key RegionCells::key_of(const Eigen::Vector3d& centre, float semi_axis) {
  constexpr double kFar = 9e18;
  Key key{static_cast<std::int64_t>(std::ceil(std::log2(semi_axis)))};
  const double width = width_of(key[0]);
  for (std::size_t axis = 0; axis < 3; ++axis)
    key[axis + 1] = static_cast<std::int64_t>(
        std::clamp(std::floor(centre[static_cast<Eigen::Index>(axis)] / width), -kFar, kFar));
  return key;
}

std::uint32_t RegionCells::add(const Key& key, float semi_axis, std::uint32_t count) {
  const auto [at, is_new] = numbers_.try_emplace(key, static_cast<std::uint32_t>(cells_.size()));
  if (is_new) cells_.emplace_back().key = key;
  Cell& cell = cells_[at->second];
  cell.semi = std::max(cell.semi, semi_axis);
  cell.count += count;
  return at->second;
}

Eigen::AlignedBox3d RegionCells::box_of(const Key& key) {
  const double width = width_of(key[0]);
  const Eigen::Vector3d low =
      width *
      Eigen::Vector3d(static_cast<double>(key[1]), static_cast<double>(key[2]), static_cast<double>(key[3]));
  return {low, Eigen::Vector3d(low.array() + width)};
}

/// Of two ellipsoids of which one holds the other's centre, the centres are no further apart than the larger
/// one's semi-axis. So each cell looks for those as large as it is, and larger.
void RegionCells::find_pairs(std::uint32_t cell, std::span<const std::int64_t> levels, Pairs& pairs) const {
  const Key& from = cells_[cell].key;
  const double own_width = width_of(from[0]);
  const Eigen::AlignedBox3d box = box_of(from);
  for (const std::int64_t level : levels) {
    if (level < from[0]) continue;
    const double width = width_of(level);
    std::array<std::int64_t, 3> low{}, high{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      // The longest semi-axis there is half a cube.
      const double at = static_cast<double>(from[axis + 1]) * own_width;
      low[axis] = static_cast<std::int64_t>(std::floor((at - 0.5 * width) / width));
      high[axis] = static_cast<std::int64_t>(std::floor((at + own_width + 0.5 * width) / width));
    }
    for (std::int64_t x = low[0]; x <= high[0]; ++x)
      for (std::int64_t y = low[1]; y <= high[1]; ++y)
        for (std::int64_t z = low[2]; z <= high[2]; ++z) {
          const auto other = numbers_.find(Key{level, x, y, z});
          if (other == numbers_.end()) continue;
          const float reach = std::max(cells_[cell].semi, cells_[other->second].semi);
          if (!(box.exteriorDistance(box_of(other->first)) <= static_cast<double>(reach))) continue;
          pairs.emplace_back(cell, other->second);
          if (level != from[0]) pairs.emplace_back(other->second, cell);
        }
  }
}

void RegionCells::close(const Context& context) {
  std::vector<std::int64_t> levels;
  for (const Cell& cell : cells_)
    if (std::find(levels.begin(), levels.end(), cell.key[0]) == levels.end()) levels.push_back(cell.key[0]);
  constexpr std::size_t kCellsAtOnce = 4096;
  std::vector<Pairs> pieces((cells_.size() + kCellsAtOnce - 1) / kCellsAtOnce);
  parallel_for(context, cells_.size(), kCellsAtOnce, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      find_pairs(static_cast<std::uint32_t>(i), levels, pieces[begin / kCellsAtOnce]);
  });
  first_overlap_.assign(cells_.size() + 1, 0);
  for (const Pairs& pairs : pieces)
    for (const auto& pair : pairs)
      ++first_overlap_[pair.first + 1];
  for (std::size_t i = 0; i < cells_.size(); ++i)
    first_overlap_[i + 1] += first_overlap_[i];
  overlaps_.resize(first_overlap_.back());
  std::vector<std::size_t> next(first_overlap_.begin(), first_overlap_.end() - 1);
  for (const Pairs& pairs : pieces)
    for (const auto& pair : pairs)
      overlaps_[next[pair.first]++] = pair.second;
  numbers_ = {};
}

}  // namespace ray
