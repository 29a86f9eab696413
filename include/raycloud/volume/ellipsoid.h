#pragma once
/// The piece of the world around one end point: where its surface is, and how thick (paper, section VI-A).

#include <raycloud/spatial/surfel.h>

#include <Eigen/Core>

namespace ray {

/// All x with (x - centre)ᵀ shape (x - centre) <= 1.
struct Ellipsoid {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();     ///< m
  Eigen::Matrix3d shape = Eigen::Matrix3d::Identity();  ///< 1/m², symmetric, positive definite
  Eigen::Vector3d normal =
      Eigen::Vector3d::Zero();  ///< of a flat one, of unit length within 5e-5; zero for others

  [[nodiscard]] bool is_flat() const { return !normal.isZero(); }
};

/// Semi-axes² are 1.7² times the variances of the surfel, and `range_noise`² (m²) more along the ray, so that
/// a surface that was measured without scatter is not infinitely thin. No semi-axis is below 2 mm or a
/// 200th of the longest. `to_sensor` may be zero. Where the point
/// itself would be outside, as at the rim of a surface, the centre moves towards it until it is not. Numbers
/// are rounded to what an EllipsoidTree keeps: the centre to whole multiples of 2^-16 m, the shape to single
/// precision, the normal to 2^-15.
[[nodiscard]] Ellipsoid ellipsoid_of(const Surfel& surfel, const Eigen::Vector3d& point,
                                     const Eigen::Vector3d& to_sensor, double range_noise);

/// How a line from start to end meets an ellipsoid. Where it comes nearest is told in the ellipsoid's own
/// measure, in which it is a ball of radius 1; fractions are of the way from start to end, and may lie
/// outside 0 to 1.
struct Chord {
  double miss2 = 2.0;  ///< squared distance of the line from the centre; above 1 it passes by
  double enters = 0.0;
  double leaves = 0.0;  ///< both only where miss2 <= 1
};
/// `start` and `end` must differ, else the chord is a miss.
[[nodiscard]] Chord chord_of(const Ellipsoid& ellipsoid, const Eigen::Vector3d& start,
                             const Eigen::Vector3d& end);

[[nodiscard]] inline bool is_inside(const Ellipsoid& ellipsoid, const Eigen::Vector3d& point) {
  const Eigen::Vector3d offset = point - ellipsoid.centre;
  return offset.dot(ellipsoid.shape * offset) <= 1.0;
}

}  // namespace ray
