#pragma once
/// The lower convex hull of points, seen from below: what a triangulation of their plan is (of Delaunay, if
/// their heights are the squared distances from one place; a regular one for other heights). Exact.

#include "hull_complex.h"

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

namespace ray {

/// A point in whole steps: x and y in [0, 2^30), height in [0, 2^62).
struct PlanPoint {
  std::int64_t x = 0;
  std::int64_t y = 0;
  std::int64_t height = 0;
};
inline constexpr std::int64_t kPlanSteps = std::int64_t{1} << 30;
inline constexpr std::int64_t kHeightSteps = std::int64_t{1} << 62;

/// Twice the signed area; above 0 if a, b, c are anticlockwise.
[[nodiscard]] inline std::int64_t plan_turn(const PlanPoint& a, const PlanPoint& b, const PlanPoint& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/// See HullComplex. "Outside" is below.
class PlanGeometry {
 public:
  static constexpr bool kInfinite = true;
  explicit PlanGeometry(const std::vector<PlanPoint>& points) : points_(points) {}
  [[nodiscard]] bool sees(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t p) const {
    return is_below(points_[a], points_[b], points_[c], points_[p]);
  }
  [[nodiscard]] bool passes(std::uint32_t a, std::uint32_t b, std::uint32_t p) const {
    return plan_turn(points_[a], points_[b], points_[p]) < 0;
  }
  /// Strictly below the plane of a, b and c, which are anticlockwise in plan.
  [[nodiscard]] static bool is_below(const PlanPoint& a, const PlanPoint& b, const PlanPoint& c,
                                     const PlanPoint& p) {
    __extension__ using Wide = __int128;  // 2^31 * 2^31 * 2 * 2^62 * 3 has 127 bits
    const std::int64_t ax = a.x - p.x, ay = a.y - p.y, bx = b.x - p.x, by = b.y - p.y, cx = c.x - p.x,
                       cy = c.y - p.y;
    const Wide sum = Wide{a.height - p.height} * (bx * cy - by * cx) +
                     Wide{b.height - p.height} * (cx * ay - cy * ax) +
                     Wide{c.height - p.height} * (ax * by - ay * bx);
    return sum > 0;
  }

 private:
  const std::vector<PlanPoint>& points_;
};

class LowerHull {
 public:
  using Index = HullComplex<PlanGeometry>::Index;

  /// Only three of the points are in it yet, until `insert_all` or the caller adds the others. Nothing if all
  /// lie on one line of the plan.
  [[nodiscard]] static std::unique_ptr<LowerHull> make(std::vector<PlanPoint> points);
  /// The same, of points each of which is near the one before (`insertion_order.h`): quicker, if they are
  /// many.
  [[nodiscard]] static std::unique_ptr<LowerHull> make_along_curve(std::vector<PlanPoint> points);
  LowerHull(const LowerHull&) = delete;
  LowerHull& operator=(const LowerHull&) = delete;

  /// About 1 µs a point. Of points at one place of the plan that are as low, the first counts.
  void insert_all(const Context& context);

  [[nodiscard]] HullComplex<PlanGeometry>& complex() { return *complex_; }
  [[nodiscard]] const HullComplex<PlanGeometry>& complex() const { return *complex_; }
  [[nodiscard]] const std::vector<PlanPoint>& points() const { return points_; }
  /// The three that it began with.
  [[nodiscard]] const std::array<Index, 3>& first() const { return first_; }

  /// Height of the hull there, in steps, to 2^-40 of the largest; nothing outside of its plan. Quick near
  /// the place asked for last. Not thread-safe.
  [[nodiscard]] std::optional<double> height_at(std::int64_t x, std::int64_t y);

 private:
  LowerHull(std::vector<PlanPoint> points, std::vector<std::uint32_t> order)
      : points_(std::move(points)), order_(std::move(order)) {}
  [[nodiscard]] static std::unique_ptr<LowerHull> begin(std::unique_ptr<LowerHull> hull);
  [[nodiscard]] bool find_first();

  std::vector<PlanPoint> points_;  ///< one more than were given, for the place asked for
  PlanGeometry geometry_{points_};
  std::vector<std::uint32_t> order_;
  std::array<Index, 3> first_{};
  std::optional<HullComplex<PlanGeometry>> complex_;
  Index asked_ = 0;
};

}  // namespace ray
