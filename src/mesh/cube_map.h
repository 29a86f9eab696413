#pragma once
/// Directions as places on the six sides of a cube.

#include <Eigen/Core>
#include <cstddef>

namespace ray {

struct CubeMapPlace {
  std::size_t side = 0;  ///< 0 to 5
  double u = 0.0;        ///< 0 to 1
  double v = 0.0;
  double length = 0.0;  ///< the largest coordinate: the vector is this times the direction of the place
};

/// Precondition: not 0.
[[nodiscard]] inline CubeMapPlace on_cube(const Eigen::Vector3d& vector) {
  Eigen::Index axis = 0;
  const double length = vector.cwiseAbs().maxCoeff(&axis);
  const double first = vector[(axis + 1) % 3] / length;
  const double second = vector[(axis + 2) % 3] / length;
  return {static_cast<std::size_t>(2 * axis + (vector[axis] < 0.0 ? 1 : 0)), 0.5 + 0.5 * first,
          0.5 + 0.5 * second, length};
}

/// Of the place, its largest coordinate 1.
[[nodiscard]] inline Eigen::Vector3d cube_direction(std::size_t side, double u, double v) {
  const auto axis = static_cast<Eigen::Index>(side / 2);
  Eigen::Vector3d direction;
  direction[axis] = side % 2 == 0 ? 1.0 : -1.0;
  direction[(axis + 1) % 3] = 2.0 * u - 1.0;
  direction[(axis + 2) % 3] = 2.0 * v - 1.0;
  return direction;
}

}  // namespace ray
