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
  friend class TreeWalk;
  friend class LeafSurroundings;
  friend class Neighbourhood;
  friend class NearestPoint;

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

}  // namespace ray
