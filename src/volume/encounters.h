#pragma once
/// How the rays of one cloud met the ellipsoids of another, or of their own.

#include <raycloud/core/ray_cloud.h>
#include <raycloud/volume/free_space.h>

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace ray {

/// Times in 2^32 steps from the first to the last of several clouds: fine enough to tell which of two clouds
/// came first, and exact to add up.
class FineTime {
 public:
  FineTime(double first, double last)
      : first_(first), per_second_(last > first ? 4294967295.0 / (last - first) : 0.0) {}
  [[nodiscard]] std::uint32_t tick(double time) const {
    return static_cast<std::uint32_t>((time - first_) * per_second_);
  }

 private:
  double first_;
  double per_second_;
};

/// 32 bytes.
struct Encounters {
  std::uint32_t hits = 0;       ///< bounded rays that end in it
  std::uint32_t crossings = 0;  ///< rays that begin before it and end behind it
  std::uint32_t passes = 0;     ///< of these, those that prove it empty
  std::uint16_t looks = 0;      ///< a bit for each look of the passes, by its hash
  std::uint64_t hit_ticks = 0;  ///< sums of FineTime
  std::uint64_t pass_ticks = 0;
};

/// Of each ellipsoid, by slot, counts the rays that prove it empty, up to 255. Any number of threads may add
/// rays at once. About 1 µs a ray.
void count_passes(const EllipsoidTree& tree, const RayCloud& rays, const PassGuard& guard,
                  std::span<std::uint8_t> passes);

/// `look_times` are those by which looks are told apart, s. Threads as above.
void add_encounters(const EllipsoidTree& tree, const RayCloud& rays, std::span<const double> look_times,
                    const CountRule& rule, const FineTime& times, std::span<Encounters> encounters);

/// Some ellipsoids as a tree of their own, through which a walk is quick.
struct SomeEllipsoids {
  std::vector<std::uint32_t> slots;     ///< of each, in the whole tree
  std::unique_ptr<EllipsoidTree> tree;  ///< ellipsoid `i` is that of `slots[i]`, at slot `tree->slot(i)`
  [[nodiscard]] bool empty() const { return slots.empty(); }
};
[[nodiscard]] SomeEllipsoids some_of(const Context& context, const EllipsoidTree& whole,
                                     std::vector<std::uint32_t> slots);

}  // namespace ray
