#pragma once
/// Random numbers that do not depend on who asks first: a named stream of the seed, keyed by an index, so
/// that ray 1 000 gets the same numbers on every thread count and in every chunking.

#include <cstdint>
#include <string_view>

namespace ray {

/// Counter-based: every number is a hash of (seed, name, index, draw). No state, copyable, thread-safe. The
/// mixing function is SplitMix64's (Steele, Lea and Flood 2014), applied once per input word.
class RandomStream {
 public:
  RandomStream(std::uint64_t seed, std::string_view name);

  /// 64 random bits. `draw` tells several numbers of one index apart.
  [[nodiscard]] std::uint64_t bits(std::uint64_t index, std::uint64_t draw = 0) const;
  /// Uniform in [0, 1), with 53 random bits.
  [[nodiscard]] double uniform(std::uint64_t index, std::uint64_t draw = 0) const;
  /// Uniform in [0, count) without bias that could be measured (multiply-shift). Precondition: count > 0.
  [[nodiscard]] std::uint64_t below(std::uint64_t count, std::uint64_t index, std::uint64_t draw = 0) const;

 private:
  std::uint64_t key_;
};

}  // namespace ray
