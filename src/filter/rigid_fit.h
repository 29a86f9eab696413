#pragma once
/// The rigid motion that carries one set of rays best onto another.

#include <raycloud/core/pose.h>
#include <raycloud/core/ray_cloud.h>
#include <raycloud/exec/context.h>

#include <cstdint>
#include <span>

namespace ray {

/// Row numbers of one ray in two clouds.
struct RowPair {
  std::uint32_t from = 0;
  std::uint32_t to = 0;
};

/// Where rays are, and nothing else of them.
struct Lines {
  std::span<const Eigen::Vector3d> starts;
  std::span<const Eigen::Vector3d> ends;
};
[[nodiscard]] inline Lines lines_of(const RayCloud& rays) {
  return {rays.starts, rays.ends};
}

struct RigidFit {
  Pose pose;
  double rms = 0.0;         // m, of starts and ends from where the pose puts them
  double worst = 0.0;       // m
  double moved_rms = 0.0;   // m, of starts and ends from where they were
  double moved_most = 0.0;  // m

  /// The pose is what happened, and not the mean of many different moves.
  [[nodiscard]] bool explains(double tolerance) const { return worst <= tolerance && rms <= 0.5 * moved_rms; }
};

/// Least squares over the starts and ends of all pairs (Kabsch 1976). Where they leave a rotation open (one
/// ray, or all in a line), the smallest; where a translation fits as well as any motion, a translation. The
/// identity for no pairs.
[[nodiscard]] RigidFit fit_rigid(const Context& context, const Lines& from, const Lines& to,
                                 std::span<const RowPair> pairs);

}  // namespace ray
