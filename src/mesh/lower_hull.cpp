#include "lower_hull.h"

#include "insertion_order.h"

namespace ray {
namespace {

std::vector<std::uint32_t> order_of_plan(const std::vector<PlanPoint>& points) {
  std::vector<std::array<std::uint32_t, 2>> places(points.size());
  for (std::size_t i = 0; i < points.size(); ++i)
    places[i] = {static_cast<std::uint32_t>(points[i].x) * 2, static_cast<std::uint32_t>(points[i].y) * 2};
  return insertion_order(places);
}

}  // namespace

std::unique_ptr<LowerHull> LowerHull::make(std::vector<PlanPoint> points) {
  std::vector<std::uint32_t> order = order_of_plan(points);
  return begin(std::unique_ptr<LowerHull>(new LowerHull(std::move(points), std::move(order))));
}

std::unique_ptr<LowerHull> LowerHull::make_along_curve(std::vector<PlanPoint> points) {
  std::vector<std::uint32_t> order = insertion_order_along_curve(points.size());
  return begin(std::unique_ptr<LowerHull>(new LowerHull(std::move(points), std::move(order))));
}

std::unique_ptr<LowerHull> LowerHull::begin(std::unique_ptr<LowerHull> hull) {
  if (!hull->find_first()) return nullptr;
  hull->points_.emplace_back();
  const auto infinity = static_cast<Index>(hull->points_.size());
  const auto [a, b, c] = hull->first_;
  hull->complex_.emplace(hull->geometry_, hull->points_.size() + 1, std::array<Index, 4>{a, b, c, infinity});
  return hull;
}

bool LowerHull::find_first() {
  std::size_t found = 0;
  for (const Index i : order_) {
    const PlanPoint& point = points_[i];
    if (found == 0) {
      first_[found++] = i;
    } else if (found == 1) {
      const PlanPoint& a = points_[first_[0]];
      if (point.x != a.x || point.y != a.y) first_[found++] = i;
    } else if (const std::int64_t turn = plan_turn(points_[first_[0]], points_[first_[1]], point);
               turn != 0) {
      first_[2] = i;
      if (turn < 0) std::swap(first_[1], first_[2]);
      return true;
    }
  }
  return false;
}

void LowerHull::insert_all(const Context& context) {
  complex_->make_room(context);
  for (const Index i : order_)
    complex_->insert(i);
}

std::optional<double> LowerHull::height_at(std::int64_t x, std::int64_t y) {
  const auto query = static_cast<Index>(points_.size() - 1);
  PlanPoint& p = points_[query];
  p = {x, y, 0};
  if (!complex_->is_alive(asked_)) asked_ = complex_->created().front();
  asked_ = complex_->locate(query, asked_);
  if (complex_->is_infinite(asked_)) return std::nullopt;
  const auto& vertices = complex_->face(asked_).vertices;
  const PlanPoint& a = points_[vertices[0]];
  const PlanPoint& b = points_[vertices[1]];
  const PlanPoint& c = points_[vertices[2]];
  const auto of_a = static_cast<double>(plan_turn(b, c, p));
  const auto of_b = static_cast<double>(plan_turn(c, a, p));
  const auto of_c = static_cast<double>(plan_turn(a, b, p));
  const auto height = [](const PlanPoint& point) { return static_cast<double>(point.height); };
  return (of_a * height(a) + of_b * height(b) + of_c * height(c)) / (of_a + of_b + of_c);
}

}  // namespace ray
