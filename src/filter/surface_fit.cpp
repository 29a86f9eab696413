#include "surface_fit.h"

#include <algorithm>
#include <bit>
#include <cstdint>

#ifdef __SSE2__
#include <emmintrin.h>
#endif

namespace ray {
namespace {

/// Sums of what single points add, in small whole parts: exact, and so the same in any order.
class ExactSum {
 public:
  static constexpr float kParts = 0x1p20F;

  /// Each less than 32 · kParts, and less than 64 points.
  void add(const Lanes& parts) {
#ifdef __SSE2__
    _mm_store_si128(reinterpret_cast<__m128i*>(sum_.data()),
                    _mm_add_epi32(_mm_load_si128(reinterpret_cast<const __m128i*>(sum_.data())),
                                  _mm_cvttps_epi32(_mm_load_ps(parts.data()))));
#else
    sum_ += parts.cast<std::int32_t>();
#endif
  }
  [[nodiscard]] double value() const {
    return static_cast<double>(sum_.cast<std::int64_t>().sum()) * (1.0 / static_cast<double>(kParts));
  }

 private:
  Eigen::Array<std::int32_t, 4, 1> sum_ = Eigen::Array<std::int32_t, 4, 1>::Zero();
};

constexpr std::size_t kLanes = 4;
constexpr float kLeastAlike = 0.3F;  // cosine between normals of one surface

std::size_t groups_of(std::size_t points) {
  return (points + kLanes - 1) / kLanes;
}

template <class Groups>
void put(Groups& groups, std::size_t i, float value) {
  groups[i / kLanes][static_cast<Eigen::Index>(i % kLanes)] = value;
}

template <class Groups>
void put_vector(Groups& groups, std::size_t i, const Eigen::Vector3f& value) {
  const auto lane = static_cast<Eigen::Index>(i % kLanes);
  LanesOfVectors& group = groups[i / kLanes];
  group.x[lane] = value.x(), group.y[lane] = value.y(), group.z[lane] = value.z();
}

/// Weighted sums over the planes, seen from the point: u and v across its normal, h along it.
struct PlaneSums {
  ExactSum w, h, spread2, u, v, slope_u, slope_v, uu, uv, vv, u_slope_u, v_slope_v, u_slope_v, slope2;

  /// All values are so small that no sum overflows: lengths below 5 units, slopes below 4.
  void add(const Lanes& weight, const Lanes& height, const Lanes& spread, const Lanes& at_u,
           const Lanes& at_v, const Lanes& su, const Lanes& sv) {
    const Lanes wu = weight * at_u, wv = weight * at_v, wsu = weight * su, wsv = weight * sv;
    w.add(weight), h.add(weight * height), spread2.add(weight * spread);
    u.add(wu), v.add(wv), slope_u.add(wsu), slope_v.add(wsv);
    uu.add(wu * at_u), uv.add(wu * at_v), vv.add(wv * at_v);
    u_slope_u.add(wu * su), v_slope_v.add(wv * sv), u_slope_v.add(wu * sv + wv * su);
    slope2.add(wsu * su + wsv * sv);
  }
};

/// The height of the surface at the point, in units.
double height_by(const PlaneSums& sums) {
  // The planes share most of their points, and so a curvature is less sure than it looks.
  constexpr double kCaution = 16.0;
  const double weight = sums.w.value();
  if (!(weight > 0.0)) return 0.0;
  const auto mean = [&](const ExactSum& sum) { return sum.value() / weight; };
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
  const double error2 = kCaution * unexplained / (extent2 * weight);
  const double curvature2 = 0.25 * (a + c) * (a + c);
  const double sure = curvature2 * curvature2, unsure = error2 * error2;
  const double trust = sure > 0.0 ? sure / (sure + unsure) : 0.0;
  // What curvature does to the mean of the heights: across each plane, and across the planes.
  const double bend = 0.5 * (0.5 * mean(sums.spread2) * (a + c) + a * uu + 2.0 * b * uv + c * vv);
  return flat - trust * bend;
}

}  // namespace

SurfaceFit::SurfaceFit(const PointTree& tree, std::span<const LocalPlane> planes)
    : tree_(tree), planes_(planes) {
  for (auto* vectors : {&normals_, &offsets_})
    vectors->fill({Lanes::Zero(), Lanes::Zero(), Lanes::Zero()});
  for (auto* lanes : {&heights_, &spreads2_})
    lanes->fill(Lanes::Zero());
}

double SurfaceFit::height(std::size_t place, std::span<const Neighbour> neighbours) {
  const LocalPlane& own = planes_[place];
  take(place, own, neighbours);
  const Eigen::Vector3f n = own.normal, along_u = n.unitOrthogonal(), along_v = n.cross(along_u);
  PlaneSums sums;
  for (std::size_t g = 0; g < groups_of(neighbours.size() + 1); ++g) {
    const LanesOfVectors& normal = normals_[g];
    const Lanes cosine = normal.dot(n);
    // 1 where it is above, by however little, else 0.
    const Lanes is_alike = ((cosine - kLeastAlike) * 1e30F).max(0.0F).min(1.0F);
    const Lanes alike = cosine.max(kLeastAlike);
    const Lanes per_alike = 1.0F / alike;
    const LanesOfVectors at{offsets_[g].x + heights_[g] * normal.x, offsets_[g].y + heights_[g] * normal.y,
                            offsets_[g].z + heights_[g] * normal.z};
    const Lanes weight = is_alike * alike.square().square().square() * ExactSum::kParts;
    sums.add(weight, at.dot(n), spreads2_[g], at.dot(along_u), at.dot(along_v),
             -normal.dot(along_u) * per_alike, -normal.dot(along_v) * per_alike);
  }
  return height_by(sums) * static_cast<double>(unit_);
}

/// The planes of the point and its neighbours.
void SurfaceFit::take(std::size_t place, const LocalPlane& own, std::span<const Neighbour> neighbours) {
  constexpr float kLeastUnit = 1e-9F;  // m
  constexpr std::uint32_t kExponent = 0x7f800000;
  unit_ = std::bit_cast<float>(std::bit_cast<std::uint32_t>(std::max(own.reach, kLeastUnit)) & kExponent);
  constexpr float kMostHeight = 1.0F,
                  kMostSpread2 = 16.0F;  // m²/unit² and units: the sums have that much room
  const float per_unit = 1.0F / unit_;
  const Eigen::Vector3d point = tree_.point(place);
  // What fills up the last group has no normal, and so no weight.
  normals_[groups_of(neighbours.size() + 1) - 1] = {Lanes::Zero(), Lanes::Zero(), Lanes::Zero()};
  std::size_t count = 0;
  const auto add = [&](std::size_t other) {
    const LocalPlane& plane = planes_[other];
    const Eigen::Vector3d away = tree_.point(other) - point;
    put_vector(normals_, count, plane.normal);
    put_vector(offsets_, count, away.cast<float>() * per_unit);
    put(heights_, count, std::clamp(plane.height * per_unit, -kMostHeight, kMostHeight));
    put(spreads2_, count, std::min(plane.spread2 * (per_unit * per_unit), kMostSpread2));
    ++count;
  };
  add(place);
  for (const Neighbour& neighbour : neighbours)
    add(neighbour.place);
}

}  // namespace ray
