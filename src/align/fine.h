#pragma once
/// The rigid transform that brings the patches of one cloud onto those of another, from a start nearby.

#include "patches.h"

#include <raycloud/core/pose.h>
#include <raycloud/exec/context.h>

#include <Eigen/Core>
#include <span>
#include <vector>

namespace ray::align {

/// Three of turning (rad, about the centre of the patches where they come to lie), three of shifting (m).
using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

struct FineRule {
  double gate = 0.5;     ///< m, a patch counts by Tukey's weight of its distance from the other's plane
  int steps = 20;        ///< most
  bool upright = false;  ///< turn about the vertical only
  /// Of the largest information: what is held much less than that hardly moves.
  double damping = 3e-4;
  double flat = 0.1;  ///< a flat patch has at most that share of its next variance across itself
};

/// Patches, those of the reference, and the rule for them.
struct FineLevel {
  std::span<const Patch> patches;
  const PatchLevel& reference;
  FineRule rule;
};

struct FineFit {
  Pose pose;                                         ///< from the origin of one cloud to that of the other
  Matrix6 information = Matrix6::Zero();             ///< of the patches, with their weights, for 1 m of noise
  double variance = 0.0;                             ///< m², of a patch of weight 1
  double rmse = 0.0;                                 ///< m, weighted
  double count = 0.0;                                ///< of patches that found another
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  ///< m, about which turns are
};

/// Point to plane for patches that are flat, point to line for those that are thin; each to the nearest of
/// the same kind and heading (Chen and Medioni 1992), by damped Gauss-Newton steps on SE(3). Stops when a
/// step turns less than 1e-6 rad and shifts less than 1e-5 m. 0.3 µs a patch and step.
[[nodiscard]] FineFit fit_patches(std::span<const Patch> patches, const PatchLevel& reference,
                                  const Pose& start, const FineRule& rule);

/// As above, on all cores, with the same bits for any number of them.
[[nodiscard]] FineFit fit_patches(const Context& context, std::span<const Patch> patches,
                                  const PatchLevel& reference, const Pose& start, const FineRule& rule);

/// As above, of patches of several widths together; steps are those of the first rule.
[[nodiscard]] FineFit fit_levels(const Context& context, std::span<const FineLevel> levels,
                                 const Pose& start);

/// The nearest patch of the same kind whose surface heads the same way, or none, for a patch that comes to
/// lie at `place`.
[[nodiscard]] const Patch* counterpart_of(const Patch& patch, const PatchLevel& reference,
                                          const Eigen::Vector3d& place, const Eigen::Matrix3d& rotation,
                                          const FineRule& rule = {});

/// An even choice of at most so many.
[[nodiscard]] std::vector<Patch> some_of(const std::vector<Patch>& patches, std::size_t most);

}  // namespace ray::align
