#pragma once
/// Level surfaces that are seen from above: ground and floors, but no ceilings.

#include "patches.h"

#include <Eigen/Core>
#include <optional>
#include <vector>

namespace ray::align {

struct Floor {
  Eigen::Vector3d place;   ///< m
  Eigen::Vector3d normal;  ///< of unit length, up
  double area = 0.0;       ///< m²
  double count = 0.0;      ///< of points
};

/// Patches whose normal is within `most_tilt` (rad) of up.
[[nodiscard]] std::vector<Floor> floor_patches(const PatchLevel& level, double most_tilt);

struct Ground {
  double height = 0.0;  ///< m
  double area = 0.0;    ///< m², within 10 cm of it
};

/// The lowest height with at least a third of the area at the height that has most, refined by Tukey's
/// weights.
[[nodiscard]] std::optional<Ground> ground_of(const std::vector<Floor>& floors);

/// The rotation about a horizontal axis that levels the ground: the most frequent normal within 15 degrees of
/// up, refined by the plane through the ground's points.
[[nodiscard]] std::optional<Eigen::Matrix3d> levelling(const std::vector<Floor>& floors);

/// Directions that may be up, the one with most area first: those within 60 degrees of up that flat patches
/// often face, each with at least a quarter of the area of the first. Of a scanner that was held askew the
/// ground is one of them; so may roofs be. At most `most`.
[[nodiscard]] std::vector<Eigen::Vector3d> maybe_up(const PatchLevel& level, std::size_t most);

}  // namespace ray::align
