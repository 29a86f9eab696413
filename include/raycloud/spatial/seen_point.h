#pragma once
/// What a neighbourhood needs to know of a ray: where it ended and which way the sensor was.

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace ray {

/// A direction in 6 bytes, true to 3e-5 rad; all zero for none.
using PackedDirection = std::array<std::int16_t, 3>;

[[nodiscard]] inline PackedDirection pack_direction(const Eigen::Vector3d& direction) {
  const double length = direction.norm();
  if (!(length > 0.0) || !std::isfinite(length)) return {};
  const Eigen::Vector3d scaled = direction * (32767.0 / length);
  const auto rounded = [](double v) { return static_cast<std::int16_t>(v < 0.0 ? v - 0.5 : v + 0.5); };
  return {rounded(scaled.x()), rounded(scaled.y()), rounded(scaled.z())};
}

/// Not quite a unit vector.
[[nodiscard]] inline Eigen::Vector3d unpack_direction(const PackedDirection& packed) {
  return Eigen::Vector3d(packed[0], packed[1], packed[2]) / 32767.0;
}

/// Whether something was seen from the side to which a direction points.
[[nodiscard]] inline bool is_seen_from(const Eigen::Vector3d& side, const PackedDirection& to_sensor) {
  return side.x() * to_sensor[0] + side.y() * to_sensor[1] + side.z() * to_sensor[2] >= 0.0;
}

/// The end of a bounded ray. 32 bytes.
struct SeenPoint {
  Eigen::Vector3d end = Eigen::Vector3d::Zero();  ///< m
  PackedDirection to_sensor{};                    ///< from the end; zero for a ray of no length
};

}  // namespace ray
