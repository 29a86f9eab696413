#pragma once
/// How the values of a picture are spread, to choose which of them are dark and which bright.

#include <algorithm>
#include <bit>
#include <cstdint>
#include <vector>

namespace ray {

/// Counts values above 0 by their size, each to 1 %, in 2 MB.
class Spread {
 public:
  void add(double value) {
    counts_[std::bit_cast<std::uint64_t>(value) >> kShift]++;
    total_++;
  }

  /// A value that at most `fraction` of those added are above, to 1 %; 0 without any.
  [[nodiscard]] double exceeded_by(double fraction) const {
    auto left = static_cast<std::uint64_t>(fraction * static_cast<double>(total_));
    for (std::size_t i = counts_.size(); i-- > 0;) {
      if (counts_[i] > left) return std::bit_cast<double>(static_cast<std::uint64_t>(i) << kShift);
      left -= counts_[i];
    }
    return 0.0;
  }

 private:
  static constexpr int kShift = 52 - 7;  // sign, exponent and 7 bits of the mantissa
  std::vector<std::uint64_t> counts_ = std::vector<std::uint64_t>(std::size_t{1} << (63 - kShift));
  std::uint64_t total_ = 0;
};

}  // namespace ray
