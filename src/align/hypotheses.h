#pragma once
/// Poses that may be right, and which of them is.

#include "agreement.h"
#include "fine.h"

#include <raycloud/exec/context.h>

#include <vector>

namespace ray::align {

/// A cloud as alignment knows it.
struct Known {
  Known(const Context& context, Surfaces gathered);

  Surfaces surfaces;
  PatchLevel narrow, fine, middle, wide;  ///< cubes as wide as the surfaces', and two, four and eight times
  FreeCubes free;
};

struct Hypothesis {
  Pose pose;              ///< from the origin of the cloud to that of the reference
  Agreement there, back;  ///< of the cloud's patches with the reference, and the other way round
  double score = 0.0;
};

/// Poses from all candidates, roughly fitted, distinct, the best first.
[[nodiscard]] std::vector<Hypothesis> rough_hypotheses(const Context& context, const Known& cloud,
                                                       const Known& reference);

/// The given ones fitted with all six degrees of freedom and judged from both sides, the best first.
[[nodiscard]] std::vector<Hypothesis> fitted(const Context& context, const Known& cloud,
                                             const Known& reference, std::vector<Hypothesis> hypotheses);

/// Poses beside a pose: a step aside in eight directions and a little turn either way, which come back when
/// they are fitted if there is anything that holds the cloud where it is; and of all small shifts the six
/// that agree best without being fitted.
[[nodiscard]] std::vector<Hypothesis> aside_of(const Context& context, const Pose& pose, const Known& cloud,
                                               const Known& reference);

/// Whether two poses put a cloud to the same place, within the width of a patch.
[[nodiscard]] bool is_same_place(const Pose& a, const Pose& b, const Known& cloud);

/// How far (m) from a surface a patch is on it.
[[nodiscard]] double tolerance_of(const Known& cloud, const Known& reference);

}  // namespace ray::align
