#pragma once
/// Space in cells, cells in bricks, bricks in blocks, and where each brick is in a table.

#include <raycloud/core/error.h>

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string>

namespace ray {

/// Points in one cell are always near each other, those near each other never more than kReach cells apart.
/// A brick has 4 by 4 by 4 cells, so eight bricks hold the cells around any of them. A block has 16 by 16 by
/// 16 bricks, which lie near each other in the table: who goes through it finds what is around in the cache.
class CellBricks {
 public:
  using Index = std::array<std::int64_t, 3>;  // of a cell or brick
  static constexpr int kReach = 2;
  static constexpr int kCells = 64;  // in a brick
  static constexpr int kCellBits = 6;

  /// Where a brick is in a table, and what its points are marked with there: bits of the hash of its block.
  struct Bucket {
    std::uint32_t number = 0;
    std::uint32_t tag = 0;
  };

  /// For a table of a power of two of buckets.
  CellBricks(double distance, std::size_t buckets)
      : cells_per_metre_(std::sqrt(3.0) / (0.999 * distance)),
        bucket_mask_(static_cast<std::uint32_t>(buckets - 1)) {}

  [[nodiscard]] std::size_t buckets() const { return std::size_t{bucket_mask_} + 1; }

  [[nodiscard]] Index cell_of(const Eigen::Vector3d& point) const {
    return {rounded_down(point.x() * cells_per_metre_), rounded_down(point.y() * cells_per_metre_),
            rounded_down(point.z() * cells_per_metre_)};
  }
  static Index brick_of(const Index& cell) {
    return {cell[0] >> kBrickBits, cell[1] >> kBrickBits, cell[2] >> kBrickBits};
  }
  /// The number of a cell in its brick.
  static constexpr std::uint32_t in_brick(const Index& cell) {
    constexpr std::int64_t kMost = (1 << kBrickBits) - 1;
    return static_cast<std::uint32_t>((cell[0] & kMost) << (2 * kBrickBits) |
                                      (cell[1] & kMost) << kBrickBits | (cell[2] & kMost));
  }

  /// The first of the eight bricks that hold the cells around a cell, two along each axis.
  static Index first_around(const Index& cell) {
    return brick_of({cell[0] - kReach, cell[1] - kReach, cell[2] - kReach});
  }
  static Index brick_around(const Index& first, std::size_t number) {
    return {first[0] + static_cast<std::int64_t>(number >> 2),
            first[1] + static_cast<std::int64_t>(number >> 1 & 1),
            first[2] + static_cast<std::int64_t>(number & 1)};
  }
  /// A bit for each cell of one of these bricks that is around the cell with that number in its brick.
  static std::uint64_t cells_around(std::uint32_t in_brick, std::size_t brick) {
    return kCellsAround[in_brick][brick];
  }

  [[nodiscard]] Bucket bucket_of(const Index& brick) const {
    return bucket_of(part_of(0, brick[0]), part_of(1, brick[1]), part_of(2, brick[2]));
  }
  [[nodiscard]] std::array<Bucket, 8> buckets_around(const Index& first) const {
    std::array<std::array<Part, 2>, 3> parts;
    for (std::size_t axis = 0; axis < 3; ++axis)
      parts[axis] = {part_of(axis, first[axis]), part_of(axis, first[axis] + 1)};
    std::array<Bucket, 8> around;
    for (std::size_t b = 0; b < 8; ++b)
      around[b] = bucket_of(parts[0][b >> 2], parts[1][b >> 1 & 1], parts[2][b & 1]);
    return around;
  }

  /// Throws Error(out_of_range) if the point is too far away for whole numbers.
  void check(const Eigen::Vector3d& point) const {
    constexpr double kMostCells = 0x1p40;  // from the origin: there a cell is still divided into 2^13
    const double furthest = std::max({std::abs(point.x()), std::abs(point.y()), std::abs(point.z())});
    if (!(furthest * cells_per_metre_ < kMostCells))
      throw Error(ErrorCode::out_of_range, "the cloud is too large for so small a distance: at most " +
                                               std::to_string(kMostCells / cells_per_metre_ / 1000.0) +
                                               " km from the origin");
  }

 private:
  static constexpr int kBrickBits = 2;
  static constexpr int kBlockBits = 4;

  /// What the index of a brick along one axis adds to the hash of its block, and to its number in the block.
  struct Part {
    std::uint64_t block = 0;
    std::uint32_t brick = 0;
  };
  static Part part_of(std::size_t axis, std::int64_t brick) {
    constexpr std::array<std::uint64_t, 3> kFactors{0x9e3779b97f4a7c15u, 0xc2b2ae3d27d4eb4fu,
                                                    0x165667b19e3779f9u};
    const auto in_block = static_cast<std::uint32_t>(brick & ((1 << kBlockBits) - 1));
    return {static_cast<std::uint64_t>(brick >> kBlockBits) * kFactors[axis],
            in_block << (kBlockBits * (2 - static_cast<int>(axis)))};
  }
  /// The bricks of each block are in an order of its own, for grounds at one height not to meet.
  [[nodiscard]] Bucket bucket_of(const Part& x, const Part& y, const Part& z) const {
    const std::uint64_t sum = x.block + y.block + z.block;
    const std::uint64_t hash = (sum ^ (sum >> 29)) * 0xbf58476d1ce4e5b9u;
    return {(static_cast<std::uint32_t>(hash >> 32) ^ (x.brick | y.brick | z.brick)) & bucket_mask_,
            static_cast<std::uint32_t>(hash) >> kCellBits};
  }

  /// std::floor is a function call on the baseline instruction set.
  static std::int64_t rounded_down(double value) {
    const auto whole = static_cast<std::int64_t>(value);
    return whole - (value < static_cast<double>(whole) ? 1 : 0);
  }

  static std::array<std::array<std::uint64_t, 8>, kCells> find_cells_around() {
    std::array<std::array<std::uint64_t, 8>, kCells> bits{};
    for (std::int64_t at = 0; at < kCells; ++at) {
      const Index from{at >> 4, at >> 2 & 3, at & 3};
      const Index first = first_around(from);
      for (std::int64_t x = -kReach; x <= kReach; ++x)
        for (std::int64_t y = -kReach; y <= kReach; ++y)
          for (std::int64_t z = -kReach; z <= kReach; ++z) {
            const Index to{from[0] + x, from[1] + y, from[2] + z};
            const Index brick = brick_of(to);
            const std::int64_t number =
                4 * (brick[0] - first[0]) + 2 * (brick[1] - first[1]) + (brick[2] - first[2]);
            bits[static_cast<std::size_t>(at)][static_cast<std::size_t>(number)] |= std::uint64_t{1}
                                                                                    << in_brick(to);
          }
    }
    return bits;
  }

  using Around = std::array<std::array<std::uint64_t, 8>, kCells>;
  static const Around kCellsAround;

  double cells_per_metre_;
  std::uint32_t bucket_mask_;
};
// Too many steps for a compiler.
inline const CellBricks::Around CellBricks::kCellsAround = CellBricks::find_cells_around();

}  // namespace ray
