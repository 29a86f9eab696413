#pragma once
/// The upright surfaces of a cloud that lie along two orthogonal directions.

#include "patches.h"

#include <Eigen/Core>
#include <array>
#include <vector>

namespace ray::align {

/// A patch of an upright surface, in the plane.
struct Upright {
  Eigen::Vector2d place;   ///< m
  Eigen::Vector2d normal;  ///< of unit length
  double area;             ///< m²
  double count;            ///< of points
};

/// Precondition: the patch is flat and upright.
[[nodiscard]] Upright upright_of(const Patch& patch);

/// The angle (rad, within 45 degrees of 0) by which the strongest orthogonal walls are turned from the axes,
/// from normals: the most frequent of their headings modulo a quarter turn. `share` is that of the area
/// within three degrees of it.
struct Heading {
  double angle = 0.0;
  double share = 0.0;
  double area = 0.0;  ///< m², within three degrees
};
[[nodiscard]] Heading heading_of(const std::vector<Upright>& patches);

/// Walls on one line: the offset along the axis to which they are normal, and whether their fronts look to
/// its positive end.
struct WallLine {
  double offset = 0.0;  ///< m
  double area = 0.0;    ///< m²
  bool to_positive = false;
};

struct WallGrid {
  double angle = 0.0;                          ///< rad, refined
  double sigma = 0.0;                          ///< rad
  double residual = 0.0;                       ///< m, root mean square
  std::array<std::vector<WallLine>, 2> lines;  ///< normal to each axis, by offset
};

/// Refines an angle by lines: the angle and the offsets of all lines together that leave the least squares of
/// the distances of points from their lines, with Tukey's weights. Patches are first brought to the lines by
/// the peaks of the histogram of their offsets.
[[nodiscard]] WallGrid fit_walls(const std::vector<Upright>& patches, double angle, double width);

}  // namespace ray::align
