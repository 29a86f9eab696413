#include "surface_points.h"

#include <raycloud/exec/parallel.h>
#include <raycloud/filter/smooth.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>

namespace ray {
namespace {

/// The plane around a point: through point + height · normal.
struct LocalPlane {
  Eigen::Vector3f normal = Eigen::Vector3f::Zero();  // zero: there is none
  float height = 0.0F;                               // m
  float spread2 = 0.0F;  // m², variance of its points along it, both ways together
  float reach = 0.0F;    // m, of its neighbours
};

LocalPlane plane_of(const PointTree& tree, std::size_t place, const Surfel& surfel) {
  if (!surfel.is_surface()) return {};
  const double height = surfel.normal.dot(surfel.centroid - tree.point(place));
  return {surfel.normal.cast<float>(), static_cast<float>(height),
          static_cast<float>(surfel.variances[1] + surfel.variances[2]),
          static_cast<float>(std::sqrt(surfel.reach2))};
}

// As many points as this are asked for the surface through one.
constexpr std::size_t kMostPlanes = 63;
// They are within so many times the reach of its plane: some forty on a surface.
constexpr double kWider = 1.6;

/// Four points at a time.
using Lanes = Eigen::Array4f;

/// Sums of what single points add, in small whole parts: exact, and so the same in any order.
class ExactSum {
 public:
  static constexpr float kParts = 0x1p20F;

  /// Each less than 32 · kParts, and less than 64 points.
  void add(const Lanes& parts) { sum_ += parts.cast<std::int32_t>(); }
  [[nodiscard]] double value() const {
    return static_cast<double>(sum_.cast<std::int64_t>().sum()) * (1.0 / static_cast<double>(kParts));
  }

 private:
  Eigen::Array<std::int32_t, 4, 1> sum_ = Eigen::Array<std::int32_t, 4, 1>::Zero();
};

struct LanesOfVectors {
  Lanes x, y, z;
  [[nodiscard]] Lanes dot(const Eigen::Vector3f& other) const {
    return x * other.x() + y * other.y() + z * other.z();
  }
};

/// The surface through the planes around a point, which are a sample of its heights and slopes. Their mean
/// height is that of the surface but for its curvature, which pulls it towards the hollow side twice: the
/// points of each plane lie on a curved surface, and so do the planes. The curvature is how much their slopes
/// change from place to place; it is trusted as far as it is more than its error. The unit of length is about
/// the reach of the neighbours.
class SurfaceFit {
 public:
  SurfaceFit(const PointTree& tree, std::span<const LocalPlane> planes) : tree_(tree), planes_(planes) {
    for (auto* vectors : {&normals_, &offsets_})
      vectors->fill({Lanes::Zero(), Lanes::Zero(), Lanes::Zero()});
    for (auto* lanes : {&heights_, &spreads2_})
      lanes->fill(Lanes::Zero());
  }

  /// Of the surface from the point, along the normal of its plane, m.
  [[nodiscard]] double height(std::size_t place, std::span<const Neighbour> neighbours) {
    const LocalPlane& own = planes_[place];
    take(place, own, neighbours);
    const Eigen::Vector3f n = own.normal, e = n.unitOrthogonal(), f = n.cross(e);
    std::array<ExactSum, 14> sums;
    for (std::size_t g = 0; g < groups_of(neighbours.size() + 1); ++g) {
      const LanesOfVectors& normal = normals_[g];
      const Lanes cosine = normal.dot(n);
      // 1 where it is above, by however little, else 0.
      const Lanes is_alike = ((cosine - kLeastAlike) * 1e30F).max(0.0F).min(1.0F);
      const Lanes alike = cosine.max(kLeastAlike);
      const Lanes per_alike = 1.0F / alike;
      const LanesOfVectors at{offsets_[g].x + heights_[g] * normal.x, offsets_[g].y + heights_[g] * normal.y,
                              offsets_[g].z + heights_[g] * normal.z};
      const Lanes h = at.dot(n), u = at.dot(e), v = at.dot(f);
      const Lanes su = -normal.dot(e) * per_alike, sv = -normal.dot(f) * per_alike;
      const Lanes w = is_alike * (alike * alike) * (alike * alike) * ExactSum::kParts;
      const Lanes wu = w * u, wv = w * v, wsu = w * su, wsv = w * sv;
      const std::array<Lanes, 14> parts{w,
                                        w * h,
                                        w * spreads2_[g],
                                        wu,
                                        wv,
                                        wsu,
                                        wsv,
                                        wu * u,
                                        wu * v,
                                        wv * v,
                                        wu * su,
                                        wv * sv,
                                        wu * sv + wv * su,
                                        wsu * su + wsv * sv};
      for (std::size_t i = 0; i < parts.size(); ++i)
        sums[i].add(parts[i]);
    }
    const auto& [w_, h_, spread_, u_, v_, su_, sv_, uu_, uv_, vv_, usu_, vsv_, cross_, ss_] = sums;
    const double weight = w_.value();
    if (!(weight > 0.0)) return 0.0;
    const auto mean = [&](const ExactSum& sum) { return sum.value() / weight; };
    const double u = mean(u_), v = mean(v_), su = mean(su_), sv = mean(sv_);
    const double uu = mean(uu_) - u * u, uv = mean(uv_) - u * v, vv = mean(vv_) - v * v;
    const double usu = mean(usu_) - u * su, vsv = mean(vsv_) - v * sv, cross = mean(cross_) - u * sv - v * su;
    const double ss = mean(ss_) - su * su - sv * sv;
    const double flat = mean(h_) - su * u - sv * v;
    // The slopes that go with a curvature: su = a u + b v, sv = b u + d v, by least squares.
    const double extent2 = uu + vv, area = uu * vv - uv * uv;
    if (!(area > 1e-6 * extent2 * extent2)) return flat * static_cast<double>(unit_);
    const double b = (cross * uu * vv - uv * (vv * usu + uu * vsv)) / (extent2 * area);
    const double a = (usu - uv * b) / uu, d = (vsv - uv * b) / vv;
    const double rest = std::max(ss - a * usu - b * cross - d * vsv, 0.0);
    const double curvature2 = 0.25 * (a + d) * (a + d);
    const double error2 = kCaution * rest / (extent2 * weight);
    const double trust =
        curvature2 > 0.0 ? curvature2 * curvature2 / (curvature2 * curvature2 + error2 * error2) : 0.0;
    const double bend = 0.5 * (0.5 * mean(spread_) * (a + d) + a * uu + 2.0 * b * uv + d * vv);
    return (flat - trust * bend) * static_cast<double>(unit_);
  }

 private:
  static constexpr std::size_t kLanes = 4;
  static constexpr std::size_t kGroups = (kMostPlanes + 1) / kLanes;

  /// The planes of the point and its neighbours.
  void take(std::size_t place, const LocalPlane& own, std::span<const Neighbour> neighbours) {
    constexpr std::uint32_t kExponent = 0x7f800000;
    unit_ = std::bit_cast<float>(std::bit_cast<std::uint32_t>(std::max(own.reach, kLeastUnit)) & kExponent);
    constexpr float kMostHeight = 1.0F, kMostSpread2 = 16.0F;  // so that the sums have room
    const float per_unit = 1.0F / unit_;
    const Eigen::Vector3d point = tree_.point(place);
    // What fills up the last group has no normal, and so no weight.
    normals_[groups_of(neighbours.size() + 1) - 1] = {Lanes::Zero(), Lanes::Zero(), Lanes::Zero()};
    std::size_t count = 0;
    const auto add = [&](std::size_t other) {
      const LocalPlane& plane = planes_[other];
      const Eigen::Vector3d away = tree_.point(other) - point;
      put(normals_, count, plane.normal);
      put(offsets_, count, away.cast<float>() * per_unit);
      put(heights_, count, std::clamp(plane.height * per_unit, -kMostHeight, kMostHeight));
      put(spreads2_, count, std::min(plane.spread2 * (per_unit * per_unit), kMostSpread2));
      ++count;
    };
    add(place);
    for (const Neighbour& neighbour : neighbours)
      add(neighbour.place);
  }

  static std::size_t groups_of(std::size_t points) { return (points + kLanes - 1) / kLanes; }
  static void put(std::array<Lanes, kGroups>& lanes, std::size_t i, float value) {
    lanes[i / kLanes][static_cast<Eigen::Index>(i % kLanes)] = value;
  }
  static void put(std::array<LanesOfVectors, kGroups>& lanes, std::size_t i, const Eigen::Vector3f& value) {
    const auto lane = static_cast<Eigen::Index>(i % kLanes);
    LanesOfVectors& group = lanes[i / kLanes];
    group.x[lane] = value.x(), group.y[lane] = value.y(), group.z[lane] = value.z();
  }

  // The planes share most of their points, and so their mean is less sure than it looks.
  static constexpr double kCaution = 16.0;
  static constexpr float kLeastAlike = 0.3F;  // cosine between normals of one surface
  static constexpr float kLeastUnit = 1e-9F;  // m

  const PointTree& tree_;
  std::span<const LocalPlane> planes_;
  float unit_ = 1.0F;  // m, a power of two, at most the reach
  std::array<LanesOfVectors, kGroups> normals_, offsets_;
  std::array<Lanes, kGroups> heights_, spreads2_;
};

using Move = Eigen::Vector3f;  // m

/// To a height above the plane's point: along the ray where that is not too much aslant, else along the
/// normal.
Move move_of(const LocalPlane& plane, double height, const PackedDirection& to_sensor) {
  constexpr double kFacing = 0.3;  // cosine from which on the ray is better than the normal
  const Eigen::Vector3d normal = plane.normal.cast<double>();
  const Eigen::Vector3d ray = unpack_direction(to_sensor).normalized();
  const double facing = ray.dot(normal);
  const bool along_ray = facing > kFacing;
  const double most = plane.reach;
  const double distance = std::clamp(along_ray ? height / facing : height, -most, most);
  return (distance * (along_ray ? ray : normal)).cast<float>();
}

std::vector<Move> smooth_block(const Context& context, Block<SeenPoint>&& block, double reach) {
  const PointTree tree(context, block.records);
  block.records = std::vector<SeenPoint>();
  std::vector<LocalPlane> planes(tree.size());
  for_each_place(context, tree, [&](NeighbourSearch& search, std::size_t begin, std::size_t end) {
    for (std::size_t place = begin; place < end; ++place)
      planes[place] =
          plane_of(tree, place, surfel_at(search, place, {kSurfaceNeighbours, reach / (1.0 + kWider), true}));
  });
  std::vector<Move> moves(tree.size(), Move::Zero());
  for_each_place(context, tree, [&](NeighbourSearch& search, std::size_t begin, std::size_t end) {
    SurfaceFit fit(tree, planes);
    for (std::size_t place = begin; place < end; ++place) {
      const LocalPlane& plane = planes[place];
      if (!block.is_own(tree.index(place)) || plane.normal.isZero()) continue;
      const auto neighbours = search.nearest_facing(
          place, kMostPlanes, kWider * static_cast<double>(plane.reach), plane.normal.cast<double>());
      moves[tree.index(place)] = move_of(plane, fit.height(place, neighbours), tree.to_sensor(place));
    }
  });
  return moves;
}

}  // namespace

StreamCounts smooth_rays(const Context& context, RaySource& source, RaySink& sink) {
  // The surface at a point depends on the planes of its neighbours, and these on theirs.
  const BlockNeeds needs{.bytes_per_record = 90, .reach = [](const EndSample& sample) {
                           return (1.0 + kWider) * neighbour_reach(sample);
                         }};
  return run_blocks<SeenPoint, Move>(context, source, sink, needs, seen_point, smooth_block,
                                     [](RayCloud& rays, std::span<const Move> moves) {
                                       std::size_t next = 0;
                                       for (std::size_t i = 0; i < rays.size(); ++i)
                                         if (rays.bounded[i] != 0)
                                           rays.ends[i] += moves[next++].cast<double>();
                                     });
}

}  // namespace ray
