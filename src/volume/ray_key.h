#pragma once
/// What tells rays of several clouds apart.

#include <raycloud/core/ray_cloud.h>

#include <compare>
#include <cstdint>
#include <string>
#include <vector>

namespace ray {

/// A hash of all bits of a ray. Two different ones of a billion rays share a key with a chance of 10^-21, so
/// equal keys are taken for equal rays.
struct RayKey {
  std::uint64_t high = 0;
  std::uint64_t low = 0;
  friend auto operator<=>(const RayKey&, const RayKey&) = default;
};

struct RayKeyRule {
  /// One of the clouds keeps the vectors from ends to starts in single precision: they are compared in it.
  /// Everything else is compared bit by bit.
  bool single_vectors = false;
  std::vector<std::string> columns;  ///< extra columns that are compared: all rays have them, of one type
};

/// Of every ray of a chunk. About 0.05 µs a ray.
[[nodiscard]] std::vector<RayKey> ray_keys(const RayCloud& rays, const RayKeyRule& rule);

}  // namespace ray
