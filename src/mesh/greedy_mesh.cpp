#include "greedy_mesh.h"

#include "insertion_order.h"
#include "lower_hull.h"
#include "plan_steps.h"

#include <raycloud/exec/parallel.h>

#include <cmath>
#include <limits>
#include <queue>
#include <tuple>

namespace ray {
namespace {

class GreedyMesh {
 public:
  using Index = LowerHull::Index;

  GreedyMesh(const Context& context, const std::vector<Eigen::Vector3d>& points, double tolerance)
      : context_(context), points_(points), tolerance_(tolerance), steps_(bounds_of(points)) {}

  Mesh run(const std::vector<Index>& begin_with) {
    std::vector<PlanPoint> places;
    places.reserve(points_.size() + 1);
    for (const Eigen::Vector3d& point : points_) {
      const std::int64_t x = steps_.x(point.x());
      const std::int64_t y = steps_.y(point.y());
      places.push_back({x, y, x * x + y * y});
    }
    hull_ = LowerHull::make(std::move(places));
    if (hull_ == nullptr) return {};
    begin(begin_with);
    while (!queue_.empty()) {
      const Worst worst = queue_.top();
      queue_.pop();
      if (waiting_[worst.face].stamp == worst.stamp) add(worst);
    }
    return mesh();
  }

 private:
  static constexpr Index kDone = std::numeric_limits<Index>::max();
  struct Waiting {
    std::vector<Index> points;  ///< over the face, not in the mesh
    std::uint64_t stamp = 0;    ///< of the face that is there now
  };
  struct Worst {
    double error = 0.0;
    Index point = 0;
    Index face = 0;
    std::uint64_t stamp = 0;
    friend bool operator<(const Worst& a, const Worst& b) {
      return std::tie(a.error, b.point) < std::tie(b.error, a.point);
    }
  };

  static Bounds bounds_of(const std::vector<Eigen::Vector3d>& points) {
    Bounds bounds;
    for (const Eigen::Vector3d& point : points)
      bounds.add(point);
    return bounds;
  }

  /// Inserts these, and sorts the others by the faces they are over.
  void begin(const std::vector<Index>& begin_with) {
    std::vector<std::uint8_t> is_in(points_.size(), 0);
    for (const Index i : hull_->first())
      is_in[i] = 1;
    for (const Index i : insertion_order_of(begin_with)) {
      if (is_in[i] == 0) hull_->complex().insert(i);
      is_in[i] = 1;
    }
    const auto& complex = hull_->complex();
    waiting_.resize(complex.places());
    std::vector<Index> face_of(points_.size(), kDone);
    parallel_for(context_, points_.size(), 8192, [&](std::size_t first, std::size_t last) {
      Index near = complex.created().front();
      for (std::size_t i = first; i < last; ++i)
        if (is_in[i] == 0) near = face_of[i] = complex.locate(static_cast<Index>(i), near);
    });
    for (Index i = 0; i < points_.size(); ++i)
      if (face_of[i] != kDone) waiting_[face_of[i]].points.push_back(i);
    std::vector<Worst> worst(waiting_.size());
    parallel_for(context_, waiting_.size(), 4096, [&](std::size_t first, std::size_t last) {
      for (std::size_t face = first; face < last; ++face)
        worst[face] = worst_over(static_cast<Index>(face));
    });
    for (const Worst& one : worst)
      if (one.point != kDone) queue_.push(one);
  }

  [[nodiscard]] std::vector<Index> insertion_order_of(const std::vector<Index>& some) const {
    std::vector<std::array<std::uint32_t, 2>> places;
    places.reserve(some.size());
    for (const Index i : some)
      places.push_back({static_cast<std::uint32_t>(hull_->points()[i].x),
                        static_cast<std::uint32_t>(hull_->points()[i].y)});
    std::vector<Index> order = insertion_order(places);
    for (Index& i : order)
      i = some[i];
    return order;
  }

  void add(const Worst& worst) {
    std::vector<Index> loose;
    if (!hull_->complex().insert(worst.point, worst.face)) {
      // Another one is at its place.
      loose = std::move(waiting_[worst.face].points);
      std::erase(loose, worst.point);
      waiting_[worst.face] = {{}, ++stamp_};
      for (const Index point : loose)
        waiting_[worst.face].points.push_back(point);
      find_worst(worst.face);
      return;
    }
    for (const Index face : hull_->complex().removed()) {
      std::vector<Index>& points = waiting_[face].points;
      loose.insert(loose.end(), points.begin(), points.end());
      waiting_[face] = {{}, ++stamp_};
    }
    std::erase(loose, worst.point);
    waiting_.resize(hull_->complex().places());
    distribute(loose);
  }

  /// Among the faces that were created last.
  void distribute(const std::vector<Index>& loose) {
    const auto created = hull_->complex().created();
    for (const Index face : created)
      waiting_[face].stamp = ++stamp_;
    Index near = created.front();
    for (const Index point : loose) {
      near = hull_->complex().locate(point, near);
      waiting_[near].points.push_back(point);
    }
    for (const Index face : created)
      find_worst(face);
  }

  void find_worst(Index face) {
    const Worst worst = worst_over(face);
    if (worst.point != kDone) queue_.push(worst);
  }

  /// The one to be added, kDone if there is none.
  [[nodiscard]] Worst worst_over(Index face) const {
    const auto& [a, b, c] = hull_->complex().face(face).vertices;
    const bool outside = hull_->complex().is_infinite(face);
    Worst worst{0.0, kDone, face, waiting_[face].stamp};
    for (const Index point : waiting_[face].points) {
      // Beyond the border come first, the furthest of each side before others.
      const double error = outside ? 1e30 + static_cast<double>(turn(a, b, point)) : error_of(a, b, c, point);
      if (error > worst.error || (error == worst.error && point < worst.point)) {
        worst.error = error;
        worst.point = point;
      }
    }
    if (!outside && !(worst.error > tolerance_)) worst.point = kDone;
    return worst;
  }

  [[nodiscard]] std::int64_t turn(Index a, Index b, Index c) const {
    const auto& places = hull_->points();
    return plan_turn(places[a], places[b], places[c]);
  }

  [[nodiscard]] double error_of(Index a, Index b, Index c, Index p) const {
    const auto of_a = static_cast<double>(turn(b, c, p));
    const auto of_b = static_cast<double>(turn(c, a, p));
    const auto of_c = static_cast<double>(turn(a, b, p));
    const double z =
        (of_a * points_[a].z() + of_b * points_[b].z() + of_c * points_[c].z()) / (of_a + of_b + of_c);
    return std::abs(points_[p].z() - z);
  }

  [[nodiscard]] Mesh mesh() const {
    Mesh mesh;
    mesh.faces = hull_->complex().finite_faces();
    std::vector<Index> number(points_.size(), kDone);
    for (Mesh::Face& face : mesh.faces) {
      for (std::uint32_t& vertex : face) {
        if (number[vertex] == kDone) {
          number[vertex] = static_cast<Index>(mesh.vertices.size());
          const PlanPoint& place = hull_->points()[vertex];
          const Eigen::Vector2d plan = steps_.place(place.x, place.y);
          mesh.vertices.emplace_back(plan.x(), plan.y(), points_[vertex].z());
        }
        vertex = number[vertex];
      }
    }
    return mesh;
  }

  const Context& context_;
  const std::vector<Eigen::Vector3d>& points_;
  double tolerance_;
  PlanSteps steps_;
  std::unique_ptr<LowerHull> hull_;
  std::vector<Waiting> waiting_;  ///< of each place of a face
  std::uint64_t stamp_ = 0;
  std::priority_queue<Worst> queue_;
};

}  // namespace

Mesh greedy_mesh(const Context& context, const std::vector<Eigen::Vector3d>& points, double tolerance,
                 const std::vector<std::uint32_t>& begin_with) {
  if (points.size() < 3) return {};
  return GreedyMesh(context, points, tolerance).run(begin_with);
}

}  // namespace ray
