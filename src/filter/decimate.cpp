#include <raycloud/core/error.h>
#include <raycloud/filter/decimate.h>
#include <raycloud/spatial/voxel_set.h>

#include <cmath>
#include <vector>

namespace ray {
namespace {

/// The rows of `count`, the first of which is number `first` of the whole, whose number n divides.
std::vector<std::uint8_t> every(std::uint64_t n, std::uint64_t first, std::size_t count) {
  std::vector<std::uint8_t> mask(count, 0);
  const std::uint64_t passed = first % n;
  std::uint64_t i = passed == 0 ? 0 : n - passed;
  while (i < count) {
    mask[i] = 1;
    if (n > count - i) break;  // i + n could overflow
    i += n;
  }
  return mask;
}

}  // namespace

StreamCounts decimate_voxels(const Context& context, RaySource& source, RaySink& sink, Metres width) {
  if (!(width.value > 0.0) || !std::isfinite(width.value)) {
    throw Error(ErrorCode::usage, "the width of the cubes must be more than 0");
  }
  VoxelSet seen;
  return stream(
      context, source, &sink, [&](const RayCloud& rays) { return voxel_keys(rays.ends, width); },
      [&](RayCloud& rays, const VoxelKeys& cubes) { rays.select(seen.insert(cubes)); });
}

StreamCounts decimate_every(const Context& context, RaySource& source, RaySink& sink, std::uint64_t n) {
  if (n == 0) throw Error(ErrorCode::usage, "one ray in 0 cannot be kept: give 1 or more");
  std::uint64_t passed = 0;
  return stream(
      context, source, &sink, [](const RayCloud&) { return Nothing{}; },
      [&](RayCloud& rays, Nothing) {
        const std::size_t count = rays.size();
        rays.select(every(n, passed, count));
        passed += count;
      });
}

}  // namespace ray
