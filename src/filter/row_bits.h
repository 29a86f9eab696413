#pragma once
/// One bit for each ray of a stream.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace ray {

/// All bits are 0 until set. Memory: one bit a ray.
class RowBits {
 public:
  /// Sets the bits of consecutive rows, the first of which is `first`, where `mask` is not 0.
  void set(std::uint64_t first, std::span<const std::uint8_t> mask) {
    const std::uint64_t words = (first + mask.size() + 63) / 64;
    if (words_.size() < words) words_.resize(words);
    for (std::size_t i = 0; i < mask.size(); i++) {
      if (mask[i] != 0) words_[(first + i) / 64] |= std::uint64_t{1} << (first + i) % 64;
    }
  }

  [[nodiscard]] bool has(std::uint64_t row) const {
    return row / 64 < words_.size() && (words_[row / 64] >> row % 64 & 1) != 0;
  }

  /// 1 for each of `count` rows from `first` on whose bit is set.
  [[nodiscard]] std::vector<std::uint8_t> mask(std::uint64_t first, std::size_t count) const {
    std::vector<std::uint8_t> result(count);
    for (std::size_t i = 0; i < count; i++)
      result[i] = has(first + i) ? 1 : 0;
    return result;
  }

 private:
  std::vector<std::uint64_t> words_;
};

}  // namespace ray
