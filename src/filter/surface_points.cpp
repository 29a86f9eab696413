#include "surface_points.h"

#include <raycloud/exec/parallel.h>
#include <raycloud/spatial/point_spacing.h>

#include <atomic>
#include <cmath>
#include <limits>

namespace ray {

double neighbour_reach(const EndSample& sample) {
  // 16 neighbours on a surface are within 2.3 spacings.
  constexpr std::size_t kFew = 8;  // have no spacing
  if (sample.ends.size() < kFew) return std::numeric_limits<double>::infinity();
  const double spacing = estimate_spacing(sample.ends, sample.bounded).value;
  return kReachSpacings * spacing;
}

void for_each_place(const Context& context, const PointTree& tree,
                    const std::function<void(NeighbourSearch&, std::size_t begin, std::size_t end)>& work) {
  constexpr std::size_t kPlaces = 4096;
  parallel_for(context, tree.size(), kPlaces, [&](std::size_t begin, std::size_t end) {
    NeighbourSearch search(tree);
    work(search, begin, end);
  });
}

NeededPlaces::NeededPlaces(const Block<SeenPoint>& block, const PointTree& tree)
    : block_(block), tree_(tree), ring_(block.own.empty() ? 0 : tree.size()) {
  for (std::size_t place = 0; place < ring_.size(); ++place)
    ring_[place] = block.is_own(tree.index(place)) ? 0 : kNoRing;
}

void NeededPlaces::work_on(const Context& context, std::uint8_t rings, const Work& work,
                           const Around& around) {
  work_on_ring(context, 0, work);
  if (ring_.empty()) return;
  for (std::uint8_t ring = 1; ring <= rings; ++ring) {
    find_ring(context, ring, around);
    work_on_ring(context, ring, work);
  }
}

void NeededPlaces::work_on_ring(const Context& context, std::uint8_t ring, const Work& work) {
  for_each_place(context, tree_, [&](NeighbourSearch& search, std::size_t begin, std::size_t end) {
    work(search, begin, end, [&](std::size_t place) { return ring_.empty() || ring_[place] == ring; });
  });
}

void NeededPlaces::find_ring(const Context& context, std::uint8_t ring, const Around& around) {
  const auto ring_of = [&](std::size_t place) { return std::atomic_ref(ring_[place]); };
  for_each_place(context, tree_, [&](NeighbourSearch& search, std::size_t begin, std::size_t end) {
    for (std::size_t place = begin; place < end; ++place) {
      if (ring_of(place).load(std::memory_order_relaxed) != ring - 1) continue;
      if (block_.has_only_own(tree_.point(place), around.radius(place))) continue;
      for (const std::uint32_t neighbour : around.neighbours(search, place))
        if (ring_of(neighbour).load(std::memory_order_relaxed) == kNoRing)
          ring_of(neighbour).store(ring, std::memory_order_relaxed);
    }
  });
}

}  // namespace ray
