#include "leaf_surroundings.h"
#include "tree_walk.h"

#include <raycloud/spatial/neighbour_search.h>
#include <raycloud/spatial/neighbourhood.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <optional>
#include <utility>

namespace ray {

class NeighbourSearch::Impl {
 public:
  explicit Impl(const PointTree& tree) : walk_(tree), around_(tree) {}

  /// As a list, or `into` something.
  std::span<const Neighbour> search(std::size_t place, std::size_t count, double reach,
                                    const Eigen::Vector3d* side, Neighbourhood* into = nullptr) {
    assert(count <= kMost && place < walk_.tree().size());
    if (count == 0) {
      if (into != nullptr) into->fill(walk_.tree(), place, std::span<const Neighbour>());
      return {};
    }
    go_to(place);
    const bool is_new = std::exchange(is_new_, false);
    most_asked_ = std::max(most_asked_, count);
    // Who says how far it is, to about what was found last, knows.
    if (is_new && reach < kWide * furthest_found_) gather(kWideOfReach * reach);
    const bool is_guess = is_new && !around_.has(place) && furthest_before_.count > 0 &&
                          gather(kWide * furthest_before_.mean());
    std::optional<LeafSurroundings::Nearest> found;
    double within2 = reach * reach;
    if (around_.has(place)) {
      found = around_.nearest(place, count, reach, side, into);
      if (!found) {
        within2 = std::min(within2, around_.bound2());
        if (widen(std::sqrt(within2))) found = around_.nearest(place, count, reach, side, into);
      }
    }
    const bool is_walk = !found;
    if (is_walk) found = walk(place, count, within2, side, into);
    furthest_found_ = std::sqrt(found->furthest2);
    if (found->size < count) return found->list;
    furthest_.add(count, furthest_found_);
    if (is_walk && (is_guess || !around_.has(place)) &&
        !gather(kWide * furthest_found_ * further_asked(count)))
      gather(kLessWide * furthest_found_);
    return found->list;
  }

  std::span<const std::uint32_t> places_facing(std::size_t place, std::size_t count, double reach,
                                               const Eigen::Vector3d& side) {
    go_to(place);
    if (around_.has(place))
      if (const auto within = around_.within(place, count, reach, side)) return *within;
    places_.clear();
    for (const Neighbour& neighbour : search(place, count, reach, &side))
      places_.push_back(neighbour.place);
    return places_;
  }

  PlacesInside inside(std::size_t place, const SearchedBody& body) {
    go_to(place);
    const Eigen::Vector3d half = half_extent(body.shape);
    if (around_.has(place)) {
      const double furthest = around_.furthest(body.centre, half);
      if (furthest <= around_.reach() || widen(furthest)) return around_.inside(body);
    }
    walk_.in_box(body.centre - half, body.centre + half, in_box_);
    return {{}, in_box_};
  }

  Leaf leaf_of(std::size_t place) {
    go_to(place);
    return {walk_.leaf().first, walk_.leaf().first + walk_.leaf().count};
  }

  void look_around(std::size_t place, double reach) {
    go_to(place);
    for (; !around_.has(place) && tries_ > 0; reach *= kLess)
      gather(reach);
    is_new_ = false;
  }

 private:
  /// How far the most that were asked for are, in a leaf.
  struct Furthest {
    std::size_t asked = 0;
    double sum = 0.0;  // m
    int count = 0;
    void add(std::size_t asked_for, double distance) {
      if (asked_for < asked) return;
      if (asked_for > asked) *this = {asked_for, 0.0, 0};
      sum += distance, ++count;
    }
    [[nodiscard]] double mean() const { return sum / count; }
  };

  LeafSurroundings::Nearest walk(std::size_t place, std::size_t count, double within2,
                                 const Eigen::Vector3d* side, Neighbourhood* into) {
    const std::span<const Neighbour> list = walk_.nearest(place, count, within2, side);
    if (into != nullptr) into->fill(walk_.tree(), place, list);
    double furthest2 = 0.0;
    for (const Neighbour& neighbour : list)
      furthest2 = std::max(furthest2, neighbour.distance2);
    return {list, list.size(), furthest2};
  }

  /// Half the box of a body, m, and a little more, for rounding: by the diagonal of the inverse.
  static Eigen::Vector3d half_extent(const Eigen::Matrix3d& shape) {
    constexpr double kRoom = 1.0 + 1e-5;
    const double xx = shape(0, 0), xy = shape(0, 1), xz = shape(0, 2), yy = shape(1, 1), yz = shape(1, 2),
                 zz = shape(2, 2);
    const double x2 = yy * zz - yz * yz, y2 = xx * zz - xz * xz, z2 = xx * yy - xy * xy;
    const double det = xx * x2 - xy * (xy * zz - yz * xz) + xz * (xy * yz - yy * xz);
    return kRoom * (Eigen::Vector3d(x2, y2, z2) / det).cwiseMax(0.0).cwiseSqrt();
  }

  void go_to(std::size_t place) {
    if (!walk_.go_to(place)) return;
    is_new_ = true;
    around_.forget();
    tries_ = kTries;
    most_asked_before_ = std::exchange(most_asked_, 0);
    furthest_before_ = std::exchange(furthest_, {});
  }

  /// How much further off the most are that were asked for in the leaf before, and will be in this: points on
  /// a surface grow as the square of the distance.
  [[nodiscard]] double further_asked(std::size_t count) const {
    const auto times = static_cast<double>(most_asked_before_) / static_cast<double>(count);
    return std::sqrt(std::max(times, 1.0));
  }

  bool gather(double reach) {
    if (tries_ == 0) return false;
    const bool is_gathered = around_.gather(walk_, reach);
    if (!is_gathered) --tries_;
    return is_gathered;
  }

  /// Gathers what is within the reach, if that is not much more than before.
  bool widen(double reach) {
    const double before = around_.reach();
    if (tries_ == 0 || !(reach < kMuchWider * before)) return false;
    if (gather(kWider * reach)) return true;
    tries_ = 0;
    around_.gather(walk_, before);
    return false;
  }

  // Most points of a leaf have their neighbours within so many times the distance of those of its first, or
  // of the reach of one that knows.
  static constexpr double kWide = 1.4;
  static constexpr double kLessWide = 1.2;                    // where that is too many
  static constexpr double kWideOfReach = 1.3, kWider = 1.05;  // a little more, for the others
  static constexpr double kMuchWider = 2.0;
  static constexpr double kLess = 0.6;
  static constexpr int kTries = 3;  // to gather what may be too much, for a leaf

  TreeWalk walk_;
  LeafSurroundings around_;
  bool is_new_ = false;  // nothing tells yet how far to gather around this leaf
  int tries_ = 0;
  std::size_t most_asked_ = 0, most_asked_before_ = 0;  // of a search, in the leaf and in the one before
  double furthest_found_ = 0.0;                         // of the last search, m
  Furthest furthest_, furthest_before_;
  std::vector<std::uint32_t> in_box_, places_;
};

NeighbourSearch::NeighbourSearch(const PointTree& tree) : tree_(tree), impl_(std::make_unique<Impl>(tree)) {}
NeighbourSearch::~NeighbourSearch() = default;

std::span<const Neighbour> NeighbourSearch::nearest(std::size_t place, std::size_t count, double reach) {
  return impl_->search(place, count, reach, nullptr);
}

std::span<const Neighbour> NeighbourSearch::nearest_facing(std::size_t place, std::size_t count, double reach,
                                                           const Eigen::Vector3d& normal) {
  return impl_->search(place, count, reach, &normal);
}

void NeighbourSearch::nearest(std::size_t place, std::size_t count, double reach, Neighbourhood& around) {
  impl_->search(place, count, reach, nullptr, &around);
}

void NeighbourSearch::nearest_facing(std::size_t place, std::size_t count, double reach,
                                     const Eigen::Vector3d& normal, Neighbourhood& around) {
  impl_->search(place, count, reach, &normal, &around);
}

std::span<const std::uint32_t> NeighbourSearch::places_facing(std::size_t place, std::size_t count,
                                                              double reach, const Eigen::Vector3d& normal) {
  return impl_->places_facing(place, count, reach, normal);
}

PlacesInside NeighbourSearch::inside(std::size_t place, const SearchedBody& body) {
  return impl_->inside(place, body);
}

NeighbourSearch::Leaf NeighbourSearch::leaf_of(std::size_t place) {
  return impl_->leaf_of(place);
}

void NeighbourSearch::look_around(std::size_t place, double reach) {
  impl_->look_around(place, reach);
}

}  // namespace ray
