#include "surface_fit.h"

#include <algorithm>
#include <bit>
#include <cstdint>

namespace ray {
namespace {

/// Sums of what single points add, in whole parts: exact, and so the same in any order.
constexpr float kParts = 0x1p20F;
constexpr float kLeastAlike = 0.3F;  // cosine between normals of one surface

/// Weighted sums over the planes, seen from the point: u and v across its normal, h along it.
template <class Whole>
struct SumsOf {
  Whole w{}, h{}, spread2{}, u{}, v{}, slope_u{}, slope_v{}, uu{}, uv{}, vv{}, u_slope_u{}, v_slope_v{},
      u_slope_v{}, slope2{};
};
using PlaneSums = SumsOf<std::int32_t>;

struct Axes {
  Eigen::Vector3f n, u, v;
};

/// So many floats, or whole numbers, at once.
template <int kCount>
struct Lanes {
  using Floats [[gnu::vector_size(kCount * sizeof(float)), gnu::may_alias]] = float;
  using Wholes [[gnu::vector_size(kCount * sizeof(float))]] = std::int32_t;
};

/// All values are so small that no sum overflows: lengths below 5 units, slopes below 4, so what is added is
/// less than 32 parts, by 64 points at most.
template <int kLanes>
[[gnu::always_inline]] inline void add_planes(const SeenPlanes& planes, const Axes& axes, PlaneSums& total) {
  using Floats = typename Lanes<kLanes>::Floats;
  using Wholes = typename Lanes<kLanes>::Wholes;
  const float nx = axes.n.x(), ny = axes.n.y(), nz = axes.n.z();
  const float ux = axes.u.x(), uy = axes.u.y(), uz = axes.u.z();
  const float vx = axes.v.x(), vy = axes.v.y(), vz = axes.v.z();
  const Floats least = Floats{} + kLeastAlike;
  SumsOf<Wholes> sums;
  for (std::size_t i = 0; i < planes.size; i += kLanes) {
    const auto& x = reinterpret_cast<const Floats&>(planes.normal_x[i]);
    const auto& y = reinterpret_cast<const Floats&>(planes.normal_y[i]);
    const auto& z = reinterpret_cast<const Floats&>(planes.normal_z[i]);
    const auto& height = reinterpret_cast<const Floats&>(planes.height[i]);
    const auto& offset_x = reinterpret_cast<const Floats&>(planes.offset_x[i]);
    const auto& offset_y = reinterpret_cast<const Floats&>(planes.offset_y[i]);
    const auto& offset_z = reinterpret_cast<const Floats&>(planes.offset_z[i]);
    const auto& spread2 = reinterpret_cast<const Floats&>(planes.spread2[i]);
    const Floats cosine = x * nx + y * ny + z * nz;
    const Floats alike = cosine > least ? cosine : least;
    const Floats alike2 = alike * alike, alike4 = alike2 * alike2;
    const Floats full = alike4 * alike4 * kParts;
    const Floats weight = cosine > least ? full : Floats{};
    const Floats per_alike = 1.0F / alike;
    const Floats at_x = offset_x + height * x, at_y = offset_y + height * y, at_z = offset_z + height * z;
    const Floats at_n = at_x * nx + at_y * ny + at_z * nz;
    const Floats at_u = at_x * ux + at_y * uy + at_z * uz, at_v = at_x * vx + at_y * vy + at_z * vz;
    const Floats su = -(x * ux + y * uy + z * uz) * per_alike, sv = -(x * vx + y * vy + z * vz) * per_alike;
    const Floats wu = weight * at_u, wv = weight * at_v, wsu = weight * su, wsv = weight * sv;
    sums.w += __builtin_convertvector(weight, Wholes);
    sums.h += __builtin_convertvector(weight * at_n, Wholes);
    sums.spread2 += __builtin_convertvector(weight * spread2, Wholes);
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
  for (int i = 0; i < kLanes; ++i) {
    total.w += sums.w[i], total.h += sums.h[i], total.spread2 += sums.spread2[i];
    total.u += sums.u[i], total.v += sums.v[i];
    total.slope_u += sums.slope_u[i], total.slope_v += sums.slope_v[i];
    total.uu += sums.uu[i], total.uv += sums.uv[i], total.vv += sums.vv[i];
    total.u_slope_u += sums.u_slope_u[i], total.v_slope_v += sums.v_slope_v[i];
    total.u_slope_v += sums.u_slope_v[i], total.slope2 += sums.slope2[i];
  }
}

/// The height of the surface at the point, in units.
double height_by(const PlaneSums& sums) {
  // The planes share most of their points, and so a curvature is less sure than it looks.
  constexpr double kCaution = 16.0;
  const double weight = sums.w;
  if (!(weight > 0.0)) return 0.0;
  const double per_weight = 1.0 / weight;
  const auto mean = [&](std::int32_t sum) { return sum * per_weight; };
  const double u = mean(sums.u), v = mean(sums.v), su = mean(sums.slope_u), sv = mean(sums.slope_v);
  const double flat = mean(sums.h) - su * u - sv * v;
  // The rest is about the means.
  const double uu = mean(sums.uu) - u * u, uv = mean(sums.uv) - u * v, vv = mean(sums.vv) - v * v;
  const double u_su = mean(sums.u_slope_u) - u * su, v_sv = mean(sums.v_slope_v) - v * sv;
  const double u_sv = mean(sums.u_slope_v) - u * sv - v * su;
  const double slope2 = mean(sums.slope2) - su * su - sv * sv;
  const double extent2 = uu + vv, area = uu * vv - uv * uv;
  if (!(area > 1e-6 * extent2 * extent2)) return flat;
  // The slopes of a curved surface, by least squares: su = a u + b v, sv = b u + c v.
  const double b = (u_sv * uu * vv - uv * (vv * u_su + uu * v_sv)) / (extent2 * area);
  const double a = (u_su - uv * b) / uu, c = (v_sv - uv * b) / vv;
  const double unexplained = std::max(slope2 - a * u_su - b * u_sv - c * v_sv, 0.0);
  const double error2 = kCaution * unexplained / (extent2 * weight / static_cast<double>(kParts));
  const double curvature2 = 0.25 * (a + c) * (a + c);
  const double sure = curvature2 * curvature2, unsure = error2 * error2;
  const double trust = sure > 0.0 ? sure / (sure + unsure) : 0.0;
  // What curvature does to the mean of the heights: across each plane, and across the planes.
  const double bend = 0.5 * (0.5 * mean(sums.spread2) * (a + c) + a * uu + 2.0 * b * uv + c * vv);
  return flat - trust * bend;
}

void add_plain(const SeenPlanes& planes, const Axes& axes, PlaneSums& sums) {
  add_planes<4>(planes, axes, sums);
}
#ifdef __x86_64__
[[gnu::target("avx2")]] void add_avx2(const SeenPlanes& planes, const Axes& axes, PlaneSums& sums) {
  add_planes<8>(planes, axes, sums);
}
const auto add_fast = __builtin_cpu_supports("avx2") ? add_avx2 : add_plain;
#else
constexpr auto add_fast = add_plain;
#endif

}  // namespace

double SurfaceFit::height(std::size_t place, std::span<const std::uint32_t> neighbours) {
  const LocalPlane& own = planes_[place];
  take(place, own, neighbours);
  Axes axes;
  axes.n = own.normal;
  axes.u = axes.n.unitOrthogonal();
  axes.v = axes.n.cross(axes.u);
  PlaneSums sums;
  add_fast(seen_, axes, sums);
  return height_by(sums) * static_cast<double>(unit_);
}

/// The planes of the point and its neighbours.
void SurfaceFit::take(std::size_t place, const LocalPlane& own, std::span<const std::uint32_t> neighbours) {
  constexpr float kLeastUnit = 1e-9F;  // m
  constexpr std::uint32_t kExponent = 0x7f800000;
  unit_ = std::bit_cast<float>(std::bit_cast<std::uint32_t>(std::max(own.reach, kLeastUnit)) & kExponent);
  constexpr float kMostHeight = 1.0F,
                  kMostSpread2 = 16.0F;  // m²/unit² and units: the sums have that much room
  const float per_unit = 1.0F / unit_;
  const Eigen::Vector3d point = tree_.point(place);
  std::size_t count = 0;
  const auto add = [&](std::size_t other) {
    const LocalPlane& plane = planes_[other];
    const Eigen::Vector3d away = tree_.point(other) - point;
    seen_.normal_x[count] = plane.normal.x();
    seen_.normal_y[count] = plane.normal.y();
    seen_.normal_z[count] = plane.normal.z();
    seen_.offset_x[count] = static_cast<float>(away.x()) * per_unit;
    seen_.offset_y[count] = static_cast<float>(away.y()) * per_unit;
    seen_.offset_z[count] = static_cast<float>(away.z()) * per_unit;
    seen_.height[count] = std::clamp(plane.height * per_unit, -kMostHeight, kMostHeight);
    seen_.spread2[count] = std::min(plane.spread2 * (per_unit * per_unit), kMostSpread2);
    ++count;
  };
  add(place);
  for (const std::uint32_t neighbour : neighbours)
    add(neighbour);
  // What fills up the last lanes has no normal, and so no weight.
  for (; count % SeenPlanes::kLanes != 0; ++count)
    seen_.normal_x[count] = seen_.normal_y[count] = seen_.normal_z[count] = 0.0F;
  seen_.size = count;
}

}  // namespace ray
