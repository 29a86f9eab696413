#include "ray_groups.h"

#include <raycloud/core/error.h>

#include <cmath>

namespace ray {
namespace {

[[noreturn]] void throw_too_many() {
  throw Error(ErrorCode::out_of_range, "more than 4294967294 rays of a decimated cloud cannot be restored");
}

}  // namespace

RayGroups::RayGroups(const Decimation& decimation) {
  if (const auto* every = std::get_if<EveryNth>(&decimation)) {
    every_ = every->n;
    if (every_ == 0) throw Error(ErrorCode::usage, "one ray in 0 cannot have been kept: give 1 or more");
    return;
  }
  width_ = std::get<Metres>(decimation);
  if (!(width_.value > 0.0) || !std::isfinite(width_.value)) {
    throw Error(ErrorCode::usage, "the width of the cubes must be more than 0");
  }
}

std::vector<std::uint8_t> RayGroups::first_of_each(const VoxelKeys& cubes) {
  std::vector<std::uint8_t> mask(cubes.keys.size());
  cubes_.add(cubes, {}, [&](std::size_t i, std::uint32_t& number, bool is_new) {
    if (!is_new) return;
    if (count_ == kNone) throw_too_many();
    number = count_++;
    mask[i] = 1;
  });
  return mask;
}

std::vector<std::uint8_t> RayGroups::first_of_each(std::uint64_t row, std::size_t count) {
  std::vector<std::uint8_t> mask(count);
  for (std::size_t i = 0; i < count; i++) {
    if ((row + i) % every_ != 0) continue;
    if (count_ == kNone) throw_too_many();
    count_++;
    mask[i] = 1;
  }
  return mask;
}

void RayGroups::gather(const Context& context, RaySource& full,
                       const std::function<void(const RayCloud&)>& see) {
  std::uint64_t row = 0;
  stream(
      context, full, nullptr,
      [&](const RayCloud& rays) { return by_row() ? VoxelKeys{} : voxel_keys(rays.ends, width_); },
      [&](RayCloud& rays, const VoxelKeys& cubes) {
        const std::size_t count = rays.size();
        rays.select(by_row() ? first_of_each(row, count) : first_of_each(cubes));
        see(rays);
        row += count;
      });
}

std::uint32_t RayGroups::at(const VoxelIndex& cube) const {
  const VoxelPlace place = voxel_place(cube);
  const auto* block = cubes_.find_block(place.block);
  const std::uint32_t* number = block == nullptr ? nullptr : block->find(place.key);
  return number == nullptr ? kNone : *number;
}

std::vector<std::uint32_t> RayGroups::of(const RayCloud& rays, std::uint64_t row) const {
  std::vector<std::uint32_t> groups(rays.size());
  if (by_row()) {
    for (std::size_t i = 0; i < groups.size(); i++)
      groups[i] = static_cast<std::uint32_t>((row + i) / every_);
    return groups;
  }
  constexpr std::size_t kAhead = 16;
  const VoxelKeys cubes = voxel_keys(rays.ends, width_);
  std::size_t i = 0;
  for (const VoxelKeys::Run& run : cubes.runs) {
    const auto* block = cubes_.find_block(run.block);
    for (; i < run.end; i++) {
      if (block != nullptr && i + kAhead < run.end) block->prefetch(cubes.keys[i + kAhead]);
      const std::uint32_t* number = block == nullptr ? nullptr : block->find(cubes.keys[i]);
      if (number == nullptr) {
        throw Error(ErrorCode::wrong_content, "the full cloud changed while it was being restored");
      }
      groups[i] = *number;
    }
  }
  return groups;
}

}  // namespace ray
