#pragma once
/// All points around a leaf, close together in memory, for the searches of its points.

#include "point_sieve.h"
#include "tree_walk.h"

#include <raycloud/spatial/neighbourhood.h>

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

  struct Nearest {
    std::span<const Neighbour> list;  ///< empty if they were put elsewhere
    std::size_t size = 0;
    double furthest2 = 0.0;  ///< m²
  };
  /// The nearest, as NeighbourSearch has it, `into` something or as a list; nothing if they might lie outside
  /// of what was gathered. Precondition: has(place).
  std::optional<Nearest> nearest(std::size_t place, std::size_t count, double reach,
                                 const Eigen::Vector3d* side, Neighbourhood* into);
  /// The places of the nearest that are within reach, and of the side, in any order; nothing if they might
  /// lie outside of what was gathered. Precondition: has(place).
  std::optional<std::span<const std::uint32_t>> within(std::size_t place, std::size_t most, double reach,
                                                       const Eigen::Vector3d& side);
  /// How far a box (m) reaches from that of the leaf at most. Precondition: something is gathered.
  [[nodiscard]] double furthest(const Eigen::Vector3d& middle, const Eigen::Vector3d& half) const;
  /// As NeighbourSearch has it. Precondition: the box of the body is within reach().
  [[nodiscard]] PlacesInside inside(const SearchedBody& body);
  /// After a search that came to nothing: no point further than that (m², squared) is among the nearest.
  [[nodiscard]] double bound2() const { return bound2_; }

 private:
  static constexpr std::size_t kLeaf = PointTree::kLeafPoints;
  static_assert(kLeaf % kSieveLanes == 0);

  bool gather_leaf(const TreeWalk::Leaf& leaf, const SieveBox& box);
  void gather_directions();
  [[nodiscard]] std::array<float, 3> middle_of(std::size_t self) const {
    return {points_.x[self], points_.y[self], points_.z[self]};
  }
  [[nodiscard]] float bound_by_others(std::size_t self, std::size_t count) const;
  void collect(std::size_t place, float within, const Eigen::Vector3d* side);
  void drop_further(std::size_t count, float within);
  void find_bound(std::size_t place, std::size_t count, const Eigen::Vector3d* side);
  [[nodiscard]] float distance2_of_nearest(std::size_t count, float within2) const;
  [[nodiscard]] Nearest exact(std::size_t place, std::size_t count, double reach2, Neighbourhood* into);

  const PointTree& tree_;
  TreeWalk::Leaf leaf_;
  double reach_ = 0.0;
  SieveBox box_;            // of the leaf
  float slack_ = 0.0F;      // by which a distance may be wrong
  SievePoints points_;      // what was gathered, the points of the leaf first
  bool has_sides_ = false;  // with the directions to their sensors
  // Of the points of the leaf for which all `solved_count_` nearest were found: how far those are.
  std::size_t solved_count_ = 0;
  alignas(32) std::array<float, kLeaf> solved_{};
  double bound2_ = 0.0;
  // Of the search under way.
  SievedPoints near_;
  std::array<Neighbour, kSieveRoom> found_{};
  std::array<std::uint32_t, kSieveRoom> inside_{};  // those surely there in front, those perhaps behind
};

}  // namespace ray
