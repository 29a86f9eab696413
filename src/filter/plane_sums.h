#pragma once
/// The loops of SurfaceFit, by as many numbers at once as the processor can; the same bits on all.

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace ray {

/// Planes in columns, seen from a point. Behind the last, as many as fill up the lanes have no normal.
struct SeenPlanes {
  static constexpr std::size_t kLanes = 16, kMost = 64;
  using Column = std::array<float, kMost>;
  std::size_t size = 0;
  alignas(64) Column normal_x{}, normal_y{}, normal_z{};
  alignas(64) Column offset_x{}, offset_y{}, offset_z{};
  alignas(64) Column height{}, spread2{};
  float per_unit = 1.0F;  ///< that many units of length are a metre
};

/// Weighted sums over the planes, seen from the point: u and v across its normal, h along it. In whole parts
/// for one point, so that they are exact, and the same in any order.
template <class Value>
struct SumsOf {
  Value w{}, h{}, spread2{}, u{}, v{}, slope_u{}, slope_v{}, uu{}, uv{}, vv{}, u_slope_u{}, v_slope_v{},
      u_slope_v{}, slope2{};
};
using PlaneSums = SumsOf<std::int32_t>;

/// Three directions that are square to each other, of unit length.
struct PlaneAxes {
  Eigen::Vector3f n, u, v;
};

void add_planes(const SeenPlanes& planes, const PlaneAxes& axes, PlaneSums& sums);

constexpr std::size_t kHeights = 8;
/// The height of the surface at each of that many points, in its units; where there are no planes, 0.
[[nodiscard]] std::array<double, kHeights> heights_by(const std::array<PlaneSums, kHeights>& sums);

}  // namespace ray
