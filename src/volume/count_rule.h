#pragma once
/// Which passes count in a cloud.

#include <raycloud/volume/free_space.h>

#include <algorithm>

namespace ray {

/// Every crossing for `paper`; otherwise those that the noise of the ranges (m) cannot explain.
[[nodiscard]] inline CountRule count_rule(bool paper, double range_noise) {
  constexpr double kSigmas = 3.0;
  CountRule counting;
  if (paper) {
    counting.guard = kEveryPass;
  } else {
    counting.guard.beyond = std::max(counting.guard.beyond, kSigmas * range_noise);
    counting.guard.depth = std::max(counting.guard.depth, kSigmas * range_noise);
  }
  return counting;
}

}  // namespace ray
