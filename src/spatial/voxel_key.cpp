#include <raycloud/core/error.h>
#include <raycloud/spatial/voxel_key.h>

#include <cassert>
#include <sstream>

namespace ray {
namespace {

constexpr int kBits = 21;                         // of a key, for each axis
constexpr double kLimit = 4611686018427387904.0;  // 2^62

/// std::floor is a function call on the baseline instruction set.
std::int64_t floor_to_int(double q) {
  const auto truncated = static_cast<std::int64_t>(q);
  return truncated - (q < static_cast<double>(truncated) ? 1 : 0);
}

[[noreturn]] void throw_too_far(const Eigen::Vector3d& point, double width) {
  std::ostringstream text;
  text.precision(17);
  text << "the point " << point.x() << "," << point.y() << "," << point.z()
       << " is too far from the origin for cubes of " << width << " m (at most 2^62 of them)";
  throw Error(ErrorCode::out_of_range, text.str());
}

/// One-to-one on 64 bits, and 0 only for 0: the finaliser of MurmurHash3 (Appleby 2011).
std::uint64_t shuffle(std::uint64_t key) {
  key ^= key >> 33;
  key *= 0xff51afd7ed558ccdU;
  key ^= key >> 33;
  key *= 0xc4ceb9fe1a85ec53U;
  return key ^ (key >> 33);
}

// Here, where they can become part of a loop; a function that others call cannot.
inline VoxelIndex index_of(const Eigen::Vector3d& point, double width) {
  const Eigen::Array3d q = point.array() / width;
  if (!(std::abs(q.x()) < kLimit && std::abs(q.y()) < kLimit && std::abs(q.z()) < kLimit)) {
    throw_too_far(point, width);
  }
  return {floor_to_int(q.x()), floor_to_int(q.y()), floor_to_int(q.z())};
}

inline VoxelPlace place_of(const VoxelIndex& cube) {
  constexpr std::int64_t kHalf = std::int64_t{1} << (kBits - 1);
  constexpr std::uint64_t kMask = (std::uint64_t{1} << kBits) - 1;
  const std::int64_t x = cube.x + kHalf;
  const std::int64_t y = cube.y + kHalf;
  const std::int64_t z = cube.z + kHalf;
  const std::uint64_t local = (static_cast<std::uint64_t>(x) & kMask) |
                              (static_cast<std::uint64_t>(y) & kMask) << kBits |
                              (static_cast<std::uint64_t>(z) & kMask) << (2 * kBits);
  constexpr std::uint64_t kNeverZero = std::uint64_t{1} << 63;
  return {{x >> kBits, y >> kBits, z >> kBits}, shuffle(local | kNeverZero)};
}

}  // namespace

VoxelIndex voxel_index(const Eigen::Vector3d& point, Metres width) {
  assert(width.value > 0.0);
  return index_of(point, width.value);
}

VoxelPlace voxel_place(const VoxelIndex& cube) {
  return place_of(cube);
}

VoxelKeys voxel_keys(std::span<const Eigen::Vector3d> points, Metres width) {
  VoxelKeys result;
  result.keys.resize(points.size());
  for (std::size_t i = 0; i < points.size(); i++) {
    const VoxelPlace place = place_of(index_of(points[i], width.value));
    result.keys[i] = place.key;
    if (result.runs.empty() || result.runs.back().block != place.block) {
      result.runs.push_back({place.block, i});
    }
    result.runs.back().end = i + 1;
  }
  return result;
}

}  // namespace ray
