#pragma once
/// The set of cubes that hold something: what decimation, coverage and occupancy are made of.

#include <raycloud/spatial/voxel_key.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <map>
#include <memory>
#include <span>
#include <vector>

namespace ray {

/// A set of 64-bit keys that are not 0 and have random-looking bits (see VoxelKeys). Open addressing with
/// linear probing in 64 shards that grow one at a time, by half, so that it never holds more than 18 bytes a
/// key, growth included (sets of fewer than some ten thousand keys excepted). Up to 2^36 keys.
class KeySet {
 public:
  /// Adds keys in order; `first_seen[i]` becomes 1 if keys[i] was new, else 0. Precondition: equal sizes.
  /// Not thread-safe.
  void insert(std::span<const std::uint64_t> keys, std::span<std::uint8_t> first_seen);
  [[nodiscard]] std::size_t size() const;
  /// Bytes held.
  [[nodiscard]] std::size_t memory() const;

 private:
  struct Free {
    void operator()(std::uint64_t* slots) const { std::free(slots); }
  };
  struct Shard {
    std::unique_ptr<std::uint64_t[], Free> slots;  // 0: free
    std::size_t capacity = 0;
    std::size_t used = 0;
    std::size_t limit = 0;  // grow when used reaches it
  };
  static constexpr int kShardBits = 6;

  [[nodiscard]] static std::size_t home(std::uint64_t key, std::size_t capacity);
  static bool place(Shard& shard, std::uint64_t key);
  static void grow(Shard& shard);

  std::array<Shard, std::size_t{1} << kShardBits> shards_;
};

/// A set of cubes of one width, exact for every coordinate that voxel_keys accepts.
class VoxelSet {
 public:
  /// Adds cubes in order and returns a mask: 1 where the cube was new, 0 where it was in the set or came
  /// earlier in `cubes`. About 20 million cubes a second. Not thread-safe.
  [[nodiscard]] std::vector<std::uint8_t> insert(const VoxelKeys& cubes);
  [[nodiscard]] std::size_t size() const;
  /// Bytes held: at most 18 for each cube of a large set.
  [[nodiscard]] std::size_t memory() const;

 private:
  std::map<VoxelIndex, KeySet> blocks_;
};

}  // namespace ray
