#pragma once
/// Walls and floors with openings, and what is set into the openings.

#include "shapes.h"

#include <vector>

namespace ray {

/// A rectangle of a plate, in m along its two sides.
struct Opening {
  double left = 0.0;
  double right = 0.0;
  double bottom = 0.0;
  double top = 0.0;
};

/// A board of even thickness: `corner` + [0, width] · along + [0, height] · up + [0, thickness] · (along ×
/// up). The two directions have unit length and are at right angles.
struct Plate {
  Eigen::Vector3d corner = Eigen::Vector3d::Zero();
  Eigen::Vector3d along = Eigen::Vector3d::UnitX();
  Eigen::Vector3d up = Eigen::Vector3d::UnitY();
  double width = 0.0;
  double height = 0.0;
  double thickness = 0.0;
  std::vector<Opening> openings = {};
};

/// One closed surface with the openings cut through it. Precondition: openings may touch the rim or each
/// other's sides, but not corner to corner.
[[nodiscard]] Mesh plate_mesh(const Plate& plate);

/// A wall whose middle line runs from `from` to `to` at height `from.z()`. Openings are measured from `from`.
struct Wall {
  Eigen::Vector3d from = Eigen::Vector3d::Zero();
  Eigen::Vector3d to = Eigen::Vector3d::Zero();
  double height = 0.0;
  double thickness = 0.0;
  std::vector<Opening> openings = {};
};
[[nodiscard]] Plate plate_of(const Wall& wall);

/// A frame around an opening, with a post and a rail: bars 6 cm wide and deep. Rays pass between them.
[[nodiscard]] Mesh window_mesh(const Wall& wall, const Opening& opening);

enum class Hinge : std::uint8_t { left, right };
/// A door leaf, 4 cm thick, that hangs at a side of the opening and stands open by `turns` whole turns (to
/// the left of the way from `from` to `to` if positive).
[[nodiscard]] Mesh door_mesh(const Wall& wall, const Opening& opening, Hinge hinge, double turns);

}  // namespace ray
