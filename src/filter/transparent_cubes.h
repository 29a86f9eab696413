#pragma once
/// Places that nearly every ray passes: what was hit there is no thing.

#include <raycloud/core/ray_stream.h>
#include <raycloud/exec/context.h>
#include <raycloud/spatial/key_table.h>

#include <Eigen/Core>
#include <memory>
#include <vector>

namespace ray {

/// Cubes with ends in them of which less than a hundredth of the rays that reach them ended there. Every so
/// many rays are looked at, half a million in all, so that a large cloud costs little more than reading it
/// three times. Memory: 36 bytes a cube with ends in it.
class TransparentCubes {
 public:
  /// Reads `source` three times, rewinding it before the second and after the last.
  TransparentCubes(const Context& context, RaySource& source);

  /// Thread-safe.
  [[nodiscard]] bool has(const Eigen::Vector3d& point) const;

 private:
  struct Counts {
    std::uint32_t hits = 0;
    std::uint32_t passes = 0;  ///< of the rays that were looked at
  };
  using Table = VoxelTable<Counts>;
  struct Grid {
    Metres width;
    std::unique_ptr<Table> cubes = std::make_unique<Table>();
  };
  void count_hits(const Context& context, RaySource& source);
  void count_passes(const Context& context, RaySource& source);

  std::vector<Grid> grids_;
  std::uint64_t stride_ = 1;
};

}  // namespace ray
