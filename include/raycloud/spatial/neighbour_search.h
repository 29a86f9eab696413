#pragma once
/// The nearest neighbours of the points of a tree, exact.

#include <raycloud/spatial/point_tree.h>

#include <memory>
#include <span>

namespace ray {

class Neighbourhood;

struct Neighbour {
  double distance2 = 0.0;  ///< m²
  std::uint32_t place = 0;
};

/// All x with (x - centre)ᵀ shape (x - centre) <= 1: where points are looked for.
struct SearchedBody {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();     ///< m
  Eigen::Matrix3d shape = Eigen::Matrix3d::Identity();  ///< 1/m², symmetric, positive definite
};

/// Places of all points in a body.
struct PlacesInside {
  std::span<const std::uint32_t> surely;
  std::span<const std::uint32_t> perhaps;  ///< for the caller to look at: near its surface, and a few others
};

/// The order of neighbours: by distance, equal ones by the index of the point.
inline auto nearer_first(const PointTree& tree) {
  return [&tree](const Neighbour& a, const Neighbour& b) {
    return a.distance2 != b.distance2 ? a.distance2 < b.distance2 : tree.index(a.place) < tree.index(b.place);
  };
}

/// Searches in a tree, with the memory that they need (about 80 kB); one for each thread. Made for all points
/// one after the other, in the order of the tree: what is around a leaf is gathered once for its points.
class NeighbourSearch {
 public:
  static constexpr std::size_t kMost = 64;  ///< neighbours of one point

  explicit NeighbourSearch(const PointTree& tree);
  ~NeighbourSearch();
  NeighbourSearch(const NeighbourSearch&) = delete;
  NeighbourSearch& operator=(const NeighbourSearch&) = delete;

  /// The `count` nearest other points within `reach` (m, inclusive), ties by index; fewer where there
  /// are fewer. In no order that could be relied on. Valid until the next call. About 0.5 µs for 16.
  /// Precondition: count <= kMost.
  std::span<const Neighbour> nearest(std::size_t place, std::size_t count, double reach);

  /// Only of the points that were seen from the side to which `normal` points: dot(normal, to_sensor) >= 0.
  std::span<const Neighbour> nearest_facing(std::size_t place, std::size_t count, double reach,
                                            const Eigen::Vector3d& normal);

  /// The same, as a neighbourhood, which is faster than filling one with what is found.
  void nearest(std::size_t place, std::size_t count, double reach, Neighbourhood& around);
  void nearest_facing(std::size_t place, std::size_t count, double reach, const Eigen::Vector3d& normal,
                      Neighbourhood& around);

  /// The places of these alone, in any order: a tenth faster.
  std::span<const std::uint32_t> places_facing(std::size_t place, std::size_t count, double reach,
                                               const Eigen::Vector3d& normal);

  /// All points in a body, the one at `place` too. Any body will do; one that lies around the place, no wider
  /// than its neighbours, is fast. Valid until the next call. About 0.1 µs.
  PlacesInside inside(std::size_t place, const SearchedBody& body);

  /// Places [begin, end) that lie together.
  struct Leaf {
    std::size_t begin = 0;
    std::size_t end = 0;
  };
  [[nodiscard]] Leaf leaf_of(std::size_t place);
  /// Who knows how far the places of a leaf will have to look (m) may say so before the first is asked for,
  /// which is faster. Changes no result.
  void look_around(std::size_t place, double reach);

  [[nodiscard]] const PointTree& tree() const { return tree_; }

 private:
  class Impl;
  const PointTree& tree_;
  std::unique_ptr<Impl> impl_;
};

}  // namespace ray
