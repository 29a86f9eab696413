#pragma once
/// Which cubes of a grid rays cross on their way from the sensor to the end.

#include <raycloud/core/units.h>
#include <raycloud/spatial/known_bricks.h>
#include <raycloud/spatial/voxel_key.h>

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace ray {

/// The cubes that some rays cross, in bricks of 4³ cubes: cube (x, y, z) is bit (x & 3) + 4 (y & 3) +
/// 16 (z & 3) of the brick (x >> 2, y >> 2, z >> 2).
struct CrossedCubes {
  /// A brick, once for all the rays that cross it, or for some after others.
  struct Brick {
    VoxelPlace place;
    BrickNames::Name name = BrickNames::kNone;  ///< to those who know bricks
    std::uint64_t cubes = 0;                    ///< that any of the rays cross
  };

  VoxelKeys bricks;                  ///< the bricks of each ray in turn
  std::vector<std::uint64_t> cubes;  ///< for each of the bricks, those of its cubes that are crossed
  std::vector<std::uint32_t> rays;   ///< for each of the bricks, the ray that crosses them
  std::vector<std::uint32_t> which;  ///< for each of the bricks, its number in `all`
  std::vector<Brick> all;            ///< where one comes twice, its first rays are before its second ones
  std::size_t done = 0;              ///< rays that were looked at
};

/// The cubes (cube i of an axis spans [i·width, (i+1)·width)) of consecutive rays, from the cube of the start
/// to that of the end, face by face. A cube that the ray passes by within 2^-32 of the width, for each cube
/// that it has crossed before, may be counted as crossed or not. Of cubes that several rays cross, the first
/// ray is always told, later ones need not be; and nothing need be told of cubes that are in `known`, which
/// may learn meanwhile.
///
/// Stops after the ray that makes the bricks `most_bricks` or more. Shape: thread-safe; O(cubes), and
/// O(bricks) where all around is known or told. Memory: 24 bytes a brick and 48 for each in `all`, and 0.7
/// MB. Throws Error(out_of_range) where a ray crosses more than 2^30 cubes along an axis or lies more than
/// 2^62 cubes from the origin. Preconditions: width > 0, as many starts as ends.
///
/// A slab of cubes across the ray's main direction is crossed in one step, with the position on the other two
/// axes in fixed point, so that steps do not wait for each other (against Amanatides and Woo 1987, who go
/// from face to face), and four slabs with nothing new can be crossed in one.
[[nodiscard]] CrossedCubes crossed_cubes(std::span<const Eigen::Vector3d> starts,
                                         std::span<const Eigen::Vector3d> ends, Metres width,
                                         std::size_t most_bricks, const KnownBricks* known = nullptr);

}  // namespace ray
