#pragma once
/// What is known of a point from those around it, without the rays that go by.

#include "surface_points.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace ray {

/// Whether a point is noise. One byte.
struct Verdict {
  enum Kind : std::uint8_t {
    kStays,
    kNoise,
    kSuspect  ///< so alone that rays should tell
  };
  Kind kind : 2 = kStays;
  bool is_thin : 1 = false;     ///< on no surface: what it is on may be a wire
  std::uint8_t beside : 5 = 0;  ///< others near a suspect
};

/// A suspect has at most kAlone others so near. Around a point of a surface there are some 27.
inline constexpr double kBeside = 3.0;  // spacings
inline constexpr std::size_t kAlone = 2;

/// How far verdicts depend on what is around, in `reach` of `judge_block`: on the surfels of neighbours.
inline constexpr double kVerdictReaches = 2.0;

/// A verdict for each of a block's own records. `reach` (m): of neighbours, kReachSpacings spacings.
[[nodiscard]] std::vector<Verdict> judge_block(const Context& context, Block<SeenPoint>&& block, double reach,
                                               double sigmas);

}  // namespace ray
