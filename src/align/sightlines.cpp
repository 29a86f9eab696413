#include "sightlines.h"

#include <raycloud/exec/parallel.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>

namespace ray::align {
namespace {

/// Whether a ray goes through the middle of a patch, from well before its plane to well behind it.
bool goes_through(const Eigen::Vector3d& start, const Eigen::Vector3d& end, const Patch& patch,
                  double clear) {
  constexpr double kLeastSine = 0.2;  // of the angle to the surface: flat ones pass by what is rough
  constexpr double kReach = 1.0;      // standard deviations along the patch, of √3 that it has
  const double before = patch.normal.dot(start - patch.mean), after = patch.normal.dot(end - patch.mean);
  if (std::min(std::abs(before), std::abs(after)) < clear || (before > 0.0) == (after > 0.0)) return false;
  const Eigen::Vector3d way = end - start;
  if (std::abs(before - after) < kLeastSine * way.norm()) return false;
  const Eigen::Vector3d off = start + before / (before - after) * way - patch.mean;
  const double along = off.dot(patch.along), across = off.dot(patch.normal.cross(patch.along));
  return along * along / patch.variances[2] + across * across / patch.variances[1] < kReach * kReach;
}

/// Calls `visit(cube)` for the cubes between two places, from face to face (Amanatides and Woo 1987).
template <class Visit>
void each_crossed(const Eigen::Vector3d& start, const Eigen::Vector3d& end, const Visit& visit) {
  using Cube = Eigen::Array<std::int64_t, 3, 1>;
  constexpr double kNever = std::numeric_limits<double>::infinity();
  Cube cube = start.array().floor().cast<std::int64_t>();
  const Cube last = end.array().floor().cast<std::int64_t>();
  const Eigen::Vector3d way = end - start;
  Eigen::Array3d next, step;
  for (Eigen::Index i = 0; i < 3; ++i) {
    step[i] = way[i] != 0.0 ? 1.0 / std::abs(way[i]) : kNever;
    const double face = static_cast<double>(cube[i]) + (way[i] > 0.0 ? 1.0 : 0.0);
    next[i] = way[i] != 0.0 ? (face - start[i]) / way[i] : kNever;
  }
  for (std::int64_t left = (last - cube).abs().sum(); left >= 0; --left) {
    visit(cube);
    Eigen::Index axis = 0;
    next.minCoeff(&axis);
    cube[axis] += way[axis] > 0.0 ? 1 : -1;
    next[axis] += step[axis];
  }
}

}  // namespace

std::vector<Segment> sightlines_of(const Surfaces& surfaces, std::size_t most) {
  constexpr std::uint64_t kGolden = 0x9e3779b97f4a7c15U;
  const double share = static_cast<double>(most) / static_cast<double>(surfaces.gathered.size());
  const std::uint64_t threshold =
      share < 1.0 ? static_cast<std::uint64_t>(0x1p64 * share) : ~std::uint64_t{0};
  std::vector<Segment> rays;
  rays.reserve(std::min(most, surfaces.gathered.size()));
  for (std::size_t i = 0; i < surfaces.gathered.size() && rays.size() < most; ++i)
    if (i * kGolden <= threshold) rays.push_back({surfaces.gathered[i].sensor, surfaces.gathered[i].seen});
  return rays;
}

std::vector<std::uint8_t> pierced_patches(const Context& context, const std::vector<Segment>& rays,
                                          const Pose& pose, const PatchLevel& level) {
  constexpr std::size_t kGrain = 256;
  constexpr double kClear = 0.25, kFurthest = 1 << 10;  // widths
  const double clear = kClear * level.width();
  const std::vector<Patch>& patches = level.patches();
  std::vector<std::atomic<std::uint8_t>> pierced(patches.size());
  parallel_for(context, rays.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Eigen::Vector3d from = pose * rays[i].start.cast<double>(),
                            to = pose * rays[i].end.cast<double>();
      const Eigen::Vector3d first = from / level.width(), last = to / level.width();
      // A small thing seen from afar: its rays would cross thousands of cubes.
      if (!((last - first).norm() < kFurthest)) continue;
      each_crossed(first, last, [&](const Eigen::Array<std::int64_t, 3, 1>& cube) {
        level.each_in(cube, [&](const Patch& patch) {
          if (level.is_clean(patch) && goes_through(from, to, patch, clear))
            pierced[static_cast<std::size_t>(&patch - patches.data())].store(1, std::memory_order_relaxed);
        });
      });
    }
  });
  return {pierced.begin(), pierced.end()};
}

}  // namespace ray::align
