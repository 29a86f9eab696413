#include "plane_sums.h"

#include <raycloud/core/lanes.h>

#include <array>
#include <bit>
#include <cstring>

namespace ray {
namespace {

constexpr float kParts = 0x1p20F;                          // of a unit, or its square
constexpr float kLeastAlike = 0.3F;                        // cosine between normals of one surface
constexpr float kMostHeight = 1.0F, kMostSpread2 = 16.0F;  // units and m²/unit²: sums have that much room

/// So many floats, or whole numbers, at once.
template <int kCount>
struct Several {
  using Floats [[gnu::vector_size(kCount * sizeof(float)), gnu::may_alias]] = float;
  using Wholes [[gnu::vector_size(kCount * sizeof(float))]] = std::int32_t;
};

/// All values are so small that no sum overflows: lengths below 5 units, slopes below 4, so what is added is
/// less than 32 parts, by 64 points at most.
template <int kLanes>
[[gnu::always_inline]] inline void add_lanes(const SeenPlanes& planes, const PlaneAxes& axes,
                                             SumsOf<typename Several<kLanes>::Wholes>& sums) {
  using Floats = typename Several<kLanes>::Floats;
  using Wholes = typename Several<kLanes>::Wholes;
  const float nx = axes.n.x(), ny = axes.n.y(), nz = axes.n.z();
  const float ux = axes.u.x(), uy = axes.u.y(), uz = axes.u.z();
  const float vx = axes.v.x(), vy = axes.v.y(), vz = axes.v.z();
  const float per_unit = planes.per_unit, per_unit2 = per_unit * per_unit;
  const Floats least = Floats{} + kLeastAlike, most_height = Floats{} + kMostHeight,
               most_spread2 = Floats{} + kMostSpread2;
  for (std::size_t i = 0; i < planes.size; i += kLanes) {
    const auto& x = reinterpret_cast<const Floats&>(planes.normal_x[i]);
    const auto& y = reinterpret_cast<const Floats&>(planes.normal_y[i]);
    const auto& z = reinterpret_cast<const Floats&>(planes.normal_z[i]);
    const Floats height = reinterpret_cast<const Floats&>(planes.height[i]) * per_unit;
    const Floats offset_x = reinterpret_cast<const Floats&>(planes.offset_x[i]) * per_unit;
    const Floats offset_y = reinterpret_cast<const Floats&>(planes.offset_y[i]) * per_unit;
    const Floats offset_z = reinterpret_cast<const Floats&>(planes.offset_z[i]) * per_unit;
    const Floats spread2 = reinterpret_cast<const Floats&>(planes.spread2[i]) * per_unit2;
    const Floats no_lower = height < -most_height ? -most_height : height;
    const Floats no_higher = no_lower > most_height ? most_height : no_lower;
    const Floats no_wider = spread2 > most_spread2 ? most_spread2 : spread2;
    const Floats cosine = x * nx + y * ny + z * nz;
    const Floats alike = cosine > least ? cosine : least;
    const Floats alike2 = alike * alike, alike4 = alike2 * alike2;
    const Floats full = alike4 * alike4 * kParts;
    const Floats weight = cosine > least ? full : Floats{};
    const Floats per_alike = 1.0F / alike;
    const Floats at_x = offset_x + no_higher * x, at_y = offset_y + no_higher * y,
                 at_z = offset_z + no_higher * z;
    const Floats at_n = at_x * nx + at_y * ny + at_z * nz;
    const Floats at_u = at_x * ux + at_y * uy + at_z * uz, at_v = at_x * vx + at_y * vy + at_z * vz;
    const Floats su = -(x * ux + y * uy + z * uz) * per_alike, sv = -(x * vx + y * vy + z * vz) * per_alike;
    const Floats wu = weight * at_u, wv = weight * at_v, wsu = weight * su, wsv = weight * sv;
    sums.w += __builtin_convertvector(weight, Wholes);
    sums.h += __builtin_convertvector(weight * at_n, Wholes);
    sums.spread2 += __builtin_convertvector(weight * no_wider, Wholes);
    sums.u += __builtin_convertvector(wu, Wholes);
    sums.v += __builtin_convertvector(wv, Wholes);
    sums.slope_u += __builtin_convertvector(wsu, Wholes);
    sums.slope_v += __builtin_convertvector(wsv, Wholes);
    sums.uu += __builtin_convertvector(wu * at_u, Wholes);
    sums.uv += __builtin_convertvector(wu * at_v, Wholes);
    sums.vv += __builtin_convertvector(wv * at_v, Wholes);
    sums.u_slope_u += __builtin_convertvector(wu * su, Wholes);
    sums.v_slope_v += __builtin_convertvector(wv * sv, Wholes);
    sums.u_slope_v += __builtin_convertvector(wu * sv + wv * su, Wholes);
    sums.slope2 += __builtin_convertvector(wsu * su + wsv * sv, Wholes);
  }
}

/// Over the lanes.
template <class Wholes>
[[gnu::always_inline]] inline void sum_up(const SumsOf<Wholes>& sums, PlaneSums& total) {
  for (std::size_t i = 0; i < sizeof(Wholes) / sizeof(std::int32_t); ++i) {
    total.w += sums.w[i], total.h += sums.h[i], total.spread2 += sums.spread2[i];
    total.u += sums.u[i], total.v += sums.v[i];
    total.slope_u += sums.slope_u[i], total.slope_v += sums.slope_v[i];
    total.uu += sums.uu[i], total.uv += sums.uv[i], total.vv += sums.vv[i];
    total.u_slope_u += sums.u_slope_u[i], total.v_slope_v += sums.v_slope_v[i];
    total.u_slope_v += sums.u_slope_v[i], total.slope2 += sums.slope2[i];
  }
}

/// The heights of surfaces at their points, in units, of several at once.
template <class Value>
[[gnu::always_inline]] inline void find_heights(const SumsOf<Value>& sums, Value& height) {
  // The planes share most of their points, and so a curvature is less sure than it looks.
  constexpr double kCaution = 16.0;
  const Value zero{};
  const Value per_weight = 1.0 / sums.w;
  const Value u = sums.u * per_weight, v = sums.v * per_weight;
  const Value su = sums.slope_u * per_weight, sv = sums.slope_v * per_weight;
  const Value flat = sums.h * per_weight - su * u - sv * v;
  // The rest is about the means.
  const Value uu = sums.uu * per_weight - u * u, uv = sums.uv * per_weight - u * v,
              vv = sums.vv * per_weight - v * v;
  const Value u_su = sums.u_slope_u * per_weight - u * su, v_sv = sums.v_slope_v * per_weight - v * sv;
  const Value u_sv = sums.u_slope_v * per_weight - u * sv - v * su;
  const Value slope2 = sums.slope2 * per_weight - su * su - sv * sv;
  const Value extent2 = uu + vv, area = uu * vv - uv * uv;
  // The slopes of a curved surface, by least squares: su = a u + b v, sv = b u + c v.
  const Value b = (u_sv * uu * vv - uv * (vv * u_su + uu * v_sv)) / (extent2 * area);
  const Value a = (u_su - uv * b) / uu, c = (v_sv - uv * b) / vv;
  const Value explained_less = slope2 - a * u_su - b * u_sv - c * v_sv;
  const Value unexplained = explained_less > 0.0 ? explained_less : zero;
  const Value error2 = kCaution * unexplained / (extent2 * sums.w / static_cast<double>(kParts));
  const Value curvature2 = 0.25 * (a + c) * (a + c);
  const Value sure = curvature2 * curvature2, unsure = error2 * error2;
  const Value share = sure / (sure + unsure), trust = sure > 0.0 ? share : zero;
  // What curvature does to the mean of the heights: across each plane, and across the planes.
  const Value bend = 0.5 * (0.5 * (sums.spread2 * per_weight) * (a + c) + a * uu + 2.0 * b * uv + c * vv);
  const Value curved = flat - trust * bend;
  const Value either = area > 1e-6 * extent2 * extent2 ? curved : flat;
  height = sums.w > 0.0 ? either : zero;
}

/// Of point i in lane i.
using Heights [[gnu::vector_size(kHeights * sizeof(double))]] = double;
using Columns = SumsOf<Heights>;
constexpr std::size_t kSums = sizeof(PlaneSums) / sizeof(std::int32_t);

void add_plain(const SeenPlanes& planes, const PlaneAxes& axes, PlaneSums& sums) {
  SumsOf<Several<4>::Wholes> lanes;
  add_lanes<4>(planes, axes, lanes);
  sum_up(lanes, sums);
}
#ifdef RAY_HAS_LANES
RAY_AVX2 void add_avx2(const SeenPlanes& planes, const PlaneAxes& axes, PlaneSums& sums) {
  SumsOf<Several<8>::Wholes> lanes;
  add_lanes<8>(planes, axes, lanes);
  sum_up(lanes, sums);
}
/// As sum_up: of two sums each pair of lanes, of four each quarter, and so on.
RAY_AVX512 void sum_up_sixteen(const SumsOf<Several<16>::Wholes>& sums, PlaneSums& total) {
  using Wholes = Several<16>::Wholes;
  std::array<Wholes, 16> all{};
  static_assert(sizeof(sums) == kSums * sizeof(Wholes) && kSums <= 16);
  std::memcpy(all.data(), &sums, sizeof(sums));
  for (std::size_t i = 0; i < 8; ++i)
    all[i] = __builtin_shufflevector(all[2 * i], all[2 * i + 1], 0, 16, 1, 17, 4, 20, 5, 21, 8, 24, 9, 25, 12,
                                     28, 13, 29) +
             __builtin_shufflevector(all[2 * i], all[2 * i + 1], 2, 18, 3, 19, 6, 22, 7, 23, 10, 26, 11, 27,
                                     14, 30, 15, 31);
  for (std::size_t i = 0; i < 4; ++i)
    all[i] = __builtin_shufflevector(all[2 * i], all[2 * i + 1], 0, 1, 16, 17, 4, 5, 20, 21, 8, 9, 24, 25, 12,
                                     13, 28, 29) +
             __builtin_shufflevector(all[2 * i], all[2 * i + 1], 2, 3, 18, 19, 6, 7, 22, 23, 10, 11, 26, 27,
                                     14, 15, 30, 31);
  for (std::size_t i = 0; i < 2; ++i)
    all[i] = __builtin_shufflevector(all[2 * i], all[2 * i + 1], 0, 1, 2, 3, 8, 9, 10, 11, 16, 17, 18, 19, 24,
                                     25, 26, 27) +
             __builtin_shufflevector(all[2 * i], all[2 * i + 1], 4, 5, 6, 7, 12, 13, 14, 15, 20, 21, 22, 23,
                                     28, 29, 30, 31);
  const Wholes sum =
      __builtin_shufflevector(all[0], all[1], 0, 1, 2, 3, 8, 9, 10, 11, 16, 17, 18, 19, 24, 25, 26, 27) +
      __builtin_shufflevector(all[0], all[1], 4, 5, 6, 7, 12, 13, 14, 15, 20, 21, 22, 23, 28, 29, 30, 31);
  std::memcpy(static_cast<void*>(&total), &sum, sizeof(total));
}
RAY_AVX512 void add_avx512(const SeenPlanes& planes, const PlaneAxes& axes, PlaneSums& sums) {
  SumsOf<Several<16>::Wholes> lanes;
  add_lanes<16>(planes, axes, lanes);
  sum_up_sixteen(lanes, sums);
}
#endif
void heights_plain(const Columns& sums, Heights& heights) {
  find_heights(sums, heights);
}
#ifdef RAY_HAS_LANES
RAY_AVX2 void heights_avx2(const Columns& sums, Heights& heights) {
  find_heights(sums, heights);
}
RAY_AVX512 void heights_avx512(const Columns& sums, Heights& heights) {
  find_heights(sums, heights);
}
#endif
void heights_fast(const Columns& sums, Heights& heights) {
#ifdef RAY_HAS_LANES
  if (lanes_in_use == LaneSet::kAvx512) return heights_avx512(sums, heights);
  if (lanes_in_use == LaneSet::kAvx2) return heights_avx2(sums, heights);
#endif
  heights_plain(sums, heights);
}

}  // namespace

void add_planes(const SeenPlanes& planes, const PlaneAxes& axes, PlaneSums& sums) {
#ifdef RAY_HAS_LANES
  if (lanes_in_use == LaneSet::kAvx512) return add_avx512(planes, axes, sums);
  if (lanes_in_use == LaneSet::kAvx2) return add_avx2(planes, axes, sums);
#endif
  add_plain(planes, axes, sums);
}

std::array<double, kHeights> heights_by(const std::array<PlaneSums, kHeights>& sums) {
  std::array<Heights, kSums> columns;
  for (std::size_t lane = 0; lane < kHeights; ++lane) {
    const auto values = std::bit_cast<std::array<std::int32_t, kSums>>(sums[lane]);
    for (std::size_t i = 0; i < kSums; ++i)
      columns[i][lane] = values[i];
  }
  Columns of_lanes;
  static_assert(sizeof(of_lanes) == sizeof(columns));
  std::memcpy(static_cast<void*>(&of_lanes), columns.data(), sizeof(of_lanes));
  Heights heights;
  heights_fast(of_lanes, heights);
  std::array<double, kHeights> result;
  std::memcpy(result.data(), &heights, sizeof(result));
  return result;
}

}  // namespace ray
