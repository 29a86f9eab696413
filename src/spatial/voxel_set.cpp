#include <raycloud/spatial/voxel_set.h>

namespace ray {

std::vector<std::uint8_t> VoxelSet::insert(const VoxelKeys& cubes) {
  std::vector<std::uint8_t> first_seen(cubes.keys.size());
  cubes_.add(cubes, {}, [&](std::size_t i, NoValue, bool is_new) { first_seen[i] = is_new ? 1 : 0; });
  return first_seen;
}

}  // namespace ray
