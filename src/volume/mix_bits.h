#pragma once
/// Hashing of words.

#include <cstdint>

namespace ray {

/// Every bit of the result depends on every bit of `bits`; one to one (SplitMix64; Steele, Lea and Flood
/// 2014).
[[nodiscard]] inline std::uint64_t mix_bits(std::uint64_t bits) {
  bits = (bits ^ bits >> 30) * 0xbf58476d1ce4e5b9ULL;
  bits = (bits ^ bits >> 27) * 0x94d049bb133111ebULL;
  return bits ^ bits >> 31;
}

}  // namespace ray
