#pragma once
/// The five views of a cloud, all orthographic.

#include <Eigen/Core>

namespace ray {

/// Where the viewer is. Left, right, front and back stand upright (z is up) around the cloud as around a
/// house whose front faces −y:
///
/// | view  | viewer at | looks along | to the right | up |
/// |-------|-----------|-------------|--------------|----|
/// | top   | +z        | −z          | +x           | +y |
/// | front | −y        | +y          | +x           | +z |
/// | back  | +y        | −y          | −x           | +z |
/// | left  | −x        | +x          | −y           | +z |
/// | right | +x        | −x          | +y           | +z |
enum class View { top, left, right, front, back };

/// A coordinate axis with a direction.
struct SignedAxis {
  int axis = 0;  ///< 0 x, 1 y, 2 z
  double sign = 1.0;
  [[nodiscard]] double operator()(const Eigen::Vector3d& point) const { return sign * point[axis]; }
};

/// The image plane: a point is seen at (right, up), and of two points the one with the larger `nearness`
/// hides the other. Images are never mirrored.
struct Camera {
  SignedAxis right;
  SignedAxis up;
  SignedAxis nearness;
};

[[nodiscard]] Camera camera_of(View view);

}  // namespace ray
