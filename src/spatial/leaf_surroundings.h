#pragma once
/// All points around a leaf, close together in memory, for the searches of its points.

#include "tree_walk.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

namespace ray {

/// Coordinates are relative to the middle of the leaf, in single precision: that tells nearly always which
/// points are the nearest, and where it does not, those in doubt are compared in double.
class LeafSurroundings {
 public:
  explicit LeafSurroundings(const PointTree& tree) : tree_(tree) {}

  void forget() {
    leaf_.count = 0;
    reach_ = 0.0;
  }
  [[nodiscard]] bool has(std::size_t place) const { return place - leaf_.first < leaf_.count; }

  /// The points within `reach` (m) of the box of the leaf at which `walk` is. False, and forgotten, if there
  /// are too many, or too far apart for single precision.
  bool gather(const TreeWalk& walk, double reach);
  /// What was gathered is all within this distance of the leaf, m; 0 after forget.
  [[nodiscard]] double reach() const { return reach_; }

  /// The nearest, as NeighbourSearch has it; nothing if they might lie outside of what was gathered.
  /// Precondition: has(place).
  std::optional<std::span<const Neighbour>> nearest(std::size_t place, std::size_t count, double reach,
                                                    const Eigen::Vector3d* side);
  /// After a search that came to nothing: no point further than that (m², squared) is among the nearest.
  [[nodiscard]] double bound2() const { return bound2_; }

 private:
  static constexpr std::size_t kRoom = 1024;  // a multiple of 32
  static constexpr std::size_t kLeaf = PointTree::kLeafPoints;
  using Floats = std::array<float, kRoom>;

  bool gather_leaf(const TreeWalk::Leaf& leaf, float within2);
  void measure(std::size_t self);
  [[nodiscard]] float bound_by_others(std::size_t count) const;
  void collect(float within, const Eigen::Vector3d* side);
  void drop_further(std::size_t count, float within);
  void find_bound(std::size_t count, const Eigen::Vector3d* side);
  [[nodiscard]] std::size_t count_within(float distance2) const;
  [[nodiscard]] float distance2_of_nearest(std::size_t count, float within2);
  [[nodiscard]] std::span<const Neighbour> exact(std::size_t place, std::size_t count, double reach2);

  const PointTree& tree_;
  TreeWalk::Leaf leaf_;
  std::array<double, 3> middle_{};
  std::array<float, 3> half_{};  // sides of the box
  double reach_ = 0.0;
  float slack_ = 0.0F;  // by which a distance may be wrong
  // What was gathered, the points of the leaf first.
  std::size_t size_ = 0;
  alignas(32) Floats x_{}, y_{}, z_{};
  std::array<std::uint32_t, kRoom> place_{};
  // Of the points of the leaf for which all `solved_count_` nearest were found: how far those are.
  std::size_t solved_count_ = 0;
  alignas(32) std::array<float, kLeaf> solved_{};
  double bound2_ = 0.0;
  // Of the search under way.
  alignas(32) Floats distance2_{};
  std::size_t found_count_ = 0;
  alignas(32) std::array<float, kRoom + 8> found2_{};
  std::array<std::uint32_t, kRoom> found_place_{};
  std::array<Neighbour, kRoom> found_{};
};

}  // namespace ray
