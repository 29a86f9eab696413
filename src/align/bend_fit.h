#pragma once
/// The bend that brings a cloud, rigidly aligned before, onto another; and whether there is one.

#include "hypotheses.h"

#include <raycloud/core/bend.h>

namespace ray::align {

struct BendFit {
  Pose pose;  ///< from the origin of the cloud to that of the reference; the bend follows it
  Bend bend;  ///< about a centre from the origin of the reference
  /// By how much Schwarz's criterion (1978), n ln(squares) + parameters · ln n, falls below that of the rigid
  /// pose; n counts columns of space, since patches near each other share what is wrong with them.
  double gain = 0.0;
  double rmse = 0.0;   ///< m, weighted
  double count = 0.0;  ///< of patches that found another

  double size = 0.0;  ///< m, the largest shift of a patch by the bend

  /// A gain of 10 is very strong evidence (Kass and Raftery 1995); below 2 cm it may be that of how points
  /// fall into cubes.
  [[nodiscard]] bool is_better() const { return gain > 10.0 && size > 0.02; }
};

/// Fits turn, shift and bend together, by wide patches first, from a rigid pose. O(patches) a step.
[[nodiscard]] BendFit fit_bend(const Context& context, const Known& cloud, const Known& reference,
                               const Pose& rigid);

}  // namespace ray::align
