#include "convex_ceiling.h"
#include "insertion_order.h"
#include "lower_hull.h"
#include "plan_steps.h"
#include "wrap_forms.h"

#include <raycloud/core/error.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace ray {
namespace {

/// An end where the probe is flat: raised by curvature/2 ρ², so that lower paraboloids become planes.
struct LiftedEnd {
  PlanPoint point;
  double z = 0.0;           ///< m, as it was
  std::uint64_t curve = 0;  ///< place of the point on the curve of `insertion_order.h`
};

class Lift {
 public:
  Lift(const Bounds& bounds, double curvature, double sign)
      : steps_(bounds), half_curvature_(0.5 * curvature), sign_(sign) {
    centre_ = 0.5 * (bounds.min + bounds.max);
    lowest_ = std::min(sign * bounds.min.z(), sign * bounds.max.z());
    const double rise = half_curvature_ * (0.51 * bounds.extent()).head<2>().squaredNorm();
    const double range = std::max(bounds.extent().z() + rise + 1e-9 * (1.0 + rise), 1e-300);
    per_metre_ = 0.5 * static_cast<double>(kHeightSteps) / range;
  }

  [[nodiscard]] LiftedEnd operator()(const Eigen::Vector3d& end) const {
    LiftedEnd lifted;
    lifted.point.x = steps_.x(end.x());
    lifted.point.y = steps_.y(end.y());
    lifted.z = end.z();
    const Eigen::Vector2d away = steps_.place(lifted.point.x, lifted.point.y) - centre_.head<2>();
    const double height = sign_ * end.z() - lowest_ + half_curvature_ * away.squaredNorm();
    lifted.point.height = static_cast<std::int64_t>(height * per_metre_);
    return lifted;
  }

  [[nodiscard]] Eigen::Vector3d vertex(const LiftedEnd& end) const {
    const Eigen::Vector2d place = steps_.place(end.point.x, end.point.y);
    return {place.x(), place.y(), end.z};
  }

 private:
  PlanSteps steps_;
  double half_curvature_;
  double sign_;
  Eigen::Vector3d centre_;
  double lowest_ = 0.0;
  double per_metre_ = 1.0;
};

double share(std::int64_t coordinate) {
  return static_cast<double>(coordinate) / static_cast<double>(kPlanSteps);
}

/// The lowest lifted end of each cell of the plan.
std::vector<PlanPoint> lowest_of_cells(const Context& context, RaySource& source, const Lift& lift,
                                       std::size_t sides) {
  constexpr std::int64_t kNone = std::numeric_limits<std::int64_t>::max();
  std::vector<PlanPoint> lowest(sides * sides, {0, 0, kNone});
  stream(
      context, source, nullptr,
      [&](RayCloud& rays) {
        std::vector<PlanPoint> points;
        for (std::size_t i = 0; i < rays.size(); ++i)
          if (rays.bounded[i] != 0) points.push_back(lift(rays.ends[i]).point);
        return points;
      },
      [&](RayCloud&, const std::vector<PlanPoint>& points) {
        for (const PlanPoint& point : points) {
          const auto cell = [&](std::int64_t c) {
            return static_cast<std::size_t>(share(c) * static_cast<double>(sides));
          };
          PlanPoint& own = lowest[cell(point.y) * sides + cell(point.x)];
          if (point.height < own.height) own = point;
        }
      });
  std::erase_if(lowest, [](const PlanPoint& point) { return point.height == kNone; });
  return lowest;
}

/// What lies above this lies above the hull of a few of the ends, and so of all.
ConvexCeiling ceiling_of(std::vector<PlanPoint> few, std::size_t sides) {
  ConvexCeiling ceiling(sides);
  const auto hull = LowerHull::make(std::move(few));
  if (hull == nullptr) return ceiling;
  hull->insert_all();
  for (std::size_t row = 0; row <= sides; ++row) {
    for (std::size_t i = 0; i <= sides; ++i) {
      const std::size_t column = row % 2 == 0 ? i : sides - i;  // to and fro: each is near the one before
      const auto coordinate = [&](std::size_t cell) {
        return static_cast<std::int64_t>(cell) * kPlanSteps / static_cast<std::int64_t>(sides);
      };
      // More than rounding can do.
      constexpr double kMargin = static_cast<double>(kHeightSteps) * 0x1p-40;
      if (const auto height = hull->height_at(coordinate(column), coordinate(row)))
        ceiling.sample(column, row) = *height + kMargin;
    }
  }
  return ceiling;
}

std::vector<LiftedEnd> below(const Context& context, RaySource& source, const Lift& lift,
                             const ConvexCeiling& ceiling) {
  std::vector<LiftedEnd> all;
  stream(
      context, source, nullptr,
      [&](RayCloud& rays) {
        std::vector<LiftedEnd> ends;
        for (std::size_t i = 0; i < rays.size(); ++i) {
          if (rays.bounded[i] == 0) continue;
          const LiftedEnd end = lift(rays.ends[i]);
          const double most = ceiling.at(share(end.point.x), share(end.point.y));
          if (static_cast<double>(end.point.height) > most) continue;
          ends.push_back(end);
          ends.back().curve = place_on_curve(std::array<std::uint32_t, 2>{
              static_cast<std::uint32_t>(end.point.x) * 2, static_cast<std::uint32_t>(end.point.y) * 2});
        }
        return ends;
      },
      [&](RayCloud&, const std::vector<LiftedEnd>& ends) {
        all.insert(all.end(), ends.begin(), ends.end());
      });
  return all;
}

/// Each near the one before, as the hull wants them; those at one place in the order of the rays.
std::vector<LiftedEnd> along_curve(const Context& context, const std::vector<LiftedEnd>& ends) {
  struct Key {
    std::uint64_t curve;
    std::uint32_t index;
  };
  std::vector<Key> keys(ends.size());
  for (std::uint32_t i = 0; i < keys.size(); ++i)
    keys[i] = {ends[i].curve, i};
  parallel_sort(context, keys.begin(), keys.end(),
                [](const Key& a, const Key& b) { return a.curve < b.curve; });
  std::vector<LiftedEnd> sorted(ends.size());
  for (std::size_t i = 0; i < keys.size(); ++i)
    sorted[i] = ends[keys[i].index];
  return sorted;
}

Mesh mesh_of(const LowerHull& hull, const std::vector<LiftedEnd>& ends, const Lift& lift) {
  Mesh mesh;
  mesh.faces = hull.complex().finite_faces();
  std::vector<std::uint32_t> number(ends.size(), 0);
  for (Mesh::Face& face : mesh.faces) {
    for (std::uint32_t& vertex : face) {
      if (number[vertex] == 0) {
        mesh.vertices.push_back(lift.vertex(ends[vertex]));
        number[vertex] = static_cast<std::uint32_t>(mesh.vertices.size());
      }
      vertex = number[vertex] - 1;
    }
  }
  return mesh;
}

}  // namespace

Wrap wrap_from_below(const Context& context, RaySource& source, const EndsSurvey& survey, double curvature,
                     double sign) {
  const Lift lift(survey.bounds, curvature, sign);
  const auto sides =
      static_cast<std::size_t>(std::clamp(std::sqrt(static_cast<double>(survey.bounded) / 16.0), 1.0, 512.0));
  std::vector<PlanPoint> lowest = lowest_of_cells(context, source, lift, sides);
  source.rewind();
  const ConvexCeiling ceiling = ceiling_of(std::move(lowest), 2 * sides);
  const std::vector<LiftedEnd> ends = along_curve(context, below(context, source, lift, ceiling));
  std::vector<PlanPoint> points;
  points.reserve(ends.size() + 1);
  for (const LiftedEnd& end : ends)
    points.push_back(end.point);
  const auto hull = LowerHull::make_along_curve(std::move(points));
  if (hull == nullptr) throw Error(ErrorCode::no_data, "all ends are on one line of the map");
  check_cancelled(context);
  hull->insert_all();
  return {.mesh = mesh_of(*hull, ends, lift), .stream = survey.stream, .bounded = survey.bounded};
}

}  // namespace ray
