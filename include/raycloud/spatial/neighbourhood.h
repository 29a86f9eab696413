#pragma once
/// The neighbours of one point, side by side in memory, to choose some of them.

#include <raycloud/spatial/neighbour_search.h>

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace ray {

/// A point and its neighbours; of these, sets as bits of a word. 3 kB. Not thread-safe while it is filled.
class Neighbourhood {
 public:
  /// Bit i: neighbour i is one of them.
  using Some = std::uint64_t;
  static constexpr std::size_t kMost = NeighbourSearch::kMost;
  static_assert(kMost <= 64);

  /// The point at `place`, and these. Precondition: at most kMost.
  void fill(const PointTree& tree, std::size_t place, std::span<const Neighbour> neighbours);
  /// The same, for who knows the places alone. 0.1 µs.
  void fill(const PointTree& tree, std::size_t place, std::span<const std::uint32_t> places);

  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] std::size_t place() const { return place_; }
  [[nodiscard]] Some all() const { return size_ == 0 ? 0 : ~Some{0} >> (64 - size_); }
  [[nodiscard]] Neighbour neighbour(std::size_t i) const { return {distance2_[i], places_[i]}; }

  /// The nearest `most` of some, equal distances told apart by the indices of the points. 30 ns.
  [[nodiscard]] Some nearest(Some some, std::size_t most) const;
  /// Those whose packed direction to the sensor has at least this product with `side`: with 0, those that
  /// were seen from there, as is_seen_from has it. 10 ns.
  [[nodiscard]] Some seen_from(const Eigen::Vector3d& side, double at_least = 0.0) const;
  /// The squared distance of the furthest, m²; 0 if there are none.
  [[nodiscard]] double furthest2() const { return furthest2_; }

  /// How some lie around the point: offsets from it as whole numbers of `1 / scale`, at most 2^22 of them. So
  /// sums of their products are exact, and do not depend on the order of the neighbours.
  struct Moments {
    double furthest2 = 0.0;            ///< m²
    double scale = 0.0;                ///< 1/m; 0 if all are where the point is
    std::array<double, 3> sum{};       ///< x, y, z
    std::array<double, 6> products{};  ///< xx, xy, xz, yy, yz, zz
  };
  [[nodiscard]] Moments moments(Some some) const;

 private:
  struct Kernels;

  void start(const PointTree& tree, std::size_t place, std::size_t size);

  static constexpr std::size_t kLanes = 8;
  /// Behind the last neighbour there is at least one that is not there, to whole groups of lanes: the point
  /// itself, as it were.
  template <class T>
  using Column = std::array<T, kMost + kLanes>;

  const PointTree* tree_ = nullptr;
  std::size_t place_ = 0;
  std::size_t size_ = 0;
  double furthest2_ = 0.0;
  alignas(64) Column<double> distance2_;  ///< m²; 0 where there is nothing
  alignas(64) Column<float> rounded2_;    ///< of these
  alignas(64) Column<double> x_, y_, z_;  ///< m, from the point; 0 where there is nothing
  alignas(64) Column<float> to_sensor_x_, to_sensor_y_, to_sensor_z_;
  Column<std::uint32_t> places_;
};

}  // namespace ray
