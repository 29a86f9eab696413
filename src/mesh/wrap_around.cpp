#include "convex_ceiling.h"
#include "cube_map.h"
#include "space_hull.h"
#include "wrap_forms.h"

#include <raycloud/core/error.h>
#include <raycloud/mesh/mesh_distance.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

namespace ray {
namespace {

/// Turns the conics of the probe into planes: a conic with its focus in the middle and curvature k at its
/// apex has 1/r = cos(angle)/d - k, so with 1/R = 1/r + k (inwards), and 1/R = k - 1/r (outwards), it is the
/// plane R cos(angle) = d.
struct RadialMap {
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  double curvature = 0.0;
  double sign = 1.0;

  [[nodiscard]] Eigen::Vector3d operator()(const Eigen::Vector3d& end) const {
    const Eigen::Vector3d away = end - middle;
    return away / (curvature * away.norm() + sign);
  }
};

/// In the order of the rays, so that chunks leave no trace.
Eigen::Vector3d middle_of(const Context& context, RaySource& source, const EndsSurvey& survey, double sign) {
  const Eigen::Vector3d origin = 0.5 * (survey.bounds.min + survey.bounds.max);  // sums stay small
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  stream(
      context, source, nullptr, [](RayCloud&) { return Nothing{}; },
      [&](RayCloud& rays, Nothing&) {
        for (std::size_t i = 0; i < rays.size(); ++i) {
          if (rays.bounded[i] != 0) sum += (sign > 0.0 ? rays.ends[i] : rays.starts[i]) - origin;
        }
      });
  return origin + sum / static_cast<double>(survey.bounded);
}

struct Furthest {
  Eigen::Vector3d mapped = Eigen::Vector3d::Zero();
  double squared = -1.0;
};

/// Of the mapped ends, in each cell of a cube map; throws if one is nearer than the probe's ball.
std::vector<Furthest> furthest_of_cells(const Context& context, RaySource& source, const RadialMap& map,
                                        std::size_t sides) {
  std::vector<Furthest> furthest(6 * sides * sides);
  double nearest = std::numeric_limits<double>::infinity();
  stream(
      context, source, nullptr,
      [&](RayCloud& rays) {
        std::vector<Eigen::Vector3d> ends;
        for (std::size_t i = 0; i < rays.size(); ++i)
          if (rays.bounded[i] != 0) ends.push_back(rays.ends[i]);
        return ends;
      },
      [&](RayCloud&, const std::vector<Eigen::Vector3d>& ends) {
        for (const Eigen::Vector3d& end : ends) {
          nearest = std::min(nearest, (end - map.middle).squaredNorm());
          const Eigen::Vector3d mapped = map(end);
          const double squared = mapped.squaredNorm();
          if (!(squared > 0.0)) continue;
          const CubeMapPlace place = on_cube(mapped);
          const auto cell = [&](double u) {
            return std::min(static_cast<std::size_t>(u * static_cast<double>(sides)), sides - 1);
          };
          Furthest& own = furthest[(place.side * sides + cell(place.v)) * sides + cell(place.u)];
          if (squared > own.squared) own = {mapped, squared};
        }
      });
  nearest = std::sqrt(nearest);
  if (map.sign < 0.0 && !(map.curvature * nearest > 1.0)) {
    char text[200];
    std::snprintf(
        text, sizeof text,
        "the middle (%.3g,%.3g,%.3g) is %.3g m from an end: outwards takes a curvature above %.4g, for "
        "a ball that fits between",
        map.middle.x(), map.middle.y(), map.middle.z(), nearest, 1.0 / nearest);
    throw Error(ErrorCode::out_of_range, text);
  }
  std::erase_if(furthest, [](const Furthest& one) { return one.squared < 0.0; });
  return furthest;
}

SpacePoint in_steps(const Eigen::Vector3d& mapped, double per_unit) {
  return {std::llround(mapped.x() * per_unit), std::llround(mapped.y() * per_unit),
          std::llround(mapped.z() * per_unit)};
}

/// Tells points that are inside of the hull of a few, and so of the hull of all.
class InnerBody {
 public:
  InnerBody(const std::vector<Furthest>& few, double per_unit, std::size_t sides)
      : gauges_(6, ConvexCeiling(sides)) {
    std::vector<SpacePoint> points;
    for (const Furthest& one : few)
      points.push_back(in_steps(one.mapped, per_unit));
    const auto hull = SpaceHull::make(std::move(points));
    if (hull == nullptr) return;
    inside_ = hull->inside();
    for (std::size_t side = 0; side < 6; ++side) {
      for (std::size_t row = 0; row <= sides; ++row) {
        for (std::size_t column = 0; column <= sides; ++column) {
          const auto share = [&](std::size_t i) {
            return static_cast<double>(i) / static_cast<double>(sides);
          };
          constexpr double kFar = 0x1p34;
          const double gauge = hull->gauge(kFar * cube_direction(side, share(column), share(row))) / kFar;
          gauges_[side].sample(column, row) = gauge * (1.0 + 1e-7);
        }
      }
    }
  }
  [[nodiscard]] bool has(const SpacePoint& point) const {
    const Eigen::Vector3d away = Eigen::Vector3d(static_cast<double>(point[0]), static_cast<double>(point[1]),
                                                 static_cast<double>(point[2])) -
                                 inside_;
    if (away.isZero(0.0)) return false;
    const CubeMapPlace place = on_cube(away);
    return place.length * gauges_[place.side].at(place.u, place.v) < 1.0;
  }

 private:
  Eigen::Vector3d inside_ = Eigen::Vector3d::Zero();
  std::vector<ConvexCeiling> gauges_;
};

struct MappedEnd {
  SpacePoint point;
  Eigen::Vector3d end;
};

std::vector<MappedEnd> outside_of(const Context& context, RaySource& source, const RadialMap& map,
                                  double per_unit, const InnerBody& inner) {
  std::vector<MappedEnd> all;
  stream(
      context, source, nullptr,
      [&](RayCloud& rays) {
        std::vector<MappedEnd> ends;
        for (std::size_t i = 0; i < rays.size(); ++i) {
          if (rays.bounded[i] == 0) continue;
          const SpacePoint point = in_steps(map(rays.ends[i]), per_unit);
          if (!inner.has(point)) ends.push_back({point, rays.ends[i]});
        }
        return ends;
      },
      [&](RayCloud&, const std::vector<MappedEnd>& ends) {
        all.insert(all.end(), ends.begin(), ends.end());
      });
  return all;
}

/// Of a power of two in length; the least that is not below.
double step_not_below(double length) {
  return std::exp2(std::ceil(std::log2(length)));
}

/// To steps that those of the ends will be no coarser than: ends in a plane of round coordinates stay in one.
Eigen::Vector3d snapped(const Eigen::Vector3d& middle, const Bounds& bounds) {
  const double size = std::max(bounds.extent().norm(), 1e-300);
  const double furthest = bounds.min.cwiseAbs().cwiseMax(bounds.max.cwiseAbs()).maxCoeff();
  const double step = step_not_below(std::max(size / static_cast<double>(kSpaceSteps), 4e-16 * furthest));
  return (middle / step).array().round() * step + 0.0;  // no -0
}

std::uint64_t count_cut_off(const Context& context, RaySource& source, const Mesh& mesh, double little) {
  const MeshDistance distance(mesh);
  std::uint64_t count = 0;
  stream(
      context, source, nullptr,
      [&](RayCloud& rays) {
        std::vector<Eigen::Vector3d> ends;
        for (std::size_t i = 0; i < rays.size(); ++i)
          if (rays.bounded[i] != 0) ends.push_back(rays.ends[i]);
        std::vector<std::uint8_t> are_outside(ends.size());
        distance.are_beyond(ends, -little, are_outside);
        return static_cast<std::uint64_t>(std::count(are_outside.begin(), are_outside.end(), 0));
      },
      [&](RayCloud&, std::uint64_t part) { count += part; });
  return count;
}

Mesh mesh_of(const SpaceHull& hull, const std::vector<MappedEnd>& ends) {
  Mesh mesh;
  mesh.faces = hull.complex().finite_faces();
  std::vector<std::uint32_t> number(ends.size(), 0);
  for (Mesh::Face& face : mesh.faces) {
    for (std::uint32_t& vertex : face) {
      if (number[vertex] == 0) {
        mesh.vertices.push_back(ends[vertex].end);
        number[vertex] = static_cast<std::uint32_t>(mesh.vertices.size());
      }
      vertex = number[vertex] - 1;
    }
  }
  return mesh;
}

}  // namespace

Wrap wrap_around(const Context& context, RaySource& source, const EndsSurvey& survey, double curvature,
                 double sign) {
  RadialMap map{snapped(middle_of(context, source, survey, sign), survey.bounds), curvature, sign};
  source.rewind();
  const auto sides = static_cast<std::size_t>(
      std::clamp(std::sqrt(static_cast<double>(survey.bounded) / (6.0 * 16.0)), 1.0, 128.0));
  const std::vector<Furthest> few = furthest_of_cells(context, source, map, sides);
  source.rewind();
  double furthest = 0.0;
  for (const Furthest& one : few)
    furthest = std::max(furthest, one.squared);
  if (furthest == 0.0) throw Error(ErrorCode::no_data, "all ends are at one place");
  const double per_unit = 1.0 / step_not_below(std::sqrt(furthest) / static_cast<double>(kSpaceSteps - 1));
  const std::vector<MappedEnd> ends =
      outside_of(context, source, map, per_unit, InnerBody(few, per_unit, 2 * sides));
  std::vector<SpacePoint> points;
  for (const MappedEnd& end : ends)
    points.push_back(end.point);
  check_cancelled(context);
  const auto hull = SpaceHull::make(std::move(points));
  if (hull == nullptr)
    throw Error(ErrorCode::no_data, "all ends are in one plane, so nothing is around them");
  Wrap result{.mesh = mesh_of(*hull, ends), .stream = survey.stream, .bounded = survey.bounded};
  if (sign < 0.0 && !hull->holds({0, 0, 0})) {
    source.rewind();
    result.cut_off = count_cut_off(context, source, result.mesh, 1e-6 * survey.bounds.extent().maxCoeff());
  }
  return result;
}

}  // namespace ray
