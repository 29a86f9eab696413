#include "free_cubes.h"

#include <raycloud/exec/parallel.h>
#include <raycloud/spatial/crossed_cubes.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <mutex>

namespace ray::align {
namespace {

constexpr double kClear = 1.5;  // cubes

struct Rays {
  std::vector<Eigen::Vector3d> starts, ends;
};

/// How far (m) before its end a ray is to be cut, so that it is clear of the surface it hit.
double clearance(const PatchLevel& level, const Eigen::Vector3d& end, const Eigen::Vector3d& way,
                 double length) {
  constexpr double kLeastSine = 0.05;    // of the angle to the surface
  constexpr double kShareUnknown = 0.2;  // of a ray to what is no surface
  double nearest = std::numeric_limits<double>::infinity(), sine = 0.0;
  level.each_near(end, [&](const Patch& patch) {
    const double distance2 = (patch.mean - end).squaredNorm();
    if (!patch.is_flat() || distance2 >= nearest) return;
    nearest = distance2;
    sine = std::abs(patch.normal.dot(way)) / length;
  });
  const double clear = kClear * level.width();
  return sine > 0.0 ? clear / std::max(sine, kLeastSine) : std::max(clear, kShareUnknown * length);
}

/// One ray of each cube with points, cut short, and those to the sky.
Rays free_parts(const Context& context, const Surfaces& surfaces, const PatchLevel& level) {
  constexpr double kExtents = 4.0;
  const std::vector<Gathered>& gathered = surfaces.gathered;
  std::vector<double> cuts(gathered.size());
  parallel_for(context, gathered.size(), 1024, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Eigen::Vector3d way = (gathered[i].seen - gathered[i].sensor).cast<double>();
      const double length = way.norm();
      if (length > 0.0) cuts[i] = clearance(level, gathered[i].seen.cast<double>(), way, length);
    }
  });
  // A small thing seen from afar has cubes so small that a whole ray would cross millions.
  const double most = kExtents * surfaces.survey.extent;
  // Where a cloud was cut, rays begin and end in the middle of a cube, perhaps just before a surface.
  const double clear = kClear * level.width();
  Rays rays;
  rays.starts.reserve(gathered.size() + surfaces.sky.size());
  rays.ends.reserve(gathered.size() + surfaces.sky.size());
  const auto add = [&](const Segment& ray, double at_end) {
    const Eigen::Vector3d start = ray.start.cast<double>(), way = ray.end.cast<double>() - start;
    const double length = way.norm(), end = length - at_end, begin = std::max(clear, end - most);
    if (!(begin < end)) return;
    rays.starts.emplace_back(start + begin / length * way);
    rays.ends.emplace_back(start + end / length * way);
  };
  for (std::size_t i = 0; i < gathered.size(); ++i)
    add({gathered[i].sensor, gathered[i].seen}, cuts[i]);
  for (const Segment& segment : surfaces.sky)
    add(segment, clear);
  return rays;
}

}  // namespace

FreeCubes::FreeCubes(const Context& context, const Surfaces& surfaces, const PatchLevel& level)
    : width_(level.width()) {
  constexpr std::size_t kGrain = 2048;
  constexpr std::size_t kMostBricks = std::size_t{1} << 16;  // at once
  const Rays rays = free_parts(context, surfaces, level);
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
