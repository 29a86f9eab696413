#include "transparent_cubes.h"

#include "surface_points.h"

#include <raycloud/exec/stream.h>
#include <raycloud/spatial/point_spacing.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>

namespace ray {
namespace {

constexpr std::uint64_t kLooks = 500000;
constexpr std::array kSpacings{6.0, 24.0};  // the widths of the cubes

/// The cubes from that of `start` to that of `end`, that one excluded, face by face (Amanatides and Woo
/// 1987).
template <class Visit>
void each_cube_before_end(const Eigen::Vector3d& start, const Eigen::Vector3d& end, double width,
                          const Visit& visit) {
  constexpr std::int64_t kMost = 1 << 20;  // of an outlier's ray, the beginning will do
  const VoxelIndex first = voxel_index(start, {width});
  const VoxelIndex last = voxel_index(end, {width});
  std::array<std::int64_t, 3> cube{first.x, first.y, first.z};
  const std::array<std::int64_t, 3> goal{last.x, last.y, last.z};
  std::array<std::int64_t, 3> step{};
  std::array<double, 3> next{}, each{};
  std::int64_t left = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<Eigen::Index>(axis);
    const double way = end[a] - start[a];
    left += std::abs(goal[axis] - cube[axis]);
    step[axis] = goal[axis] > cube[axis] ? 1 : goal[axis] < cube[axis] ? -1 : 0;
    if (step[axis] == 0) {
      next[axis] = std::numeric_limits<double>::infinity();
      continue;
    }
    each[axis] = width / std::abs(way);
    const double face = static_cast<double>(cube[axis] + (step[axis] > 0 ? 1 : 0)) * width;
    next[axis] = (face - start[a]) / way;
  }
  for (left = std::min(left, kMost); left > 0; --left) {
    visit(VoxelIndex{cube[0], cube[1], cube[2]});
    const std::size_t axis = next[0] <= next[1] && next[0] <= next[2] ? 0 : next[1] <= next[2] ? 1 : 2;
    cube[axis] += step[axis];
    next[axis] = cube[axis] == goal[axis] ? std::numeric_limits<double>::infinity() : next[axis] + each[axis];
  }
}

/// Counts a ray in the cubes with ends in them that it passes.
template <class Counts>
void count_pass(const VoxelTable<Counts>& cubes, double width, const Eigen::Vector3d& start,
                const Eigen::Vector3d& end) {
  VoxelIndex number;
  const KeyTable<Counts>* block = nullptr;
  bool known = false;
  each_cube_before_end(start, end, width, [&](const VoxelIndex& cube) {
    const VoxelPlace place = voxel_place(cube);
    if (!known || place.block != number) {
      block = cubes.find_block(place.block);
      number = place.block;
      known = true;
    }
    const Counts* counts = block == nullptr ? nullptr : block->find(place.key);
    // Adding is all that happens meanwhile, and whole numbers add up the same in any order.
    if (counts != nullptr)
      std::atomic_ref(const_cast<Counts*>(counts)->passes).fetch_add(1, std::memory_order_relaxed);
  });
}

}  // namespace

TransparentCubes::TransparentCubes(const Context& context, RaySource& source) {
  blocks::EndSampler sampler;
  const StreamCounts counts = stream(
      context, source, nullptr,
      [](const RayCloud& rays) {
        return rays.size() - static_cast<std::size_t>(
                                 std::count(rays.bounded.begin(), rays.bounded.end(), std::uint8_t{0}));
      },
      [&](const RayCloud& rays, std::size_t bounded) { sampler.add(rays, bounded); });
  source.rewind();
  const double spacing = estimate_spacing(sampler.sample().ends, sampler.sample().bounded).value;
  if (!(spacing > 0.0)) return;
  for (const double spacings : kSpacings)
    grids_.push_back({.width = {spacings * spacing}});
  stride_ = counts.rays_in / kLooks + 1;
  count_hits(context, source);
  source.rewind();
  count_passes(context, source);
  source.rewind();
}

void TransparentCubes::count_hits(const Context& context, RaySource& source) {
  stream(
      context, source, nullptr,
      [&](RayCloud& rays) {
        rays.select(rays.bounded);
        std::vector<VoxelKeys> keys;
        for (const Grid& grid : grids_)
          keys.push_back(voxel_keys(rays.ends, grid.width));
        return keys;
      },
      [&](const RayCloud&, const std::vector<VoxelKeys>& keys) {
        for (std::size_t i = 0; i < grids_.size(); ++i)
          grids_[i].cubes->add(keys[i], {}, [](std::size_t, Counts& counts, bool) { ++counts.hits; });
      });
}

void TransparentCubes::count_passes(const Context& context, RaySource& source) {
  // Which rays are looked at depends on their place in the cloud, which only the ordered part knows.
  std::uint64_t seen = 0;
  std::vector<Eigen::Vector3d> starts, ends;
  stream(
      context, source, nullptr, [](const RayCloud&) { return Nothing{}; },
      [&](const RayCloud& rays, Nothing) {
        for (std::size_t i = 0; i < rays.size(); ++i, ++seen) {
          if (seen % stride_ != 0) continue;
          starts.push_back(rays.starts[i]);
          ends.push_back(rays.ends[i]);
        }
      });
  parallel_for(context, ends.size(), 1024, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      for (const Grid& grid : grids_)
        count_pass(*grid.cubes, grid.width.value, starts[i], ends[i]);
  });
}

bool TransparentCubes::has(const Eigen::Vector3d& point) const {
  constexpr double kOpacity = 0.02;
  constexpr std::uint32_t kFewest = 8;  // looks
  for (const Grid& grid : grids_) {
    const VoxelPlace place = voxel_place(voxel_index(point, grid.width));
    const KeyTable<Counts>* block = grid.cubes->find_block(place.block);
    const Counts* counts = block == nullptr ? nullptr : block->find(place.key);
    if (counts == nullptr || counts->passes < kFewest) continue;
    const double passes = static_cast<double>(counts->passes) * static_cast<double>(stride_);
    if (counts->hits < kOpacity * (counts->hits + passes)) return true;
  }
  return false;
}

}  // namespace ray
