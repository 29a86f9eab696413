#pragma once
/// The points near each point of a cloud: exact, in the order that makes it fast.

#include <raycloud/exec/context.h>
#include <raycloud/spatial/seen_point.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace ray {

/// A bounding box tree over points that are brought into the order of its leaves: who goes through the places
/// in order finds nearly everything it needs in the cache, which is worth a factor of two to four.
///
/// Distances are those of the coordinates as doubles, and equal ones are told apart by the index of the
/// point, so that the neighbours of a point do not depend on how the tree was built, nor on points out of
/// reach.
///
/// Building costs O(n log n), about 0.2 µs a point and thread. Memory: 40 bytes a point. At most 2^32 - 1
/// points.
class PointTree {
 public:
  PointTree(const Context& context, std::span<const SeenPoint> points);

  [[nodiscard]] std::size_t size() const { return index_.size(); }
  /// By place: the position in the order of the tree.
  [[nodiscard]] Eigen::Vector3d point(std::size_t place) const { return {x_[place], y_[place], z_[place]}; }
  [[nodiscard]] const PackedDirection& to_sensor(std::size_t place) const { return to_sensor_[place]; }
  /// The index that the point had in `points`.
  [[nodiscard]] std::uint32_t index(std::size_t place) const { return index_[place]; }

 private:
  friend class NeighbourSearch;

  static constexpr double kInfinity = std::numeric_limits<double>::infinity();
  static constexpr std::size_t kLeafPoints = 32;  // most

  /// Two nodes that are the parts of one: number 2p and 2p + 1 of pair p. The root is number 1; the other of
  /// its pair is empty. Boxes lie so that both are met at once.
  struct Pair {
    std::array<std::array<double, 2>, 3> min{
        {{kInfinity, kInfinity}, {kInfinity, kInfinity}, {kInfinity, kInfinity}}};
    std::array<std::array<double, 2>, 3> max{
        {{-kInfinity, -kInfinity}, {-kInfinity, -kInfinity}, {-kInfinity, -kInfinity}}};
    std::array<std::uint32_t, 2> first{};  ///< place of the first point
    std::array<std::uint32_t, 2> count{};
    std::array<std::uint32_t, 2> parts{};  ///< a pair, 0 for a leaf
    std::array<std::uint32_t, 2> least_index{0xffffffff, 0xffffffff};
  };
  class Builder;

  std::vector<double> x_, y_, z_;
  std::vector<PackedDirection> to_sensor_;
  std::vector<std::uint32_t> index_;
  std::vector<Pair> pairs_;
};

struct Neighbour {
  double distance2 = 0.0;  ///< m²
  std::uint32_t place = 0;
};

/// Searches in a tree, with the memory that they need; one for each thread. Points at places that are asked
/// for one after the other are found fastest in the order of the tree.
class NeighbourSearch {
 public:
  static constexpr std::size_t kMost = 64;  ///< neighbours of one point

  explicit NeighbourSearch(const PointTree& tree) : tree_(tree) {}

  /// The `count` nearest other points within `reach` (m, inclusive), ties by index; fewer where there
  /// are fewer. In no order that could be relied on. Valid until the next call. About 1 µs for 16.
  /// Precondition: count <= kMost.
  std::span<const Neighbour> nearest(std::size_t place, std::size_t count, double reach);

  /// Only of the points that were seen from the side to which `normal` points: dot(normal, to_sensor) >= 0.
  std::span<const Neighbour> nearest_facing(std::size_t place, std::size_t count, double reach,
                                            const Eigen::Vector3d& normal);

  [[nodiscard]] const PointTree& tree() const { return tree_; }

 private:
  /// Points [first, first + count), seen from outside.
  struct Leaf {
    std::uint32_t first = 0;
    std::uint32_t count = 0;
  };
  /// What lies beside the way from the root to the leaf of the last place.
  struct Beside {
    std::uint32_t node = 0;
    double from_leaf = 0.0;  ///< squared distance of the boxes
  };
  struct Open {
    std::uint32_t node;
    double distance2;
  };
  void go_to_leaf(std::size_t place);
  template <class Accept>
  std::span<const Neighbour> search(std::size_t place, std::size_t count, double reach, double known,
                                    const Accept& accept);
  [[nodiscard]] std::array<double, 2> distances(const PointTree::Pair& pair) const;
  [[nodiscard]] std::size_t count_within(double distance2);
  void keep_nearest();
  void sort_nearest();
  [[nodiscard]] std::uint32_t near_points(Leaf leaf, double* distance2) const;
  template <class Accept>
  void scan(Leaf leaf, const Accept& accept);

  const PointTree& tree_;
  Leaf leaf_;
  std::vector<Beside> beside_;
  std::array<Open, 96> open_{};  ///< nodes still to be looked at; a tree has less than 64 levels
  std::size_t last_count_ = 0;   ///< of a search for all that found as many as it should; else 0
  double last_furthest2_ = 0.0;
  // Of the search under way.
  std::uint32_t self_ = 0;
  std::size_t most_ = 0;
  std::size_t count_ = 0;
  double bound_ = 0.0;  ///< squared; of equal ones, indices from bound_index_ on are out
  std::uint32_t bound_index_ = 0;
  std::array<double, 3> at_{};
  static constexpr std::size_t kRoom = 2 * kMost + 2 * PointTree::kLeafPoints;
  std::array<double, kRoom + 1> distance2_{};
  std::array<std::uint32_t, kRoom> place_{};
  std::array<Neighbour, kMost> found_{};
};

}  // namespace ray
