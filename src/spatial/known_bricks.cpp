#include <raycloud/spatial/known_bricks.h>

#include <algorithm>
#include <bit>
#include <new>

namespace ray {

KnownBricks::KnownBricks(std::size_t bytes)
    : last_(std::bit_floor(std::clamp(bytes, sizeof(Place), kMostBytes) / sizeof(Place)) - 1),
      names_(VoxelIndex{}) {
  clear();
}

void KnownBricks::centre_on(const VoxelIndex& brick) {
  names_ = BrickNames(brick, std::min(BrickNames::kMostReach, static_cast<std::int64_t>(last_ + 1) / 2));
  has_centre_.store(true, std::memory_order_release);
}

void KnownBricks::clear() {
  has_centre_ = false;
  places_.reset();
  places_.reset(static_cast<Place*>(std::calloc(last_ + 1, sizeof(Place))));
  if (places_ == nullptr) throw std::bad_alloc();
}

}  // namespace ray
