#pragma once
/// Poses that may be right, and which of them is.

#include "jury.h"

#include <raycloud/exec/context.h>

#include <vector>

namespace ray::align {

void sort_by_score(std::vector<Hypothesis>& hypotheses);

/// Without those that were fitted to just the pose of one before.
[[nodiscard]] std::vector<Hypothesis> without_twins(const std::vector<Hypothesis>& hypotheses,
                                                    const Known& cloud);

/// The rotations that turn the vertical of either cloud upright, before one is turned about it onto the
/// other.
struct Verticals {
  Eigen::Matrix3d cloud = Eigen::Matrix3d::Identity(), reference = Eigen::Matrix3d::Identity();
};

/// Poses from all candidates, roughly fitted, distinct, the best first.
[[nodiscard]] std::vector<Hypothesis> rough_hypotheses(const Context& context, const Known& cloud,
                                                       const Known& reference, const Verticals& verticals);

/// The given ones fitted with all six degrees of freedom and judged from both sides, the best first.
[[nodiscard]] std::vector<Hypothesis> fitted(const Context& context, const Known& cloud,
                                             const Known& reference, const Jury& jury,
                                             std::vector<Hypothesis> hypotheses);

/// Poses beside a pose: a step aside in eight directions and a little turn either way, which come back when
/// they are fitted if there is anything that holds the cloud where it is; and of all small shifts the six
/// that are best without being fitted.
[[nodiscard]] std::vector<Hypothesis> aside_of(const Context& context, const Pose& pose, const Known& cloud,
                                               const Known& reference, const Jury& jury);

}  // namespace ray::align
