#pragma once
/// The neighbours of a single point, by way of the nodes of the tree.

#include <raycloud/spatial/neighbour_search.h>

#include <array>
#include <vector>

namespace ray {

/// Whether a point was seen from the side to which `side` points; null: any will do.
inline bool is_of_side(const Eigen::Vector3d* side, const PackedDirection& d) {
  return side == nullptr || side->x() * d[0] + side->y() * d[1] + side->z() * d[2] >= 0.0;
}

class TreeWalk {
 public:
  /// Points [first, first + count).
  struct Leaf {
    std::uint32_t first = 0;
    std::uint32_t count = 0;
    std::uint32_t node = 0;
  };
  /// What lies beside the way from the root to a leaf.
  struct Beside {
    std::uint32_t node = 0;
    double from_leaf = 0.0;  ///< squared distance of the boxes
  };

  explicit TreeWalk(const PointTree& tree) : tree_(tree) {}

  [[nodiscard]] const PointTree& tree() const { return tree_; }
  /// To the leaf of the place. True if it is another one than before.
  bool go_to(std::size_t place);
  [[nodiscard]] const Leaf& leaf() const { return leaf_; }
  [[nodiscard]] const std::vector<Beside>& beside() const { return beside_; }  ///< from the root down

  /// The nearest within the squared distance, as NeighbourSearch has it; the place must be in the leaf.
  std::span<const Neighbour> nearest(std::size_t place, std::size_t count, double within2,
                                     const Eigen::Vector3d* side);

  /// All places in the box.
  void in_box(const Eigen::Vector3d& min, const Eigen::Vector3d& max, std::vector<std::uint32_t>& places);

 private:
  struct Open {
    std::uint32_t node;
    double distance2;
  };
  [[nodiscard]] std::array<double, 2> distances(const PointTree::Pair& pair) const;
  [[nodiscard]] std::size_t count_within(double distance2);
  void keep_nearest();
  void sort_nearest();
  [[nodiscard]] std::uint32_t near_points(const Leaf& leaf, double* distance2) const;
  void add_near(const Leaf& leaf, const Eigen::Vector3d* side);
  void scan(const Leaf& leaf, const Eigen::Vector3d* side);
  void drop_further(double distance2);
  struct Avx512;

  const PointTree& tree_;
  Leaf leaf_;
  std::vector<Beside> beside_;
  std::array<Open, 96> open_{};  ///< nodes still to be looked at; a tree has less than 64 levels
  // Of the search under way.
  std::uint32_t self_ = 0;
  std::size_t most_ = 0;
  std::size_t count_ = 0;
  double bound_ = 0.0;  ///< squared; of equal ones, indices from bound_index_ on are out
  std::uint32_t bound_index_ = 0;
  std::array<double, 3> at_{};
  static constexpr std::size_t kRoom = 2 * NeighbourSearch::kMost + 2 * PointTree::kLeafPoints;
  static constexpr std::size_t kLanes = 8;
  std::array<double, kRoom + kLanes> distance2_{};
  std::array<std::uint32_t, kRoom + kLanes> place_{};
  std::array<Neighbour, NeighbourSearch::kMost> found_{};
};

}  // namespace ray
