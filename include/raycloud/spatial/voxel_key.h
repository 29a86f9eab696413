#pragma once
/// Which cube of a regular grid each point is in, as 64-bit keys that never confuse two cubes, wherever on
/// Earth the points are.

#include <raycloud/core/units.h>

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace ray {

/// Cube i of an axis spans [i·width, (i+1)·width).
struct VoxelIndex {
  std::int64_t x = 0;
  std::int64_t y = 0;
  std::int64_t z = 0;
  friend auto operator<=>(const VoxelIndex&, const VoxelIndex&) = default;
};

/// floor(coordinate / width) of each axis: the quotient is rounded once, as the division of doubles rounds
/// it. Throws Error(out_of_range) beyond 2^62 cubes from the origin. Precondition: width > 0.
[[nodiscard]] VoxelIndex voxel_index(const Eigen::Vector3d& point, Metres width);

/// A cube as a block and a key. Space is cut into blocks of 2^21 cubes a side, the first centred on the
/// origin: ±104 km at 10 cm. A key is 21 bits an axis within its block, shuffled by a one-to-one function so
/// that its bits are as good as random; it is never 0.
struct VoxelPlace {
  VoxelIndex block;
  std::uint64_t key = 0;
};

/// The place of a cube, about 3 ns. Precondition: less than 2^62 cubes from the origin.
[[nodiscard]] VoxelPlace voxel_place(const VoxelIndex& cube);

/// The places of consecutive points. Nearly always one run covers everything.
struct VoxelKeys {
  struct Run {
    VoxelIndex block;
    std::size_t end = 0;  ///< one past the last key of the run
  };
  std::vector<std::uint64_t> keys;  ///< one per point; two points are in one cube if both block and key agree
  std::vector<Run> runs;            ///< consecutive keys of one block
};

/// Shape: thread-safe, one point at a time, about 5 ns a point. Memory: 8 bytes a point. Errors and
/// precondition as voxel_index.
[[nodiscard]] VoxelKeys voxel_keys(std::span<const Eigen::Vector3d> points, Metres width);

}  // namespace ray
