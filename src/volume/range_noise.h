#pragma once
/// The noise of the ranges of a cloud.

#include <raycloud/exec/context.h>
#include <raycloud/exec/spilled_records.h>
#include <raycloud/spatial/point_tree.h>
#include <raycloud/spatial/surfel.h>

#include <cstdint>
#include <span>
#include <vector>

namespace ray {

/// Both sides of a thin wall together: what is between them is as solid, and it takes a third of the time.
[[nodiscard]] inline SurfelRule ellipsoid_rule(double reach) {
  return {.neighbours = 16, .reach = reach, .by_side = false};
}

/// The median scatter of the points about flat surfaces, from a sample of the points that depends on their
/// places alone.
class RangeNoise {
 public:
  /// Of `bounded` points in all; neighbours are looked for up to `reach`, m.
  RangeNoise(std::uint64_t bounded, double reach);
  /// All points of the cloud.
  void add(const Context& context, const PointTree& points);
  /// Those of a block. Of the others, only those near the sampled ones are put in order.
  void add(const Context& context, const Block<SeenPoint>& block);
  /// m, a standard deviation: 2 mm to 10 cm, and 1.5 cm where nothing is flat.
  [[nodiscard]] double value() const;

 private:
  [[nodiscard]] bool is_in_sample(const Eigen::Vector3d& point) const;
  void add(const Surfel& surfel);
  /// Returns those of `asked` that have too few neighbours so near, unless none is looked for further away.
  std::vector<std::uint32_t> add_within(const Context& context, std::span<const SeenPoint> points,
                                        std::span<const std::uint32_t> asked, double reach);

  std::uint64_t stride_;
  double reach_;
  std::vector<double> scatter_;
};

}  // namespace ray
