#pragma once
/// Many ellipsoids, and which of them a ray or a point meets.

#include <raycloud/exec/context.h>
#include <raycloud/spatial/point_tree.h>
#include <raycloud/volume/ellipsoid.h>

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

namespace ray {

/// Ellipsoids in packs of eight that are near each other, under a tree of boxes: eight parts to a box. Each
/// ellipsoid is in one pack, so a ray meets it once, and packs are as fine as the points are dense. Boxes and
/// ellipsoids are first judged in single precision, with room for rounding; what is left is exact.
///
/// Memory: 54 bytes an ellipsoid. Building: O(n log n), about 0.3 µs of one core an ellipsoid. At most
/// 2^32 - 16.
class EllipsoidTree {
 public:
  /// Lays out `count` ellipsoids by the places `place(i)`, which need only be near them.
  EllipsoidTree(const Context& context, std::size_t count,
                const std::function<Eigen::Vector3d(std::size_t)>& place);
  /// One for each point, by its index, at its place; twice as fast, as the points are in order.
  EllipsoidTree(const Context& context, const PointTree& points);

  [[nodiscard]] std::size_t size() const { return slots_.size(); }
  /// Where ellipsoid `i` is kept: neighbours have slots near each other.
  [[nodiscard]] std::uint32_t slot(std::size_t i) const { return slots_[i]; }

  /// Sets ellipsoid `i`. Thread-safe for different ones.
  void set(std::size_t i, const Ellipsoid& ellipsoid);
  /// Called when all are set, before the first search.
  void close(const Context& context);

  /// As it was set: bit for bit, where it is within 100 m of its place.
  [[nodiscard]] Ellipsoid at_slot(std::uint32_t slot) const;

  /// Fills `slots` with those of all ellipsoids that the line between the two points crosses: it meets them
  /// and neither begins nor ends inside. And of a few more that it almost does. In no order that could be
  /// relied on. Thread-safe.
  void near_line(const Eigen::Vector3d& start, const Eigen::Vector3d& end,
                 std::vector<std::uint32_t>& slots) const;
  /// The same, but those that the line surely crosses, and surely leaves less than `beyond` (m) before its
  /// end, come into `late`: of the ends of a surface most are such.
  void near_line(const Eigen::Vector3d& start, const Eigen::Vector3d& end, double beyond,
                 std::vector<std::uint32_t>& slots, std::vector<std::uint32_t>& late) const;
  /// Of exactly those ellipsoids that hold the point. Thread-safe.
  void holding(const Eigen::Vector3d& point, std::vector<std::uint32_t>& slots) const;

 private:
  static constexpr std::size_t kPack = 8;
  static constexpr std::size_t kParts = 8;

  /// Centres are relative to the anchor; shapes are xx, xy, xz, yy, yz, zz. Five lines of a cache.
  struct Pack {
    Eigen::Vector3d anchor = Eigen::Vector3d::Zero();
    std::array<std::array<float, kPack>, 3> centre;
    std::array<std::array<float, kPack>, 6> shape;
    double padding = 0.0;
  };
  /// Of eight packs, or eight boxes, relative to `origin_`.
  struct Boxes {
    std::array<std::array<float, kParts>, 3> min;
    std::array<std::array<float, kParts>, 3> max;
  };
  struct Line;
  template <class Place, class Number>
  void lay_out(const Context& context, const Place& place, const Number& number);
  void meet_pack(std::size_t pack, const Line& line, std::vector<std::uint32_t>& slots,
                 std::vector<std::uint32_t>& late) const;
  void hold_pack(std::size_t pack, const Eigen::Vector3d& point, std::vector<std::uint32_t>& slots) const;

  Eigen::Vector3d origin_ = Eigen::Vector3d::Zero();
  double slack_ = 0.0;         ///< m, by which boxes are larger than what they hold
  Eigen::Vector3d min_, max_;  ///< of everything
  std::vector<std::uint32_t> slots_;
  std::vector<Pack> packs_;
  std::vector<std::array<std::int16_t, 3>> normals_;  ///< by slot
  std::vector<std::vector<Boxes>> levels_;            ///< from that over the packs to the root
};

}  // namespace ray
