#pragma once
/// The first pass over a cloud to be drawn: where its points are and what they have in common.

#include <raycloud/core/bounds.h>
#include <raycloud/exec/stream.h>
#include <raycloud/render/render.h>

#include <array>
#include <cstdint>
#include <vector>

namespace ray {

/// Calls `draw(point, colour)` for the points that a style draws: the ends of bounded rays, or for `starts`
/// the starts of all.
template <class Draw>
void each_drawn_point(RenderStyle style, const RayCloud& rays, const Draw& draw) {
  const bool starts = style == RenderStyle::starts;
  const std::vector<Eigen::Vector3d>& points = starts ? rays.starts : rays.ends;
  for (std::size_t i = 0; i < rays.size(); i++) {
    if (starts || rays.bounded[i] != 0) draw(points[i], rays.colours[i]);
  }
}

/// What the points to be drawn have in common; for the style `rays` only their bounds and number.
struct Survey {
  Bounds bounds;
  double low = 0.0;  ///< m; the range of z without the lowest and highest 0.5 %
  double high = 0.0;
  std::array<std::uint64_t, 256> intensities{};  ///< how many points have each
  bool one_colour = true;                        ///< red, green and blue are the same everywhere
  StreamCounts counts;                           ///< rays_out is the number of points (or rays)
};

[[nodiscard]] Survey survey_cloud(const Context& context, RaySource& source, RenderStyle style);

}  // namespace ray
