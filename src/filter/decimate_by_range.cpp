#include "key_passes.h"

#include <raycloud/core/error.h>
#include <raycloud/filter/decimate.h>
#include <raycloud/spatial/key_table.h>

#include <array>
#include <bitset>
#include <cmath>
#include <cstdint>
#include <vector>

namespace ray {
namespace {

using Mask = std::vector<std::uint8_t>;
constexpr int kFinest = -20;  // cubes of 2^-20 m
constexpr std::size_t kLevels = 64;

/// The cube of a ray: 2^(level + kFinest) m wide.
struct Cube {
  static constexpr std::int8_t kNone = -1;
  VoxelIndex index;
  VoxelPlace place;
  std::int8_t level = kNone;  // kNone: the ray is too short to have one
};

Metres width_of(std::size_t level) {
  return {std::ldexp(1.0, static_cast<int>(level) + kFinest)};
}

std::vector<Cube> cubes_of(const RayCloud& rays, double per_metre) {
  std::vector<Cube> cubes(rays.size());
  for (std::size_t i = 0; i < rays.size(); i++) {
    const double spacing = per_metre * (rays.ends[i] - rays.starts[i]).norm();
    if (!(spacing >= width_of(0).value)) continue;
    const int level = std::min(std::ilogb(spacing) - kFinest, static_cast<int>(kLevels) - 1);
    Cube& cube = cubes[i];
    cube.level = static_cast<std::int8_t>(level);
    cube.index = voxel_index(rays.ends[i], width_of(static_cast<std::size_t>(level)));
    cube.place = voxel_place(cube.index);
  }
  return cubes;
}

/// The cubes of every width that hold the end of a kept ray of their own width or a smaller one.
class Occupied {
 public:
  /// Whether the ray stays; marks its cube and those around it then.
  bool keep(const Cube& cube) {
    auto level = static_cast<std::size_t>(cube.level);
    if (!levels_[level].block(cube.place.block).add(cube.place.key).is_new) return false;
    // Around an occupied cube all are occupied.
    VoxelIndex index = cube.index;
    while (++level < kLevels) {
      index = {index.x >> 1, index.y >> 1, index.z >> 1};
      const VoxelPlace place = voxel_place(index);
      if (!levels_[level].block(place.block).add(place.key).is_new) break;
    }
    return true;
  }
  void prefetch(const Cube& cube) {
    if (cube.level == Cube::kNone) return;
    levels_[static_cast<std::size_t>(cube.level)].block(cube.place.block).prefetch(cube.place.key);
  }
  [[nodiscard]] std::size_t memory() const {
    std::size_t sum = 0;
    for (const VoxelTable<>& level : levels_)
      sum += level.memory();
    return sum;
  }
  void clear() {
    for (VoxelTable<>& level : levels_)
      level.clear();
  }

 private:
  std::array<VoxelTable<>, kLevels> levels_;
};

Mask keep_unoccupied(Occupied& occupied, const std::vector<Cube>& cubes) {
  constexpr std::size_t kAhead = 16;
  Mask mask(cubes.size());
  for (std::size_t i = 0; i < cubes.size(); i++) {
    if (i + kAhead < cubes.size()) occupied.prefetch(cubes[i + kAhead]);
    mask[i] = cubes[i].level == Cube::kNone || occupied.keep(cubes[i]) ? 1 : 0;
  }
  return mask;
}

/// The rays of one level that stay because of a cube in `range`. Precondition: those of the levels below are
/// in `kept`.
void settle_level(const Context& context, RaySource& source, double per_metre, std::size_t level,
                  std::size_t budget, RowBits& kept) {
  VoxelTable<> cubes;
  const auto keep = [&](const RayCloud& rays, const Cube& cube, std::size_t i, ShardRange range,
                        bool already_kept) {
    const auto own = static_cast<std::size_t>(cube.level);
    if (cube.level == Cube::kNone || own > level || (own < level && !already_kept)) return false;
    const VoxelPlace place =
        own == level ? cube.place : voxel_place(voxel_index(rays.ends[i], width_of(level)));
    return range.has(place.key) && cubes.block(place.block).add(place.key).is_new && own == level;
  };
  for (ShardRange range; range.first < ShardRange::kShards;
       range = next_range(range, cubes.memory(), budget)) {
    cubes.clear();
    source.rewind();
    std::uint64_t row = 0;
    stream(
        context, source, nullptr, [&](const RayCloud& rays) { return cubes_of(rays, per_metre); },
        [&](const RayCloud& rays, const std::vector<Cube>& all) {
          Mask mask(rays.size());
          for (std::size_t i = 0; i < rays.size(); i++)
            mask[i] = keep(rays, all[i], i, range, kept.has(row + i)) ? 1 : 0;
          kept.set(row, mask);
          row += rays.size();
          shrink_to_budget(cubes, budget, range);
        });
  }
}

}  // namespace

StreamCounts decimate_by_range(const Context& context, RaySource& source, RaySink& sink, double per_metre) {
  if (!(per_metre > 0.0) || !std::isfinite(per_metre)) {
    throw Error(ErrorCode::usage, "the spacing for each metre of range must be more than 0");
  }
  const std::size_t budget = table_budget(context);
  Occupied occupied;
  bool is_short = false;        // of memory
  RowBits kept;                 // once it is short
  std::bitset<kLevels> levels;  // that rays have
  std::uint64_t settled = 0;    // rows that are written or dropped for good
  std::uint64_t row = 0;
  StreamCounts counts = stream(
      context, source, &sink, [&](const RayCloud& rays) { return cubes_of(rays, per_metre); },
      [&](const RayCloud&, const std::vector<Cube>& cubes) {
        Mask too_short(cubes.size());
        for (std::size_t i = 0; i < cubes.size(); i++) {
          too_short[i] = cubes[i].level == Cube::kNone ? 1 : 0;
          if (too_short[i] == 0) levels.set(static_cast<std::size_t>(cubes[i].level));
        }
        kept.set(row, too_short);
        row += cubes.size();
        if (is_short) return Mask(cubes.size());
        Mask mask = keep_unoccupied(occupied, cubes);
        settled = row;
        is_short = occupied.memory() > budget;
        if (is_short) occupied.clear();
        return mask;
      });
  if (!is_short) return counts;
  for (std::size_t level = 0; level < kLevels; level++) {
    if (levels.test(level)) settle_level(context, source, per_metre, level, budget, kept);
  }
  counts.rays_out += write_rows(context, source, sink, kept, settled);
  return counts;
}

}  // namespace ray
