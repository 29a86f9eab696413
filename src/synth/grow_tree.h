#pragma once
/// Trees that look grown.

#include "tree_mesh.h"

#include <string>

namespace ray {

/// How trees of a kind grow. Fractions are of the height.
struct Species {
  std::string name;
  double crown_base = 0.3;     ///< fraction: where the first branch leaves the trunk
  double crown_radius = 0.25;  ///< fraction
  double cone = 0.0;           ///< shape of the crown: 0 a ball, 1 a cone
  double rise_low = 0.4;       ///< slope of the lowest branches
  double rise_high = 1.2;      ///< slope of the highest ones
  int whorls = 12;             ///< nodes of the trunk within the crown
  int limbs = 2;               ///< branches at each
  int twigs = 1;               ///< at each node of a branch of order 2 and above
  int orders = 3;              ///< of branches, the trunk not counted
  double wobble = 0.18;        ///< how crooked it grows
  double slenderness = 45.0;   ///< height over the diameter of the foot
  Foliage foliage;
};

[[nodiscard]] const Species& broadleaf();
[[nodiscard]] const Species& conifer();
[[nodiscard]] const Species& birch();

struct TreePlan {
  Eigen::Vector3d foot = Eigen::Vector3d::Zero();
  double height = 12.0;       ///< m
  double foot_radius = 0.13;  ///< m
};

/// The skeleton grows branch by branch; then every end gets one radius, and each segment the cross-section of
/// all ends that it carries (pipe model, Shinozaki et al. 1964: the area is preserved at every fork), scaled
/// to the radius of the foot. O(segments) time and memory.
[[nodiscard]] Tree grow_tree(const Species& species, const TreePlan& plan, const RandomStream& random);

}  // namespace ray
