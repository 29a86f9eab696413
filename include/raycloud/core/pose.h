#pragma once
/// Rigid transforms.

#include <raycloud/core/units.h>

#include <Eigen/Geometry>

namespace ray {

/// `p ↦ rotation · p + translation`. The matrix is kept rather than a quaternion so that applying it is one
/// product.
struct Pose {
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();

  [[nodiscard]] Eigen::Vector3d operator*(const Eigen::Vector3d& point) const {
    return rotation * point + translation;
  }
  [[nodiscard]] bool is_identity() const {
    return rotation == Eigen::Matrix3d::Identity() && translation.isZero(0.0);
  }
};

[[nodiscard]] Pose translation_pose(const Eigen::Vector3d& offset_m);

/// Rotation about the origin by a rotation vector: its direction is the axis, its length the angle in radians
/// (paper, section VIII-E). A zero vector gives the exact identity, a whole number of quarter turns about a
/// coordinate axis an exact permutation matrix.
[[nodiscard]] Pose rotation_pose(const Eigen::Vector3d& rotation_vector_rad);

}  // namespace ray
