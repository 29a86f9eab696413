#include "key_passes.h"

#include <raycloud/core/error.h>
#include <raycloud/filter/decimate.h>
#include <raycloud/spatial/crossed_cubes.h>

#include <cmath>
#include <limits>
#include <span>
#include <utility>
#include <vector>

namespace ray {
namespace {

using Mask = std::vector<std::uint8_t>;

/// The first ray in each cube.
struct FirstInCube {
  Metres width;
  VoxelTable<> cubes = {};

  [[nodiscard]] VoxelKeys keys_of(const RayCloud& rays) const { return voxel_keys(rays.ends, width); }
  void keep(const RayCloud&, const VoxelKeys& keys, ShardRange range, Mask& mask) {
    cubes.add(keys, range, [&](std::size_t i, NoValue, bool is_new) { mask[i] = is_new ? 1 : 0; });
  }
  [[nodiscard]] std::size_t memory() const { return cubes.memory(); }
  void restrict_to(ShardRange range) { cubes.restrict_to(range); }
  void clear() { cubes.clear(); }
};

/// The first rays in each cube.
struct FewInCube {
  Metres width;
  std::uint32_t most;
  VoxelTable<std::uint32_t> cubes = {};

  [[nodiscard]] VoxelKeys keys_of(const RayCloud& rays) const { return voxel_keys(rays.ends, width); }
  void keep(const RayCloud&, const VoxelKeys& keys, ShardRange range, Mask& mask) {
    cubes.add(keys, range, [&](std::size_t i, std::uint32_t& count, bool) {
      mask[i] = count < most ? 1 : 0;
      count += mask[i];
    });
  }
  [[nodiscard]] std::size_t memory() const { return cubes.memory(); }
  void restrict_to(ShardRange range) { cubes.restrict_to(range); }
  void clear() { cubes.clear(); }
};

/// The rays that cross a cube first.
struct FirstThroughCube {
  static constexpr std::size_t kMostBricks = 1 << 20;  // at a time
  Metres width;
  KnownBricks known;  // a part of what is in `bricks`, for those who look at later rays meanwhile
  VoxelTable<std::uint64_t> bricks = {};

  [[nodiscard]] CrossedCubes keys_of(const RayCloud& rays) const {
    return crossed_cubes(rays.starts, rays.ends, width, kMostBricks, &known);
  }
  void keep(const RayCloud& rays, const CrossedCubes& first, ShardRange range, Mask& mask) {
    if (!known.has_centre() && rays.size() != 0) {
      const VoxelIndex cube = voxel_index(rays.starts.front(), width);
      known.centre_on({cube.x >> 2, cube.y >> 2, cube.z >> 2});
    }
    see(first, range, mask);
    for (std::size_t done = first.done; done < rays.size();) {
      const CrossedCubes more = crossed_cubes(std::span(rays.starts).subspan(done),
                                              std::span(rays.ends).subspan(done), width, kMostBricks, &known);
      see(more, range, std::span(mask).subspan(done));
      done += more.done;
    }
  }
  void see(const CrossedCubes& crossed, ShardRange range, std::span<std::uint8_t> mask) {
    std::vector<std::uint64_t> before = remember(crossed.all, range);
    for (std::size_t i = 0; i < crossed.cubes.size(); i++) {
      std::uint64_t& cubes = before[crossed.which[i]];
      if ((crossed.cubes[i] & ~cubes) == 0) continue;
      cubes |= crossed.cubes[i];
      mask[crossed.rays[i]] = 1;
    }
  }
  /// The cubes of each brick that were crossed before; all, where they are not in the range.
  std::vector<std::uint64_t> remember(std::span<const CrossedCubes::Brick> crossed, ShardRange range) {
    constexpr std::size_t kAhead = 16;  // as VoxelTable::add
    std::vector<std::uint64_t> before(crossed.size(), ~std::uint64_t{0});
    for (std::size_t i = 0; i < crossed.size(); i++) {
      const VoxelPlace& place = crossed[i].place;
      KeyTable<std::uint64_t>& table = bricks.block(place.block);
      if (i + kAhead < crossed.size() && crossed[i + kAhead].place.block == place.block) {
        table.prefetch(crossed[i + kAhead].place.key);
      }
      if (!range.has(place.key)) continue;
      std::uint64_t& cubes = *table.add(place.key).value;
      before[i] = cubes;
      cubes |= crossed[i].cubes;
      known.learn(crossed[i].name, cubes);
    }
    return before;
  }
  [[nodiscard]] std::size_t memory() const { return bricks.memory() + known.memory(); }
  void restrict_to(ShardRange range) { bricks.restrict_to(range); }
  void clear() {
    bricks.clear();
    known.clear();
  }
};

/// The rows of `count`, the first of which is number `first` of the whole, whose number n divides.
Mask every(std::uint64_t n, std::uint64_t first, std::size_t count) {
  Mask mask(count, 0);
  const std::uint64_t passed = first % n;
  std::uint64_t i = passed == 0 ? 0 : n - passed;
  while (i < count) {
    mask[i] = 1;
    if (n > count - i) break;  // i + n could overflow
    i += n;
  }
  return mask;
}

void check_width(Metres width) {
  if (!(width.value > 0.0) || !std::isfinite(width.value)) {
    throw Error(ErrorCode::usage, "the width of the cubes must be more than 0");
  }
}

}  // namespace

StreamCounts decimate_voxels(const Context& context, RaySource& source, RaySink& sink, Metres width) {
  check_width(width);
  FirstInCube rule{width};
  return keep_by_keys(context, source, sink, rule);
}

StreamCounts decimate_to_count(const Context& context, RaySource& source, RaySink& sink, Metres width,
                               std::uint64_t most) {
  check_width(width);
  if (most == 0 || most > std::numeric_limits<std::uint32_t>::max()) {
    throw Error(ErrorCode::usage, "a cube can keep from 1 to 4294967295 points");
  }
  FewInCube rule{width, static_cast<std::uint32_t>(most)};
  return keep_by_keys(context, source, sink, rule);
}

StreamCounts decimate_paths(const Context& context, RaySource& source, RaySink& sink, Metres width) {
  check_width(width);
  FirstThroughCube rule{width, KnownBricks(table_budget(context) / 4)};
  return keep_by_keys(context, source, sink, rule);
}

StreamCounts decimate_every(const Context& context, RaySource& source, RaySink& sink, std::uint64_t n) {
  if (n == 0) throw Error(ErrorCode::usage, "one ray in 0 cannot be kept: give 1 or more");
  std::uint64_t passed = 0;
  return stream(
      context, source, &sink, [](const RayCloud&) { return Nothing{}; },
      [&](RayCloud& rays, Nothing) {
        return every(n, std::exchange(passed, passed + rays.size()), rays.size());
      });
}

}  // namespace ray
