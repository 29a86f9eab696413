#pragma once
/// A cloud seen from above, as what correlation compares: where upright surfaces are and which way they face.

#include "fourier.h"
#include "patches.h"

#include <Eigen/Core>
#include <vector>

namespace ray::align {

/// The surfaces of one column of cubes.
struct Feature {
  Eigen::Vector2f place;   ///< m, from the centre of the footprint
  Eigen::Vector2f facing;  ///< the sum of the headings of its upright patches, at most 1 long
  float height = 0.0F;     ///< how much of the column is occupied, at most 1
};

struct Footprint {
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();  ///< m, from the origin of the patches
  double radius = 0.0;                               ///< m, of the circle that holds nearly all features
  std::vector<Feature> features;
};

/// Of a cloud's patches.
[[nodiscard]] Footprint footprint_of(const std::vector<Patch>& patches, double width);

/// Two images of a footprint turned by `yaw` (rad): the headings, as complex numbers, and the heights.
struct Rasters {
  Image facing, height;
};
void draw(const Footprint& footprint, double yaw, double cell, std::size_t side, Rasters& rasters);

}  // namespace ray::align
