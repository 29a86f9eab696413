#include <raycloud/spatial/voxel_set.h>

#include <cassert>
#include <new>

namespace ray {

std::size_t KeySet::home(std::uint64_t key, std::size_t capacity) {
  const std::uint64_t fraction = (key << kShardBits) >> 32;  // the shard has used the bits above
  return static_cast<std::size_t>((fraction * capacity) >> 32);
}

bool KeySet::place(Shard& shard, std::uint64_t key) {
  std::size_t i = home(key, shard.capacity);
  while (shard.slots[i] != 0) {
    if (shard.slots[i] == key) return false;
    if (++i == shard.capacity) i = 0;
  }
  shard.slots[i] = key;
  shard.used++;
  return true;
}

/// Because `home` keeps the order of keys at every capacity, this goes through both tables front to back.
void KeySet::grow(Shard& shard) {
  constexpr std::size_t kSmallest = 32;
  Shard larger;
  larger.capacity = shard.capacity == 0 ? kSmallest : shard.capacity + shard.capacity / 2;
  larger.limit = larger.capacity / 3 * 2;
  larger.slots.reset(static_cast<std::uint64_t*>(std::calloc(larger.capacity, sizeof(std::uint64_t))));
  if (larger.slots == nullptr) throw std::bad_alloc();
  for (std::size_t i = 0; i < shard.capacity; i++) {
    if (shard.slots[i] != 0) place(larger, shard.slots[i]);
  }
  shard = std::move(larger);
}

void KeySet::insert(std::span<const std::uint64_t> keys, std::span<std::uint8_t> first_seen) {
  assert(keys.size() == first_seen.size());
  constexpr std::size_t kAhead = 16;  // enough cache misses in flight to hide one
  const auto shard_of = [&](std::uint64_t key) -> Shard& { return shards_[key >> (64 - kShardBits)]; };
  for (std::size_t i = 0; i < keys.size(); i++) {
    if (i + kAhead < keys.size()) {
      const Shard& next = shard_of(keys[i + kAhead]);
      __builtin_prefetch(next.slots.get() + home(keys[i + kAhead], next.capacity), 1);
    }
    Shard& shard = shard_of(keys[i]);
    if (shard.used == shard.limit) grow(shard);
    first_seen[i] = place(shard, keys[i]) ? 1 : 0;
  }
}

std::size_t KeySet::size() const {
  std::size_t sum = 0;
  for (const Shard& shard : shards_)
    sum += shard.used;
  return sum;
}

std::size_t KeySet::memory() const {
  std::size_t sum = sizeof(*this);
  for (const Shard& shard : shards_)
    sum += shard.capacity * sizeof(std::uint64_t);
  return sum;
}

std::vector<std::uint8_t> VoxelSet::insert(const VoxelKeys& cubes) {
  std::vector<std::uint8_t> first_seen(cubes.keys.size());
  std::size_t begin = 0;
  for (const VoxelKeys::Run& run : cubes.runs) {
    const std::size_t count = run.end - begin;
    blocks_[run.block].insert(std::span(cubes.keys).subspan(begin, count),
                              std::span(first_seen).subspan(begin, count));
    begin = run.end;
  }
  return first_seen;
}

std::size_t VoxelSet::size() const {
  std::size_t sum = 0;
  for (const auto& [block, keys] : blocks_)
    sum += keys.size();
  return sum;
}

std::size_t VoxelSet::memory() const {
  std::size_t sum = 0;
  for (const auto& [block, keys] : blocks_)
    sum += keys.memory();
  return sum;
}

}  // namespace ray
