#pragma once
/// What the tools that look at surfaces have in common: which points they take and how far they look.

#include <raycloud/core/ray_cloud.h>
#include <raycloud/exec/blocks.h>
#include <raycloud/spatial/seen_point.h>
#include <raycloud/spatial/surfel.h>

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace ray {

inline constexpr std::size_t kSurfaceNeighbours = 16;

inline constexpr double kReachSpacings = 32.0;  ///< how far neighbours may be, in spacings

inline SeenPoint seen_point(const RayCloud& rays, std::size_t i) {
  return {rays.ends[i], pack_direction(rays.starts[i] - rays.ends[i])};
}

/// How far neighbours may be, by the sample alone: far enough for places with a hundredth of the density of
/// the rest. What is further from everything else has no neighbours. Infinite for very few points, 0
/// where all are in one place.
[[nodiscard]] double neighbour_reach(const EndSample& sample);

/// Calls `work(search, begin, end)` for ranges of places that cover the tree, on all threads; places of a
/// range are near each other.
void for_each_place(const Context& context, const PointTree& tree,
                    const std::function<void(NeighbourSearch&, std::size_t begin, std::size_t end)>& work);

/// The own places of a block, and in rings around them those that their results depend on. The rest of a
/// block lies within reach but is nobody's neighbour.
class NeededPlaces {
 public:
  /// Work on those places from begin to end that are `wanted`.
  using Wanted = std::function<bool(std::size_t place)>;
  using Work =
      std::function<void(NeighbourSearch&, std::size_t begin, std::size_t end, const Wanted& wanted)>;

  NeededPlaces(const Block<SeenPoint>& block, const PointTree& tree);

  /// What the neighbours of a place are when it has been worked on.
  struct Around {
    std::function<double(std::size_t place)> radius;  ///< m: none is further
    std::function<std::span<const std::uint32_t>(NeighbourSearch&, std::size_t place)> neighbours;
  };
  /// `work` on all own places; then on their neighbours, those of these, and so on, so many rings; on each
  /// place once.
  void work_on(const Context& context, std::uint8_t rings, const Work& work, const Around& around);

  /// Whether a place is own, or in one of the first so many rings.
  [[nodiscard]] bool has(std::size_t place, std::uint8_t rings) const {
    return ring_.empty() || ring_[place] <= rings;
  }

 private:
  void work_on_ring(const Context& context, std::uint8_t ring, const Work& work);
  void find_ring(const Context& context, std::uint8_t ring, const Around& around);

  static constexpr std::uint8_t kNoRing = 0xff;

  const Block<SeenPoint>& block_;
  const PointTree& tree_;
  std::vector<std::uint8_t> ring_;  ///< 0 for own places; empty: all are own
};

}  // namespace ray
