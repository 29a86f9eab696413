#pragma once
/// An ellipsoid on disk.

#include <raycloud/volume/ellipsoid.h>

#include <array>
#include <cmath>
#include <cstdint>

namespace ray {

/// Every bit of an ellipsoid made by ellipsoid_of. 56 bytes.
struct PackedEllipsoid {
  std::array<double, 3> centre{};
  std::array<float, 6> shape{};  ///< xx, xy, xz, yy, yz, zz
  std::array<std::int16_t, 3> normal{};
};

[[nodiscard]] inline PackedEllipsoid packed(const Ellipsoid& ellipsoid) {
  PackedEllipsoid packed;
  std::size_t entry = 0;
  for (int row = 0; row < 3; ++row) {
    const auto axis = static_cast<std::size_t>(row);
    packed.centre[axis] = ellipsoid.centre[row];
    packed.normal[axis] = static_cast<std::int16_t>(std::lround(32767.0 * ellipsoid.normal[row]));
    for (int column = row; column < 3; ++column)
      packed.shape[entry++] = static_cast<float>(ellipsoid.shape(row, column));
  }
  return packed;
}

[[nodiscard]] inline Eigen::Vector3d centre_of(const PackedEllipsoid& packed) {
  return {packed.centre[0], packed.centre[1], packed.centre[2]};
}

[[nodiscard]] inline Ellipsoid unpacked(const PackedEllipsoid& packed) {
  Ellipsoid ellipsoid;
  ellipsoid.centre = centre_of(packed);
  std::size_t entry = 0;
  for (int row = 0; row < 3; ++row) {
    ellipsoid.normal[row] = packed.normal[static_cast<std::size_t>(row)] / 32767.0;
    for (int column = row; column < 3; ++column)
      ellipsoid.shape(row, column) = ellipsoid.shape(column, row) =
          static_cast<double>(packed.shape[entry++]);
  }
  return ellipsoid;
}

}  // namespace ray
