#pragma once
/// Sets that grow together (union-find with path halving).

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <vector>

namespace ray {

class DisjointSets {
 public:
  explicit DisjointSets(std::size_t members) : parent_(members), count_(members) {
    std::iota(parent_.begin(), parent_.end(), std::uint32_t{0});
  }
  /// The member that stands for the set of `i`: its lowest.
  std::uint32_t find(std::uint32_t i) {
    while (parent_[i] != i)
      i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void unite(std::uint32_t a, std::uint32_t b) {
    a = find(a);
    b = find(b);
    if (a == b) return;
    parent_[std::max(a, b)] = std::min(a, b);
    --count_;
  }
  [[nodiscard]] std::size_t count() const { return count_; }

 private:
  std::vector<std::uint32_t> parent_;
  std::size_t count_;
};

}  // namespace ray
