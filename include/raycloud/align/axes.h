#pragma once
/// A cloud to its own axes: walls along x and y, the corner of the outside walls at the origin, the ground at
/// height zero (paper, section VIII-E). docs/algorithms/alignment.md.

#include <raycloud/core/pose.h>
#include <raycloud/core/ray_stream.h>
#include <raycloud/exec/context.h>

#include <cstddef>
#include <cstdint>

namespace ray {

struct AxesRule {
  bool level = false;  ///< take out roll and pitch too, up to 15 degrees, so that the ground is level
};

struct AxesAlignment {
  Pose pose;                   ///< takes the cloud to its axes
  double wall_area = 0.0;      ///< m², of the walls along the two axes
  double wall_share = 0.0;     ///< of all upright surfaces
  double ground_area = 0.0;    ///< m², at height zero
  double wall_residual = 0.0;  ///< m, root mean square of the patches of walls about their lines
  double yaw_sigma = 0.0;      ///< rad
  std::uint64_t dropped = 0;   ///< rays left out because of a NaN or infinite value
};

/// Turns about the vertical so that the strongest orthogonal walls are along x and y, and shifts so that the
/// outermost of the strong walls meet at the origin: the strongest of these four lies along one axis, the
/// stronger of its two neighbours along the other, and the building in the quadrant where x and y are
/// positive. So the result does not depend on how the cloud was turned. The ground is the lowest height with
/// at least a third as much level surface that is seen from above as the height with the most.
///
/// Reads the source twice and rewinds it. Streaming; 0.1 µs of one core a ray; memory: about 250 bytes a
/// patch of some 16 rays. The result does not depend on threads or chunks.
///
/// Throws Error(no_data) if the cloud has no bounded rays, no walls along two orthogonal directions, or no
/// level surface.
[[nodiscard]] AxesAlignment align_to_axes(const Context& context, RaySource& source,
                                          const AxesRule& rule = {});

}  // namespace ray
