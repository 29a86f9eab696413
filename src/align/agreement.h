#pragma once
/// Whether two clouds agree when one lies on the other: where both have surfaces these are the same, and
/// neither has any in what the other has seen to be empty.

#include "free_cubes.h"
#include "patches.h"

#include <raycloud/core/pose.h>

#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

namespace ray::align {

/// Of patches of one cloud, what the other says. Counted apart for upright surfaces, which tell of the turn
/// and the horizontal shift, and others.
struct Agreement {
  struct Counts {
    double same = 0.0;     ///< on a surface that heads the same way
    double other = 0.0;    ///< beside a surface, but not on it or not heading as it does
    double empty = 0.0;    ///< in space that was seen to be empty
    double unknown = 0.0;  ///< where the other cloud tells nothing
    [[nodiscard]] double known() const { return same + other + empty; }
    Counts& operator+=(const Counts& more);
  };
  Counts upright, others;
  /// What speaks against the pose: patches in empty space, and clean upright ones beside a surface, but
  /// without those in the tenth of space where most of them are. There something may have changed; what is
  /// wrong with a pose is wrong everywhere.
  double against = 0.0;

  [[nodiscard]] Counts all() const {
    Counts sum = upright;
    return sum += others;
  }
  Agreement& operator+=(const Agreement& more);
};

struct Observed {
  const PatchLevel& level;
  const FreeCubes& free;
};

/// A patch, and whether it is clean (PatchLevel::is_clean).
struct JudgedPatch {
  Patch patch;
  bool is_clean;
};
[[nodiscard]] std::vector<JudgedPatch> judged_patches(const PatchLevel& level, std::size_t most);

/// How much better one pose explains what is known in both than another does: the sum over patches of how far
/// they are from surfaces, from 0 to 1 each, and the sum of its squares over columns of space.
struct Preference {
  double sum = 0.0, squares = 0.0, count = 0.0;
  /// In standard errors, if columns are independent: where one thing has moved it is one column that says so.
  [[nodiscard]] double sigmas() const { return squares > 0.0 ? sum / std::sqrt(squares) : 0.0; }
  Preference& operator+=(const Preference& more) {
    sum += more.sum, squares += more.squares, count += more.count;
    return *this;
  }
};
[[nodiscard]] Preference preference_of(std::span<const JudgedPatch> patches, const Pose& pose,
                                       const Pose& rival, const Observed& other, double tolerance);

/// `tolerance` (m): how far from a surface is on it.
[[nodiscard]] Agreement agreement_of(std::span<const JudgedPatch> patches, const Pose& pose,
                                     const Observed& other, double tolerance);

}  // namespace ray::align
