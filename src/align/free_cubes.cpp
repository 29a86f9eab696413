#include "free_cubes.h"

#include <raycloud/exec/parallel.h>
#include <raycloud/spatial/crossed_cubes.h>

#include <algorithm>
#include <mutex>

namespace ray::align {
namespace {

struct Rays {
  std::vector<Eigen::Vector3d> starts, ends;
};

/// The rays of the patches, cut short, and those to the sky.
Rays free_parts(const PatchLevel& level, const std::vector<Segment>& sky) {
  constexpr double kClear = 1.5;         // cubes
  constexpr double kLeastSine = 0.05;    // of the angle to the surface
  constexpr double kShareUnknown = 0.2;  // of a ray to what is no surface
  Rays rays;
  for (const Patch& patch : level.patches()) {
    const Eigen::Vector3d start = patch.sensor.cast<double>(), way = patch.mean - start;
    const double length = way.norm();
    if (!(length > 0.0)) continue;
    const double sine = std::max(std::abs(patch.normal.dot(way)) / length, kLeastSine);
    const double clear = kClear * level.width();
    const double cut = patch.is_flat() ? clear / sine : std::max(clear, kShareUnknown * length);
    if (cut >= length) continue;
    rays.starts.push_back(start);
    rays.ends.push_back(patch.mean - way * (cut / length));
  }
  for (const Segment& segment : sky) {
    rays.starts.push_back(segment.start.cast<double>());
    rays.ends.push_back(segment.end.cast<double>());
  }
  return rays;
}

}  // namespace

FreeCubes::FreeCubes(const Context& context, const PatchLevel& level, const std::vector<Segment>& sky)
    : width_(level.width()) {
  constexpr std::size_t kGrain = 2048;
  constexpr std::size_t kMostBricks = std::size_t{1} << 20;  // at once
  const Rays rays = free_parts(level, sky);
  std::mutex mutex;  // bits that are set by "or" are the same in any order
  parallel_for(context, rays.starts.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t next = begin; next < end;) {
      const CrossedCubes crossed =
          crossed_cubes(std::span(rays.starts).subspan(next, end - next),
                        std::span(rays.ends).subspan(next, end - next), {width_}, kMostBricks);
      next += crossed.done;
      const std::lock_guard lock(mutex);
      for (const CrossedCubes::Brick& brick : crossed.all)
        *bricks_.add(brick.place.key).value |= brick.cubes;
    }
  });
}

bool FreeCubes::is_crossed(const Eigen::Vector3d& point) const {
  const Eigen::Array3d place = (point.array() / width_).floor();
  constexpr double kFurthest = 1 << 21;  // of one block of bricks, less a margin
  if (!(place.abs() < kFurthest).all()) return false;
  const Eigen::Array<std::int64_t, 3, 1> cube = place.cast<std::int64_t>();
  const std::uint64_t* bits = bricks_.find(voxel_place({cube.x() >> 2, cube.y() >> 2, cube.z() >> 2}).key);
  const std::int64_t bit = (cube.x() & 3) + 4 * (cube.y() & 3) + 16 * (cube.z() & 3);
  return bits != nullptr && (*bits >> bit & 1) != 0;
}

}  // namespace ray::align
