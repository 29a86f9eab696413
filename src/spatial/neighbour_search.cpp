#include "leaf_surroundings.h"
#include "tree_walk.h"

#include <raycloud/spatial/neighbour_search.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <optional>

namespace ray {

class NeighbourSearch::Impl {
 public:
  explicit Impl(const PointTree& tree) : tree_(tree), walk_(tree), around_(tree) {}

  std::span<const Neighbour> nearest(std::size_t place, std::size_t count, double reach,
                                     const Eigen::Vector3d* side) {
    assert(count <= kMost && place < tree_.size());
    if (count == 0) return {};
    if (walk_.go_to(place)) {
      around_.forget();
      is_first_ = true;
      // Who says how far it is, to about what was found last, knows.
      reach_is_close_ = reach < kWide * last_radius_;
    }
    if (reach_is_close_ && reach > around_.reach() && (is_first_ || reach < kMuchWider * around_.reach())) {
      reach_is_close_ = around_.gather(walk_, (is_first_ ? kWideOfReach : kWideOfWider) * reach);
      is_first_ = false;
    }
    std::optional<std::span<const Neighbour>> found;
    double within2 = reach * reach;
    if (around_.has(place)) {
      found = around_.nearest(place, count, reach, side);
      within2 = std::min(within2, around_.bound2());
    }
    if (!found) {
      if (side == nullptr) within2 = std::min(within2, within2_of(place, count));
      found = walk_.nearest(place, count, within2, side);
      if (is_first_ && found->size() == count) around_.gather(walk_, kWide * furthest(*found));
      is_first_ = false;
    }
    remember(place, side == nullptr ? count : 0, *found);
    return *found;
  }

 private:
  static constexpr double kInfinity = std::numeric_limits<double>::infinity();

  static double furthest(std::span<const Neighbour> neighbours) {
    double furthest2 = 0.0;
    for (const Neighbour& neighbour : neighbours)
      furthest2 = std::max(furthest2, neighbour.distance2);
    return std::sqrt(furthest2);
  }

  /// The neighbours of the last point, and that point, are no further than this.
  double within2_of(std::size_t place, std::size_t count) const {
    if (last_count_ != count) return kInfinity;
    const double within = (tree_.point(place) - tree_.point(last_place_)).norm() + last_radius_;
    return within * within * (1.0 + 1e-9);
  }
  void remember(std::size_t place, std::size_t count, std::span<const Neighbour> found) {
    last_place_ = place;
    last_count_ = found.size() == count ? count : 0;
    last_radius_ = furthest(found);
  }

  // Most points of a leaf have their neighbours within so many times the distance of those of its first.
  static constexpr double kWide = 1.4;
  static constexpr double kWideOfReach = 1.3, kWideOfWider = 1.15;
  static constexpr double kMuchWider = 2.0;

  const PointTree& tree_;
  TreeWalk walk_;
  LeafSurroundings around_;
  bool is_first_ = true;         // in the leaf
  bool reach_is_close_ = false;  // to the distance of the neighbours
  // Of the last search for all; the count is 0 if it found fewer.
  std::size_t last_place_ = 0;
  std::size_t last_count_ = 0;
  double last_radius_ = 0.0;
};

NeighbourSearch::NeighbourSearch(const PointTree& tree) : tree_(tree), impl_(std::make_unique<Impl>(tree)) {}
NeighbourSearch::~NeighbourSearch() = default;

std::span<const Neighbour> NeighbourSearch::nearest(std::size_t place, std::size_t count, double reach) {
  return impl_->nearest(place, count, reach, nullptr);
}

std::span<const Neighbour> NeighbourSearch::nearest_facing(std::size_t place, std::size_t count, double reach,
                                                           const Eigen::Vector3d& normal) {
  return impl_->nearest(place, count, reach, &normal);
}

}  // namespace ray
