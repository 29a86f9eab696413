#pragma once
/// How surfaces look to a scanner.

#include <raycloud/core/colour.h>
#include <raycloud/synth/scene.h>

namespace ray {

/// A surface that a ray has met.
struct Sighting {
  SceneLabel label = SceneLabel::nothing;
  std::int32_t object_id = 0;
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  ///< of unit length, towards the sensor
  double incidence = 1.0;                             ///< cosine between ray and normal, 0 to 1
  double range = 0.0;                                 ///< m
};

[[nodiscard]] Colour colour_of(const Sighting& sighting);
/// Of an unbounded ray.
[[nodiscard]] Colour sky_colour();

}  // namespace ray
