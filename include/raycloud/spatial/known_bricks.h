#pragma once
/// A small memory of which cubes rays have crossed, so that later rays through those cost little.

#include <raycloud/spatial/voxel_key.h>

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <memory>

namespace ray {

/// Numbers for the bricks (4³ cubes, spatial/crossed_cubes.h) less than 2^15 bricks from a centre along each
/// axis: 26 km for cubes of 20 cm.
class BrickNames {
 public:
  using Name = std::uint64_t;
  static constexpr Name kNone = 0;
  static constexpr std::int64_t kMostReach = std::int64_t{1} << 15;

  /// What a step along each axis adds to a name: x and rows of x, spread over the upper half, and y and z in
  /// the lower one.
  static constexpr std::array<Name, 3> kSteps{Name{1} << 32, (Name{0xc60a1} << 32) + 1,
                                              (Name{0x948ef} << 32) + (Name{1} << 16)};

  explicit BrickNames(const VoxelIndex& centre, std::int64_t reach = kMostReach)
      : centre_(centre), reach_(reach) {}

  /// Never the same for two bricks; kNone from `reach` on.
  [[nodiscard]] Name of(const VoxelIndex& brick) const {
    const std::int64_t x = brick.x - centre_.x, y = brick.y - centre_.y, z = brick.z - centre_.z;
    if (std::abs(x) >= reach_ || std::abs(y) >= reach_ || std::abs(z) >= reach_) return kNone;
    return static_cast<Name>(x + kMostReach) * kSteps[0] + static_cast<Name>(y + kMostReach) * kSteps[1] +
           static_cast<Name>(z + kMostReach) * kSteps[2];
  }

  /// Where a brick is in a table of `last` + 1 places, a power of two. Of those in one place no two have the
  /// same y and z if 2 `reach` is not above the number of places.
  [[nodiscard]] static std::size_t place(Name name, std::size_t last) { return name >> 32 & last; }

 private:
  VoxelIndex centre_;
  std::int64_t reach_;
};

/// Which cubes of bricks are known to be crossed. Has one place for many bricks, so that it forgets; but what
/// it knows is exact. While one thread learns, others may ask, without locks: they are told what was known
/// before or after.
///
/// Limits: knows bricks whose distance from the centre is below 2^15 and below half its number of places.
class KnownBricks {
 public:
  static constexpr std::size_t kMostBytes = std::size_t{1} << 24;  ///< smaller ones forget too much of a scan

  /// As many places of 16 bytes as fit in `bytes`: a power of two, one at least, kMostBytes at most.
  explicit KnownBricks(std::size_t bytes);

  /// What names count from, once before it learns. Others may ask meanwhile.
  void centre_on(const VoxelIndex& brick);
  [[nodiscard]] bool has_centre() const { return has_centre_.load(std::memory_order_acquire); }
  /// Precondition: has_centre().
  [[nodiscard]] const BrickNames& names() const { return names_; }

  /// Those cubes of a brick that are known to be crossed.
  [[nodiscard]] std::uint64_t cubes(BrickNames::Name name) const {
    Place& place = places_[BrickNames::place(name, last_)];
    return half(place.low, name) | half(place.high, name) << 32;
  }
  /// All the cubes of a brick that are crossed; of kNone it learns nothing.
  void learn(BrickNames::Name name, std::uint64_t cubes) {
    if (name == BrickNames::kNone) return;
    Place& place = places_[BrickNames::place(name, last_)];
    std::atomic_ref(place.low).store(name << 32 | (cubes & 0xffffffff), std::memory_order_relaxed);
    std::atomic_ref(place.high).store(name << 32 | cubes >> 32, std::memory_order_relaxed);
  }

  /// Forgets everything, the centre too. Not while others ask.
  void clear();
  /// Bytes held.
  [[nodiscard]] std::size_t memory() const { return (last_ + 1) * sizeof(Place); }

 private:
  /// Each half of the cubes with the lower half of the name, so that the halves of two bricks are never taken
  /// for one.
  struct Place {
    std::uint64_t low;
    std::uint64_t high;
  };
  struct Free {
    void operator()(Place* places) const { std::free(places); }
  };

  [[nodiscard]] static std::uint64_t half(std::uint64_t& word, BrickNames::Name name) {
    const std::uint64_t cubes = std::atomic_ref(word).load(std::memory_order_relaxed) ^ name << 32;
    return cubes >> 32 == 0 ? cubes : 0;
  }

  std::size_t last_;
  std::unique_ptr<Place[], Free> places_;
  BrickNames names_;
  std::atomic<bool> has_centre_ = false;
};

}  // namespace ray
