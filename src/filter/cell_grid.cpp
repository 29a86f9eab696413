#include "cell_grid.h"

#include <bit>

namespace ray {

CellTable::CellTable(const std::vector<std::uint64_t>& keys) : slots_(std::bit_ceil(2 * keys.size() + 1)) {
  for (std::size_t i = 0; i < keys.size(); ++i) {
    std::size_t slot = home(keys[i]);
    while (slots_[slot].key != kFree)
      slot = (slot + 1) & (slots_.size() - 1);
    slots_[slot] = {keys[i], i};
  }
}

std::optional<std::size_t> CellTable::find(std::uint64_t key) const {
  for (std::size_t slot = home(key); slots_[slot].key != kFree; slot = (slot + 1) & (slots_.size() - 1)) {
    if (slots_[slot].key == key) return slots_[slot].index;
  }
  return {};
}

std::size_t CellTable::home(std::uint64_t key) const {
  // Fibonacci hashing: neighbours go far apart.
  return static_cast<std::size_t>((key * 0x9e3779b97f4a7c15u) >> 16) & (slots_.size() - 1);
}

}  // namespace ray
