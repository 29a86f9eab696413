#pragma once
/// The set of cubes that hold something: what coverage and occupancy are made of.

#include <raycloud/spatial/key_table.h>
#include <raycloud/spatial/voxel_key.h>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace ray {

/// A set of cubes of one width, exact for every coordinate that voxel_keys accepts.
class VoxelSet {
 public:
  /// Adds cubes in order and returns a mask: 1 where the cube was new, 0 where it was in the set or came
  /// earlier in `cubes`. About 20 million cubes a second. Not thread-safe.
  [[nodiscard]] std::vector<std::uint8_t> insert(const VoxelKeys& cubes);
  [[nodiscard]] std::size_t size() const { return cubes_.size(); }
  /// Bytes held: at most 18 for each cube of a large set.
  [[nodiscard]] std::size_t memory() const { return cubes_.memory(); }

 private:
  VoxelTable<> cubes_;
};

}  // namespace ray
