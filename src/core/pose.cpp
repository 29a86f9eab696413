#include <raycloud/core/pose.h>

#include <cmath>
#include <numbers>

namespace ray {

namespace {

/// Quarter turns are exact: cos(pi/2) is not 0 in floating point, and a cloud turned by 90 degrees four times
/// should be the cloud.
double snapped(double value) {
  constexpr double kTolerance = 1e-15;
  for (const double exact : {-1.0, 0.0, 1.0}) {
    if (std::abs(value - exact) < kTolerance) return exact;
  }
  return value;
}

}  // namespace

Pose translation_pose(const Eigen::Vector3d& offset_m) {
  return {Eigen::Matrix3d::Identity(), offset_m};
}

Pose rotation_pose(const Eigen::Vector3d& rotation_vector_rad) {
  const double angle = rotation_vector_rad.norm();
  if (angle == 0.0) return {};
  const Eigen::Vector3d axis = rotation_vector_rad / angle;
  Pose pose{Eigen::AngleAxisd(angle, axis).toRotationMatrix(), Eigen::Vector3d::Zero()};
  const bool about_coordinate_axis = (axis.array().abs() == 1.0).any();
  if (about_coordinate_axis) pose.rotation = pose.rotation.unaryExpr(&snapped).eval();
  return pose;
}

}  // namespace ray
