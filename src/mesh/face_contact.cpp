#include "face_contact.h"

#include "exact_turns.h"

#include <algorithm>
#include <utility>
#include <vector>

namespace ray {
namespace {

using Corner = Eigen::Vector3d;
using PlanCorner = Eigen::Vector2d;
using PlanTriangle = std::array<PlanCorner, 3>;

/// As seen along an axis.
PlanCorner seen_along(const Corner& corner, int axis) {
  return {corner[(axis + 1) % 3], corner[(axis + 2) % 3]};
}

PlanTriangle seen_along(const TriangleCorners& corners, int axis) {
  return {seen_along(corners[0], axis), seen_along(corners[1], axis), seen_along(corners[2], axis)};
}

int turn_of(const PlanTriangle& corners) {
  return turn_in_plan(corners[0], corners[1], corners[2]);
}

/// An axis along which the triangle is not seen as a line, or -1.
int open_axis(const TriangleCorners& corners) {
  for (int axis = 0; axis < 3; ++axis)
    if (turn_of(seen_along(corners, axis)) != 0) return axis;
  return -1;
}

bool is_between(const PlanCorner& p, const PlanCorner& a, const PlanCorner& b) {  // on the line of a and b
  return (p.cwiseMin(a.cwiseMax(b)) == p) && (p.cwiseMax(a.cwiseMin(b)) == p);
}

bool segments_meet(const PlanCorner& p, const PlanCorner& q, const PlanCorner& a, const PlanCorner& b) {
  const int of_a = turn_in_plan(p, q, a), of_b = turn_in_plan(p, q, b);
  const int of_p = turn_in_plan(a, b, p), of_q = turn_in_plan(a, b, q);
  if (of_a * of_b < 0 && of_p * of_q < 0) return true;
  return (of_a == 0 && is_between(a, p, q)) || (of_b == 0 && is_between(b, p, q)) ||
         (of_p == 0 && is_between(p, a, b)) || (of_q == 0 && is_between(q, a, b));
}

bool is_in_triangle(const PlanCorner& p, const PlanTriangle& t) {
  const int turn = turn_of(t);
  for (std::size_t i = 0; i < 3; ++i)
    if (turn_in_plan(t[i], t[(i + 1) % 3], p) * turn < 0) return false;
  return true;
}

/// Whether the segment and the triangle have a place in common, borders included.
bool segment_meets(const Corner& p, const Corner& q, const TriangleCorners& t) {
  const int of_p = turn_in_space(t[0], t[1], t[2], p);
  const int of_q = turn_in_space(t[0], t[1], t[2], q);
  if (of_p * of_q > 0) return false;
  if (of_p == 0 && of_q == 0) {
    const int axis = open_axis(t);
    const PlanTriangle plan = seen_along(t, axis);
    const PlanCorner from = seen_along(p, axis), to = seen_along(q, axis);
    if (is_in_triangle(from, plan) || is_in_triangle(to, plan)) return true;
    for (std::size_t i = 0; i < 3; ++i)
      if (segments_meet(from, to, plan[i], plan[(i + 1) % 3])) return true;
    return false;
  }
  // The segment ends in the plane or goes through it, at one place: inside if all sides turn alike about it.
  bool left = false, right = false;
  for (std::size_t i = 0; i < 3; ++i) {
    const int turn = turn_in_space(p, q, t[i], t[(i + 1) % 3]);
    left = left || turn > 0;
    right = right || turn < 0;
  }
  return !(left && right);
}

}  // namespace

bool has_exact_area(const TriangleCorners& corners) {
  return open_axis(corners) >= 0;
}

bool meet_beyond_shared(const TriangleCorners& a, const TriangleCorners& b) {
  std::vector<std::pair<std::size_t, std::size_t>> shared;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j)
      if (a[i] == b[j]) shared.emplace_back(i, j);
  }
  if (shared.size() == 3) return true;
  if (shared.size() == 2) {  // they overlap if they are in one plane on one side of the edge, and only then
    const std::size_t i = 3 - shared[0].first - shared[1].first;
    const std::size_t j = 3 - shared[0].second - shared[1].second;
    if (turn_in_space(a[0], a[1], a[2], b[j]) != 0) return false;
    const int axis = open_axis(a);
    const PlanTriangle plan = seen_along(a, axis);
    const PlanCorner other = seen_along(b[j], axis);
    const PlanCorner& from = plan[(i + 1) % 3];
    const PlanCorner& to = plan[(i + 2) % 3];
    return turn_in_plan(from, to, plan[i]) == turn_in_plan(from, to, other);
  }
  if (shared.size() == 1) {
    // Where they meet is convex and begins at the corner, so it ends on one of the sides opposite.
    const auto [i, j] = shared.front();
    return segment_meets(a[(i + 1) % 3], a[(i + 2) % 3], b) ||
           segment_meets(b[(j + 1) % 3], b[(j + 2) % 3], a);
  }
  for (std::size_t i = 0; i < 3; ++i) {
    if (segment_meets(a[i], a[(i + 1) % 3], b) || segment_meets(b[i], b[(i + 1) % 3], a)) return true;
  }
  return false;
}

}  // namespace ray
