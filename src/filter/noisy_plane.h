#pragma once
/// The plane that the neighbours of a point tell of, and what planes tell of points.

#include <raycloud/spatial/surfel.h>

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <span>

namespace ray {

inline constexpr std::uint32_t kTooFew = 4;  ///< points that tell of no surface

/// The plane around a point, through point + height · normal, and how far its points are from it.
struct NoisyPlane {
  Eigen::Vector3f normal = Eigen::Vector3f::Zero();  ///< zero: there is none
  float height = 0.0F;                               ///< m
  float variance = 0.0F;                             ///< m², of a point from the plane, unbiased
  float reach = 0.0F;                                ///< m, of its neighbours
  std::uint32_t points = 0;
  bool is_flat = false;  ///< or a line: something to stand in the way of rays, however thin
  bool is_line = false;
  bool is_amid = false;  ///< its points are all around the one in the middle
};

[[nodiscard]] NoisyPlane noisy_plane(const PointTree& tree, std::size_t place, const Surfel& surfel);

/// Whether a point is so near to its own plane that there is no need to ask its neighbours. `beside` (m):
/// where the sixteenth is nearer than that, or the plane is flat, the point is not alone.
[[nodiscard]] bool is_surely_inside(const NoisyPlane& plane, double sigmas, double beside);

/// Whether a point is more than `sigmas` standard deviations from the planes of its neighbours, or far from
/// them all. Medians decide, so that neither one noisy neighbour nor the order of them matters.
/// Precondition: at most kSurfaceNeighbours neighbours.
[[nodiscard]] bool is_outside(const PointTree& tree, std::span<const NoisyPlane> planes, std::size_t place,
                              std::span<const Neighbour> neighbours, double sigmas);

}  // namespace ray
