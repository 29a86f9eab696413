#pragma once
/// The ellipsoids around all ends of a cloud.

#include <raycloud/core/ray_stream.h>
#include <raycloud/exec/context.h>
#include <raycloud/volume/ellipsoid_tree.h>

#include <cstdint>
#include <limits>
#include <memory>

namespace ray {

struct CloudEllipsoids {
  std::unique_ptr<EllipsoidTree> tree;  ///< one for each bounded ray, closed
  double range_noise = 0.0;             ///< m, standard deviation of the ends from flat surfaces
  std::uint64_t rays = 0;               ///< unbounded ones too
  /// s, of all rays; first above last where there are none.
  double first_time = std::numeric_limits<double>::infinity();
  double last_time = -std::numeric_limits<double>::infinity();
};

/// Reads `source` once and rewinds it. 95 bytes a bounded ray. About 2.1 µs of one core a ray.
[[nodiscard]] CloudEllipsoids cloud_ellipsoids(const Context& context, RaySource& source);

}  // namespace ray
