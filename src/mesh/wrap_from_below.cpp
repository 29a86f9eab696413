#include "convex_ceiling.h"
#include "insertion_order.h"
#include "lower_hull.h"
#include "plan_steps.h"
#include "wrap_forms.h"

#include <raycloud/core/error.h>
#include <raycloud/exec/fresh_memory.h>
#include <raycloud/exec/parallel.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>

namespace ray {
namespace {

constexpr std::size_t kGrain = 1 << 16;

/// An end where the probe is flat: raised by curvature/2 ρ², so that lower paraboloids become planes.
struct LiftedEnd {
  PlanPoint point;
  double z = 0.0;  ///< m, as it was
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

  [[nodiscard]] Eigen::Vector3d vertex(const PlanPoint& point, double z) const {
    const Eigen::Vector2d place = steps_.place(point.x, point.y);
    return {place.x(), place.y(), z};
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
ConvexCeiling ceiling_of(const Context& context, std::vector<PlanPoint> few, std::size_t sides) {
  ConvexCeiling ceiling(sides);
  const auto hull = LowerHull::make(std::move(few));
  if (hull == nullptr) return ceiling;
  hull->insert_all(context);
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

/// Place on the curve of `insertion_order.h`, to a 65536th of each side.
std::uint32_t curve_of(const PlanPoint& point) {
  const std::uint64_t place = place_on_curve(std::array<std::uint32_t, 2>{
      static_cast<std::uint32_t>(point.x) * 2, static_cast<std::uint32_t>(point.y) * 2});
  return static_cast<std::uint32_t>(place >> (kPlaneCurveBits - 32));
}

struct LiftedEnds {
  std::vector<LiftedEnd> ends;
  std::vector<std::uint32_t> curve;  ///< place of each
};

/// Of at most `bounded` ends.
LiftedEnds below(const Context& context, RaySource& source, const Lift& lift, const ConvexCeiling& ceiling,
                 std::uint64_t bounded) {
  LiftedEnds all;
  // What grows is copied. But of a huge cloud most ends may be above the ceiling, and its memory is not ours.
  constexpr std::uint64_t kMostAtOnce = 1 << 22;
  const auto room = static_cast<std::size_t>(std::min(bounded, kMostAtOnce));
  all.ends.reserve(room);
  all.curve.reserve(room);
  stream(
      context, source, nullptr,
      [&](RayCloud& rays) {
        LiftedEnds found;
        for (std::size_t i = 0; i < rays.size(); ++i) {
          if (rays.bounded[i] == 0) continue;
          const LiftedEnd end = lift(rays.ends[i]);
          const double most = ceiling.at(share(end.point.x), share(end.point.y));
          if (static_cast<double>(end.point.height) > most) continue;
          found.ends.push_back(end);
          found.curve.push_back(curve_of(end.point));
        }
        return found;
      },
      [&](RayCloud&, const LiftedEnds& found) {
        all.ends.insert(all.ends.end(), found.ends.begin(), found.ends.end());
        all.curve.insert(all.curve.end(), found.curve.begin(), found.curve.end());
      });
  return all;
}

struct SortedEnds {
  std::vector<PlanPoint> points;
  std::vector<double> heights;  ///< m, as they were
};

/// Each near the one before, as the hull wants them; those at one place in the order of the rays.
SortedEnds along_curve(const Context& context, const LiftedEnds& lifted) {
  // The place above, the index below.
  std::vector<std::uint64_t> keys = touched_vector<std::uint64_t>(context, lifted.ends.size());
  for (std::size_t i = 0; i < keys.size(); ++i)
    keys[i] = std::uint64_t{lifted.curve[i]} << 32 | i;
  parallel_sort(context, keys.begin(), keys.end(), std::less<>());
  SortedEnds sorted;
  reserve_touched(context, sorted.points, keys.size() + 1);  // the hull adds one
  sorted.points.resize(keys.size());
  sorted.heights = touched_vector<double>(context, keys.size());
  parallel_for(context, keys.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const LiftedEnd& from = lifted.ends[static_cast<std::uint32_t>(keys[i])];
      sorted.points[i] = from.point;
      sorted.heights[i] = from.z;
    }
  });
  return sorted;
}

/// Of the ends, those that a face has; in their order.
std::vector<std::uint8_t> touched_ends(const Context& context, const std::vector<Mesh::Face>& faces,
                                       std::size_t ends) {
  std::vector<std::uint8_t> touched(ends, 0);
  parallel_for(context, faces.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t f = begin; f < end; ++f)
      for (const std::uint32_t vertex : faces[f])
        std::atomic_ref(touched[vertex]).store(1, std::memory_order_relaxed);
  });
  return touched;
}

Mesh mesh_of(const Context& context, const LowerHull& hull, const std::vector<double>& heights,
             const Lift& lift) {
  Mesh mesh;
  mesh.faces = hull.complex().finite_faces(context);
  const std::vector<std::uint8_t> touched = touched_ends(context, mesh.faces, heights.size());
  std::vector<std::uint32_t> number = touched_vector<std::uint32_t>(context, heights.size());
  std::exclusive_scan(touched.begin(), touched.end(), number.begin(), 0u);
  mesh.vertices = touched_vector<Eigen::Vector3d>(context, number.back() + std::size_t{touched.back()});
  parallel_for(context, heights.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      if (touched[i] != 0) mesh.vertices[number[i]] = lift.vertex(hull.points()[i], heights[i]);
  });
  parallel_for(context, mesh.faces.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t f = begin; f < end; ++f)
      for (std::uint32_t& vertex : mesh.faces[f])
        vertex = number[vertex];
  });
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
  const ConvexCeiling ceiling = ceiling_of(context, std::move(lowest), 2 * sides);
  SortedEnds ends = along_curve(context, below(context, source, lift, ceiling, survey.bounded));
  const auto hull = LowerHull::make_along_curve(std::move(ends.points));
  if (hull == nullptr) throw Error(ErrorCode::no_data, "all ends are on one line of the map");
  check_cancelled(context);
  hull->insert_all(context);
  return {.mesh = mesh_of(context, *hull, ends.heights, lift),
          .stream = survey.stream,
          .bounded = survey.bounded};
}

}  // namespace ray
