#pragma once
/// How many numbers inner loops take at once: as many as the processor can, with the same bits. Functions for
/// more than every processor has are marked RAY_AVX2 or RAY_AVX512, and called where `lanes_in_use` says so;
/// wide registers are handed to them by reference.

#include <algorithm>
#include <cstdint>

namespace ray {

/// In ascending order: what compilers make of plain loops, eight and sixteen floats.
enum class LaneSet : std::uint8_t { kPlain, kAvx2, kAvx512 };

#if defined(__x86_64__) && defined(__GNUC__)
#define RAY_HAS_LANES 1
#define RAY_AVX2 [[gnu::target("avx2,popcnt")]]
#define RAY_AVX512 [[gnu::target("avx512f,avx512dq,avx512bw,avx2,popcnt")]]
#endif

/// That this processor has.
inline LaneSet widest_lanes() {
#ifdef RAY_HAS_LANES
  if (!__builtin_cpu_supports("avx2") || !__builtin_cpu_supports("popcnt")) return LaneSet::kPlain;
  // Those that have the last of these are not slowed down by their widest registers, as the first ones were.
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
      __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512bitalg"))
    return LaneSet::kAvx512;
  return LaneSet::kAvx2;
#else
  return LaneSet::kPlain;
#endif
}

inline LaneSet lanes_in_use = widest_lanes();

/// For tests, as long as it lives: no wider ones. Not while other threads are at work.
class FewerLanes {
 public:
  explicit FewerLanes(LaneSet most) { lanes_in_use = std::min(most, widest_lanes()); }
  ~FewerLanes() { lanes_in_use = widest_lanes(); }
  FewerLanes(const FewerLanes&) = delete;
  FewerLanes& operator=(const FewerLanes&) = delete;
};

}  // namespace ray
