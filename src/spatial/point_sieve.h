#pragma once
/// Which of many points close together in memory are near: the inner loops of the search for neighbours.

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>

namespace ray {

inline constexpr std::size_t kSieveLanes = 16;
inline constexpr std::size_t kSieveRoom = 1024;
/// Loops go by whole groups of lanes, so what they read and write may lie behind the last point.
template <class T>
using SieveColumn = std::array<T, kSieveRoom + kSieveLanes>;

/// Points in single precision. Behind the last one there are points at infinity, if `pad` was called.
struct SievePoints {
  std::size_t size = 0;
  alignas(64) SieveColumn<float> x{}, y{}, z{};
  alignas(64) SieveColumn<std::uint32_t> place{};
  alignas(64) SieveColumn<float> to_sensor_x{}, to_sensor_y{}, to_sensor_z{};

  void pad() {
    for (std::size_t i = 0; i < kSieveLanes; ++i)
      x[size + i] = std::numeric_limits<float>::infinity();
  }
};

/// Those that are near; behind the last one the distance is infinite.
struct SievedPoints {
  std::size_t size = 0;
  alignas(64) SieveColumn<float> distance2{};  ///< squared
  alignas(64) SieveColumn<std::uint32_t> place{};
};

/// A box in double, and how near to it.
struct SieveBox {
  std::array<double, 3> middle{};
  std::array<float, 3> half{};  ///< sides, from the middle
  float within2 = 0.0F;         ///< squared distance; infinite: all
};
/// `count` points from place `first` on, their coordinates in columns.
struct SieveSource {
  std::array<const double*, 3> columns{};
  std::uint32_t first = 0;
  std::uint32_t count = 0;
};

/// A sphere, and where there is a side, half of the directions: dot(side, to_sensor) >= -doubt.
struct SieveSphere {
  std::array<float, 3> middle{};
  float within2 = 0.0F;
  std::uint32_t self = 0;  ///< place of the point that does not count
  bool has_side = false;
  std::array<float, 3> side{};
  float doubt = 0.0F;
};

/// Of an ellipsoid. What it says of a point is wrong by at most `rounding` times its squared distance from
/// the centre, and as much more as `most` is above 1.
struct SieveBody {
  std::array<float, 3> centre{};
  std::array<float, 6> shape{};  ///< xx, xy, xz, yy, yz, zz
  float rounding = 0.0F;
  float most = 1.0F;
};

/// Appends the points of the source near the box, relative to its middle, to the others. Reads up to 7 more
/// points. Precondition: there is room for all of the source and as many as there are lanes.
void sieve_box(const SieveSource& source, const SieveBox& box, SievePoints& points);
/// The points within the sphere, and of its side; true if for some the side is in doubt.
[[nodiscard]] bool sieve_sphere(const SievePoints& points, const SieveSphere& sphere, SievedPoints& near);
/// The points that may be in the body; in place of a distance, the most that it may say of the point.
void sieve_body(const SievePoints& points, const SieveBody& body, SievedPoints& near);
/// The number of points no further.
[[nodiscard]] std::size_t sieve_count(const SievedPoints& near, float distance2);
/// Leaves the points no further.
void sieve_further(SievedPoints& near, float distance2);
/// The least sum of a distance of one of the first `count` points from `middle` and what is given for it.
/// Precondition: count is a multiple of kSieveLanes; values are aligned to 32 bytes.
[[nodiscard]] float sieve_least_sum(const SievePoints& points, const std::array<float, 3>& middle,
                                    const float* values, std::size_t count);

/// The same, without what only some processors have: what the others do where they must, and a test's oracle.
namespace plain {
void sieve_box(const SieveSource& source, const SieveBox& box, SievePoints& points);
[[nodiscard]] bool sieve_sphere(const SievePoints& points, const SieveSphere& sphere, SievedPoints& near);
void sieve_body(const SievePoints& points, const SieveBody& body, SievedPoints& near);
[[nodiscard]] std::size_t sieve_count(const SievedPoints& near, float distance2);
void sieve_further(SievedPoints& near, float distance2);
[[nodiscard]] float sieve_least_sum(const SievePoints& points, const std::array<float, 3>& middle,
                                    const float* values, std::size_t count);
}  // namespace plain

}  // namespace ray
