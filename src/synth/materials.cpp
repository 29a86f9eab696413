#include "materials.h"

#include <raycloud/exec/random.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace ray {
namespace {

struct Material {
  Eigen::Vector3d colour;  ///< 0 to 255
  double reflectivity;     ///< 0 to 1, of a lidar's near infrared
  double variety;          ///< 0 to 1, how much objects of this kind differ in brightness
};

/// By SceneLabel.
const std::array<Material, 21>& materials() {
  static const std::array<Material, 21> kMaterials{{
      {{160, 190, 220}, 0.00, 0.0},   // nothing
      {{134, 112, 82}, 0.35, 0.0},    // ground
      {{222, 214, 198}, 0.70, 0.06},  // wall
      {{150, 118, 86}, 0.45, 0.0},    // floor
      {{236, 236, 232}, 0.80, 0.0},   // ceiling
      {{120, 76, 44}, 0.50, 0.10},    // door
      {{245, 245, 250}, 0.75, 0.0},   // window_frame
      {{92, 116, 150}, 0.45, 0.45},   // furniture
      {{170, 166, 160}, 0.50, 0.0},   // stairs
      {{104, 78, 54}, 0.40, 0.15},    // trunk
      {{118, 90, 62}, 0.40, 0.15},    // branch
      {{104, 168, 62}, 0.60, 0.25},   // leaf
      {{136, 172, 74}, 0.60, 0.30},   // understorey
      {{124, 92, 70}, 0.35, 0.20},    // fallen_trunk
      {{140, 140, 142}, 0.40, 0.20},  // boulder
      {{146, 164, 72}, 0.55, 0.20},   // grass
      {{176, 178, 70}, 0.55, 0.0},    // crop
      {{168, 172, 178}, 0.50, 0.0},   // fence
      {{74, 130, 64}, 0.60, 0.10},    // hedge
      {{204, 74, 60}, 0.50, 0.40},    // person
      {{56, 92, 176}, 0.55, 0.50},    // vehicle
  }};
  return kMaterials;
}

/// A fixed factor around 1 for each object, so that one chair is told from the next.
double brightness(const Sighting& sighting, const Material& material) {
  static const RandomStream kRandom(0, "brightness");
  const auto id = static_cast<std::uint64_t>(sighting.object_id);
  return 1.0 + material.variety * (kRandom.uniform(id) - 0.5);
}

std::uint8_t to_byte(double value) {
  return static_cast<std::uint8_t>(std::clamp(value + 0.5, 0.0, 255.0));
}

}  // namespace

Colour colour_of(const Sighting& sighting) {
  static const Eigen::Vector3d kSun = Eigen::Vector3d(0.48, -0.36, 0.8).normalized();
  const Material& material = materials()[static_cast<std::size_t>(sighting.label)];
  // Daylight from above and from all sides, and the sun.
  const double light = 0.62 + 0.16 * sighting.normal.z() + 0.3 * std::max(0.0, sighting.normal.dot(kSun));
  const Eigen::Vector3d seen = material.colour * (light * brightness(sighting, material));
  const double far = 1.0 + sighting.range * sighting.range / 3600.0;  // half at 60 m
  const double returned = 255.0 * material.reflectivity * (0.25 + 0.75 * sighting.incidence) / far;
  return {to_byte(seen.x()), to_byte(seen.y()), to_byte(seen.z()),
          std::max<std::uint8_t>(1, to_byte(returned))};
}

Colour sky_colour() {
  const Eigen::Vector3d& colour = materials().front().colour;
  return {to_byte(colour.x()), to_byte(colour.y()), to_byte(colour.z()), 0};
}

}  // namespace ray
