#pragma once
/// From the segments of a tree to its surfaces.

#include "shapes.h"

#include <raycloud/core/forest.h>
#include <raycloud/exec/random.h>

#include <vector>

namespace ray {

struct Wood {
  Mesh trunk;     ///< the foot and what continues it
  Mesh branches;  ///< all the rest
};
/// A closed tube for every segment that has a length, as wood_volume() describes.
[[nodiscard]] Wood wood_mesh(const Tree& tree);

struct Foliage {
  std::size_t leaves_per_end = 6;
  double leaf_area = 0.0025;  ///< m2, of one side
  double leaf_length = 0.08;  ///< m
};
/// Leaves around the segments without children, facing anywhere. Their whole area is leaf_count() ×
/// leaf_area.
[[nodiscard]] Mesh leaf_mesh(const Tree& tree, const Foliage& foliage, const RandomStream& random);
[[nodiscard]] std::size_t leaf_count(const Tree& tree, const Foliage& foliage);

/// Over the lowest point of the foot, m.
[[nodiscard]] double tree_height(const Tree& tree);
/// The largest horizontal distance of wood from the foot, m.
[[nodiscard]] double crown_radius(const Tree& tree);

/// A direction in which nothing is special. Keyed by (index, draw) and (index, draw + 1).
[[nodiscard]] Eigen::Vector3d random_direction(const RandomStream& random, std::uint64_t index,
                                               std::uint64_t draw);

}  // namespace ray
