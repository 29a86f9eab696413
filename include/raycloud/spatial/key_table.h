#pragma once
/// Flat hash tables keyed by the 64-bit keys of cubes (spatial/voxel_key.h): what is remembered of each cube.

#include <raycloud/spatial/voxel_key.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <map>
#include <memory>
#include <new>
#include <type_traits>
#include <utility>

namespace ray {

/// The value of a table that is only a set.
struct NoValue {};

/// Shards [first, end) of a table: a part of all keys, the same for every table. Keys are as good as random,
/// so each shard has one 64th of them.
struct ShardRange {
  static constexpr unsigned kShards = 64;
  unsigned first = 0;
  unsigned end = kShards;

  [[nodiscard]] static unsigned shard_of(std::uint64_t key) { return static_cast<unsigned>(key >> 58); }
  [[nodiscard]] bool has(std::uint64_t key) const { return shard_of(key) - first < end - first; }
  [[nodiscard]] bool is_all() const { return first == 0 && end == kShards; }
};

/// Maps keys that are not 0 and have random-looking bits to values that are zero bytes at first. Open
/// addressing with linear probing in 64 shards that grow one at a time, by half: at most 2.25 slots a key,
/// growth included (tables of fewer than some ten thousand keys excepted). A slot is 8 bytes and the value,
/// so a set takes at most 18 bytes a key. Up to 2^36 keys. Finding is thread-safe, adding is not.
template <class Value = NoValue>
class KeyTable {
  static_assert(std::is_trivially_copyable_v<Value> && alignof(Value) <= 8);

 public:
  struct Added {
    Value* value;  ///< valid until the next key is added
    bool is_new;
  };

  Added add(std::uint64_t key) {
    Shard& shard = shards_[ShardRange::shard_of(key)];
    if (shard.used == shard.limit) grow(shard);
    return place(shard, key);
  }

  /// nullptr if the key was never added.
  [[nodiscard]] const Value* find(std::uint64_t key) const {
    const Shard& shard = shards_[ShardRange::shard_of(key)];
    if (shard.capacity == 0) return nullptr;
    for (std::size_t i = home(key, shard.capacity); shard.slots[i].key() != 0;) {
      if (shard.slots[i].key() == key) return &shard.slots[i].value;
      if (++i == shard.capacity) i = 0;
    }
    return nullptr;
  }

  /// Starts to load what `add` or `find` will need some keys later.
  void prefetch(std::uint64_t key) const {
    const Shard& shard = shards_[ShardRange::shard_of(key)];
    __builtin_prefetch(shard.slots.get() + home(key, shard.capacity), 1);
  }

  /// Forgets the keys outside `kept` and frees their memory.
  void restrict_to(ShardRange kept) {
    for (unsigned i = 0; i < ShardRange::kShards; i++) {
      if (i < kept.first || i >= kept.end) shards_[i] = {};
    }
  }

  [[nodiscard]] std::size_t size() const {
    std::size_t sum = 0;
    for (const Shard& shard : shards_)
      sum += shard.used;
    return sum;
  }
  /// Bytes held.
  [[nodiscard]] std::size_t memory() const {
    std::size_t sum = sizeof(*this);
    for (const Shard& shard : shards_)
      sum += shard.capacity * sizeof(Slot);
    return sum;
  }

 private:
  struct Slot {
    std::uint32_t low;  // in halves, so that a slot with a value of 4 bytes is 12 bytes; 0, 0: free
    std::uint32_t high;
    [[no_unique_address]] Value value;
    [[nodiscard]] std::uint64_t key() const { return std::uint64_t{high} << 32 | low; }
  };
  struct Free {
    void operator()(Slot* slots) const { std::free(slots); }
  };
  struct Shard {
    std::unique_ptr<Slot[], Free> slots;
    std::size_t capacity = 0;
    std::size_t used = 0;
    std::size_t limit = 0;  // grow when used reaches it
  };

  /// Keeps the order of keys at every capacity.
  [[nodiscard]] static std::size_t home(std::uint64_t key, std::size_t capacity) {
    const std::uint64_t fraction = (key << 6) >> 32;  // the shard has used the bits above
    return static_cast<std::size_t>((fraction * capacity) >> 32);
  }

  static Added place(Shard& shard, std::uint64_t key) {
    std::size_t i = home(key, shard.capacity);
    while (shard.slots[i].key() != 0) {
      if (shard.slots[i].key() == key) return {&shard.slots[i].value, false};
      if (++i == shard.capacity) i = 0;
    }
    shard.slots[i].low = static_cast<std::uint32_t>(key);
    shard.slots[i].high = static_cast<std::uint32_t>(key >> 32);
    shard.used++;
    return {&shard.slots[i].value, true};
  }

  /// Because `home` keeps the order of keys, this goes through both tables front to back.
  static void grow(Shard& shard) {
    constexpr std::size_t kSmallest = 32;
    Shard larger;
    larger.capacity = shard.capacity == 0 ? kSmallest : shard.capacity + shard.capacity / 2;
    larger.limit = larger.capacity / 3 * 2;
    larger.slots.reset(static_cast<Slot*>(std::calloc(larger.capacity, sizeof(Slot))));
    if (larger.slots == nullptr) throw std::bad_alloc();
    for (std::size_t i = 0; i < shard.capacity; i++) {
      if (shard.slots[i].key() != 0) *place(larger, shard.slots[i].key()).value = shard.slots[i].value;
    }
    shard = std::move(larger);
  }

  std::array<Shard, ShardRange::kShards> shards_;
};

/// A value for each cube of one width, exact for every coordinate that voxel_keys accepts: a table for each
/// block of cubes. Finding is thread-safe, adding is not.
template <class Value = NoValue>
class VoxelTable {
 public:
  VoxelTable() = default;
  VoxelTable(const VoxelTable&) = delete;
  VoxelTable& operator=(const VoxelTable&) = delete;

  /// The table of a block, made where there is none.
  [[nodiscard]] KeyTable<Value>& block(const VoxelIndex& number) {
    if (last_ == nullptr || last_number_ != number) {
      last_ = &blocks_[number];
      last_number_ = number;
    }
    return *last_;
  }
  /// nullptr where there is none.
  [[nodiscard]] const KeyTable<Value>* find_block(const VoxelIndex& number) const {
    const auto found = blocks_.find(number);
    return found == blocks_.end() ? nullptr : &found->second;
  }

  /// Adds the cubes of `cubes` that are in `range`, in order, and calls `see(i, value, is_new)` for each.
  /// About 20 million cubes a second.
  template <class See>
  void add(const VoxelKeys& cubes, ShardRange range, const See& see) {
    constexpr std::size_t kAhead = 16;  // enough cache misses in flight to hide one
    const std::vector<std::uint64_t>& keys = cubes.keys;
    std::size_t i = 0;
    for (const VoxelKeys::Run& run : cubes.runs) {
      KeyTable<Value>& table = block(run.block);
      for (; i < run.end; i++) {
        if (i + kAhead < run.end) table.prefetch(keys[i + kAhead]);
        if (!range.has(keys[i])) continue;
        const auto added = table.add(keys[i]);
        see(i, *added.value, added.is_new);
      }
    }
  }

  void restrict_to(ShardRange kept) {
    for (auto& [number, table] : blocks_)
      table.restrict_to(kept);
  }
  void clear() {
    blocks_.clear();
    last_ = nullptr;
  }
  [[nodiscard]] std::size_t size() const {
    std::size_t sum = 0;
    for (const auto& [number, table] : blocks_)
      sum += table.size();
    return sum;
  }
  /// Bytes held.
  [[nodiscard]] std::size_t memory() const {
    std::size_t sum = 0;
    for (const auto& [number, table] : blocks_)
      sum += table.memory();
    return sum;
  }

 private:
  std::map<VoxelIndex, KeyTable<Value>> blocks_;
  KeyTable<Value>* last_ = nullptr;
  VoxelIndex last_number_;
};

}  // namespace ray
