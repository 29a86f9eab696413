#pragma once
/// Which passes, by their time, are a reason to give way, and for whom.

#include <raycloud/volume/free_space.h>

#include <optional>

namespace ray {

/// Which of the three kinds of passes contradict.
struct Contradiction {
  bool before = true;
  bool between = true;
  bool after = true;

  [[nodiscard]] bool covers(std::size_t run) const {
    return run == 0 ? before : run + 1 == Evidence::kRuns ? after : between;
  }
};

/// Who gives way: the ends, or the rays that passed them.
struct Sides {
  std::optional<Contradiction> ends, passes;
};

}  // namespace ray
