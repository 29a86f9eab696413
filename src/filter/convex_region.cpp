#include "convex_region.h"

#include "ray_pieces.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace ray {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Where |d t + s| <= radius, for vectors; an empty interval if nowhere.
std::pair<double, double> within_sphere(const Eigen::Vector3d& s, const Eigen::Vector3d& d, double radius) {
  const double a = d.squaredNorm();
  if (a == 0.0) return s.norm() <= radius ? std::pair(-kInfinity, kInfinity) : std::pair(1.0, 0.0);
  // From the point of the line nearest to the centre: no difference of squares of large numbers.
  const double nearest = -s.dot(d) / a;
  const double distance = (s + nearest * d).norm();
  if (distance > radius) return {1.0, 0.0};
  const double half = std::sqrt((radius - distance) * (radius + distance) / a);
  return {nearest - half, nearest + half};
}

Eigen::Vector3d point_at(const Eigen::Vector3d& start, const Eigen::Vector3d& end, double t, int axis,
                         double at, Precision stored) {
  if (!(t > 0.0)) return start;
  if (!(t < 1.0)) return end;
  Eigen::Vector3d point = start + t * (end - start);
  if (axis >= 0) point[axis] = at;
  return cut_point(start, end, point, stored);
}

}  // namespace

Crossing HalfSpace::cross(const Eigen::Vector3d& start, const Eigen::Vector3d& end) const {
  // Relative to p, whose plane may be far away.
  const double from = (start - p).dot(p);
  const double to = (end - p).dot(p);
  if (from == to) return from <= 0.0 ? Crossing{-kInfinity, kInfinity} : Crossing{1.0, 0.0};
  const double t = from / (from - to);
  Crossing crossing =
      to > from ? Crossing{.enter = -kInfinity, .leave = t} : Crossing{.enter = t, .leave = kInfinity};
  for (int axis = 0; axis < 3; ++axis) {
    if (p[axis] != 0.0 && p[(axis + 1) % 3] == 0.0 && p[(axis + 2) % 3] == 0.0) {
      crossing.enter_axis = crossing.leave_axis = axis;
      crossing.enter_at = crossing.leave_at = p[axis];
    }
  }
  return crossing;
}

Crossing Box::cross(const Eigen::Vector3d& start, const Eigen::Vector3d& end) const {
  Crossing crossing{-kInfinity, kInfinity};
  for (int axis = 0; axis < 3; ++axis) {
    const double step = end[axis] - start[axis];
    if (step == 0.0) {
      if (start[axis] < low[axis] || start[axis] > high[axis]) return {1.0, 0.0};
      continue;
    }
    const double first = step > 0.0 ? low[axis] : high[axis];
    const double second = step > 0.0 ? high[axis] : low[axis];
    const double enter = (first - start[axis]) / step;
    const double leave = (second - start[axis]) / step;
    if (enter > crossing.enter) {
      crossing.enter = enter;
      crossing.enter_axis = axis;
      crossing.enter_at = first;
    }
    if (leave < crossing.leave) {
      crossing.leave = leave;
      crossing.leave_axis = axis;
      crossing.leave_at = second;
    }
  }
  return crossing;
}

bool Capsule::contains(const Eigen::Vector3d& x) const {
  const Eigen::Vector3d axis = b - a;
  const double squared = axis.squaredNorm();
  const double t = squared == 0.0 ? 0.0 : std::clamp((x - a).dot(axis) / squared, 0.0, 1.0);
  return (x - a - t * axis).squaredNorm() <= radius * radius;
}

Crossing Capsule::cross(const Eigen::Vector3d& start, const Eigen::Vector3d& end) const {
  // The capsule is convex, so the line's way through it is the hull of its ways through both balls and the
  // cylinder between them.
  const Eigen::Vector3d step = end - start;
  Crossing crossing{kInfinity, -kInfinity};
  const auto join = [&](double enter, double leave) {
    if (!(enter <= leave)) return;
    crossing.enter = std::min(crossing.enter, enter);
    crossing.leave = std::max(crossing.leave, leave);
  };
  const auto ball_a = within_sphere(start - a, step, radius);
  const auto ball_b = within_sphere(start - b, step, radius);
  join(ball_a.first, ball_a.second);
  join(ball_b.first, ball_b.second);
  const double length = (b - a).norm();
  if (length == 0.0) return crossing;
  const Eigen::Vector3d axis = (b - a) / length;
  const double along = (start - a).dot(axis);
  const double rise = step.dot(axis);
  auto [enter, leave] =
      within_sphere(Eigen::Vector3d(start - a - along * axis), Eigen::Vector3d(step - rise * axis), radius);
  if (rise != 0.0) {
    const double bottom = -along / rise;
    const double top = (length - along) / rise;
    enter = std::max(enter, std::min(bottom, top));
    leave = std::min(leave, std::max(bottom, top));
  } else if (along < 0.0 || along > length) {
    return crossing;
  }
  join(enter, leave);
  return crossing;
}

template <class Region>
std::uint32_t way_through(const Region& region, const Eigen::Vector3d& start, const Eigen::Vector3d& end,
                          Precision stored, std::vector<Stretch>& way) {
  way.clear();
  const bool starts_inside = region.contains(start);
  const bool ends_inside = region.contains(end);
  const std::uint32_t part = ends_inside ? 0 : 1;
  if ((starts_inside && ends_inside) || start == end) return part;
  const Crossing crossing = region.cross(start, end);
  const bool meets = crossing.enter < crossing.leave;
  // Where rounding hides the crossing of a ray that has one, it is at the end that is inside.
  const double enter = meets ? crossing.enter : 1.0;
  const double leave = meets ? crossing.leave : 0.0;
  const auto way_in = [&] {
    return point_at(start, end, enter, crossing.enter_axis, crossing.enter_at, stored);
  };
  const auto way_out = [&] {
    return point_at(start, end, leave, crossing.leave_axis, crossing.leave_at, stored);
  };
  if (starts_inside) {
    way = {{0, way_out()}, {1, end}};
  } else if (ends_inside) {
    way = {{1, way_in()}, {0, end}};
  } else if (meets && enter < 1.0 && leave > 0.0) {
    const Eigen::Vector3d first = way_in();
    const Eigen::Vector3d second = way_out();
    // What touches only, or crosses a corner too small for the precision, is not cut.
    if (first != second) way = {{1, first}, {0, second}, {1, end}};
  }
  return part;
}

template std::uint32_t way_through(const HalfSpace&, const Eigen::Vector3d&, const Eigen::Vector3d&,
                                   Precision, std::vector<Stretch>&);
template std::uint32_t way_through(const Box&, const Eigen::Vector3d&, const Eigen::Vector3d&, Precision,
                                   std::vector<Stretch>&);
template std::uint32_t way_through(const Capsule&, const Eigen::Vector3d&, const Eigen::Vector3d&, Precision,
                                   std::vector<Stretch>&);

}  // namespace ray
