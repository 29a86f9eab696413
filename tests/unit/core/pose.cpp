#include <raycloud/core/pose.h>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <numbers>

namespace ray {
namespace {

Eigen::Vector3d any_vector(double scale) {
  const auto component = [&] { return scale * (*rc::gen::inRange(-1000, 1001)) / 1000.0; };
  return {component(), component(), component()};
}

TEST(RotationPose, ZeroVectorIsExactlyTheIdentity) {
  EXPECT_TRUE(rotation_pose(Eigen::Vector3d::Zero()).is_identity());
}

TEST(RotationPose, FourQuarterTurnsAboutAnAxisAreExactlyTheIdentity) {
  for (int axis = 0; axis < 3; ++axis) {
    const Pose quarter = rotation_pose(Eigen::Vector3d::Unit(axis) * std::numbers::pi / 2.0);
    const Eigen::Vector3d point(1.25, -7.5, 1e6 + 0.1);
    EXPECT_EQ(quarter * (quarter * (quarter * (quarter * point))), point) << "axis " << axis;
  }
}

TEST(RotationPose, TurnsByTheRightHandRule) {
  const Pose about_z = rotation_pose(Eigen::Vector3d(0.0, 0.0, std::numbers::pi / 2.0));
  EXPECT_EQ(about_z * Eigen::Vector3d::UnitX(), Eigen::Vector3d::UnitY());
}

RC_GTEST_PROP(RotationPose, OppositeVectorUndoesIt, ()) {
  const Eigen::Vector3d vector = any_vector(6.0);
  const Eigen::Vector3d point = any_vector(100.0);
  const Eigen::Vector3d back = rotation_pose(-vector) * (rotation_pose(vector) * point);
  RC_ASSERT((back - point).norm() < 1e-12);
}

RC_GTEST_PROP(RotationPose, AxisStaysAndAngleIsTheLength, ()) {
  const Eigen::Vector3d vector = any_vector(1.8);
  RC_PRE(vector.norm() > 1e-3);
  const Pose pose = rotation_pose(vector);
  RC_ASSERT((pose * vector - vector).norm() < 1e-12);
  const Eigen::Vector3d across = vector.unitOrthogonal();
  RC_ASSERT(std::abs(across.dot(pose * across) - std::cos(vector.norm())) < 1e-12);
}

}  // namespace
}  // namespace ray
