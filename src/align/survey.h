#pragma once
/// What must be known of a cloud before its surfaces are gathered: where it is, and how dense.

#include <raycloud/core/ray_stream.h>
#include <raycloud/exec/context.h>

#include <Eigen/Core>
#include <cstdint>

namespace ray::align {

struct Survey {
  std::uint64_t rays = 0;
  std::uint64_t bounded = 0;
  std::uint64_t dropped = 0;  ///< rows left out because of a NaN or infinite value
  /// In the middle of the ends, in whole metres, so that taking it off loses nothing.
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  double extent = 0.0;   ///< m, of the ends along the widest axis, one in a hundred at either side left out
  double spacing = 0.0;  ///< m, of the ends; 0 where they do not extend
};

/// Reads the source once and rewinds it. Depends on neither chunks nor threads.
[[nodiscard]] Survey survey_ends(const Context& context, RaySource& source);

/// The width (m) of the cubes in which the points of a surface make a patch: so that there are some 16 in
/// each, and no less than 20 cm unless the cloud is small.
[[nodiscard]] double patch_width(const Survey& survey);

}  // namespace ray::align
