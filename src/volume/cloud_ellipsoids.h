#pragma once
/// The ellipsoids around the ends of a cloud.

#include "read_ends.h"

#include <raycloud/core/ray_stream.h>
#include <raycloud/exec/context.h>
#include <raycloud/spatial/point_tree.h>
#include <raycloud/spatial/surfel.h>
#include <raycloud/volume/ellipsoid_tree.h>

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace ray {

/// Both sides of a thin wall together: what is between them is as solid, and it takes a third of the time.
[[nodiscard]] inline SurfelRule ellipsoid_rule(double reach) {
  return {.neighbours = 16, .reach = reach, .by_side = false};
}

/// The ellipsoid around a point.
[[nodiscard]] Ellipsoid ellipsoid_at(NeighbourSearch& search, const PointTree& points, std::size_t place,
                                     double reach, double range_noise);

/// The noise of the ranges: the median scatter of the points about flat surfaces, from a sample of the points
/// that depends on their places alone.
class RangeNoise {
 public:
  /// Of `bounded` points in all; neighbours are looked for up to `reach`, m.
  RangeNoise(std::uint64_t bounded, double reach) : bounded_(bounded), reach_(reach) {}
  /// Those points that are `own`, by index, or all, if that is empty. The others are neighbours only.
  void add(const Context& context, const PointTree& points, std::span<const std::uint8_t> own);
  /// m, a standard deviation: 2 mm to 10 cm, and 1.5 cm where nothing is flat.
  [[nodiscard]] double value() const;

 private:
  std::uint64_t bounded_;
  double reach_;
  std::vector<double> scatter_;
};

/// One ellipsoid for each of some points.
class EllipsoidMaker {
 public:
  EllipsoidMaker(const Context& context, std::vector<SeenPoint>&& points);
  [[nodiscard]] const PointTree& points() const { return points_; }
  /// Closed; called once. 95 bytes a point, with this. About 2 µs of one core a point.
  [[nodiscard]] std::unique_ptr<EllipsoidTree> make(const Context& context, double reach, double range_noise);

 private:
  std::unique_ptr<EllipsoidTree> ellipsoids_;
  PointTree points_;
};

struct CloudEllipsoids {
  std::unique_ptr<EllipsoidTree> tree;  ///< one for each bounded ray, closed
  double range_noise = 0.0;             ///< m, standard deviation of the ends from flat surfaces
};
/// Those of a whole cloud. Reads `source` once and rewinds it.
[[nodiscard]] CloudEllipsoids cloud_ellipsoids(const Context& context, RaySource& source);
/// Those of a cloud that was read, with its points.
[[nodiscard]] CloudEllipsoids cloud_ellipsoids(const Context& context, ReadEnds&& ends);

}  // namespace ray
