#include "greedy_mesh.h"

#include "insertion_order.h"
#include "lower_hull.h"
#include "plan_steps.h"

#include <raycloud/exec/parallel.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

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
    hull_ = LowerHull::make_along_curve(std::move(places));  // only its first three are used of the order
    if (hull_ == nullptr) return {};
    begin(begin_with);
    while (!queue_.is_empty()) {
      const Worst worst = queue_.pop();
      if (waiting_[worst.face].stamp == worst.stamp) add(worst);
    }
    return mesh();
  }

 private:
  static constexpr Index kDone = std::numeric_limits<Index>::max();
  /// Points over a face that are not in the mesh: the first, and each one's next in `next_`.
  struct Waiting {
    Index first = kDone;
    std::uint64_t stamp = 0;  ///< of the face that is there now
  };
  struct Worst {
    double error = 0.0;
    Index point = 0;
    Index face = 0;
    std::uint64_t stamp = 0;
  };

  /// Gives back the worst, to a factor of two; of these the one that came last, as it is near the one before.
  class WorstFirst {
   public:
    void push(const Worst& worst) {
      const std::size_t at =
          static_cast<std::size_t>(std::clamp(std::ilogb(worst.error) + 30, 0, kOctaves - 1));
      octaves_[at].push_back(worst);
      highest_ = std::max(highest_, at);
    }
    [[nodiscard]] bool is_empty() {
      while (highest_ > 0 && octaves_[highest_].empty())
        --highest_;
      return octaves_[highest_].empty();
    }
    /// Precondition: not empty, as is_empty() has said after the last push.
    Worst pop() {
      const Worst worst = octaves_[highest_].back();
      octaves_[highest_].pop_back();
      return worst;
    }

   private:
    static constexpr int kOctaves = 64;
    std::array<std::vector<Worst>, kOctaves> octaves_;
    std::size_t highest_ = 0;
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
    next_.assign(points_.size(), kDone);
    for (Index i = 0; i < points_.size(); ++i)
      if (face_of[i] != kDone) put_over(face_of[i], i);
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

  void put_over(Index face, Index point) {
    next_[point] = waiting_[face].first;
    waiting_[face].first = point;
  }

  /// Moves the points over a face to loose_, but for one.
  void take_from(Index face, Index but_for) {
    for (Index point = waiting_[face].first; point != kDone; point = next_[point]) {
      if (point == but_for) continue;
      // distribute() will look at all of them.
      __builtin_prefetch(&hull_->points()[point]);
      __builtin_prefetch(&points_[point].z());
      loose_.push_back(point);
    }
    waiting_[face] = {kDone, ++stamp_};
  }

  void add(const Worst& worst) {
    loose_.clear();
    if (!hull_->complex().insert(worst.point, worst.face)) {
      // Another one is at its place.
      take_from(worst.face, worst.point);
      for (const Index point : loose_)
        put_over(worst.face, point);
      find_worst(worst.face);
      return;
    }
    for (const Index face : hull_->complex().removed())
      take_from(face, worst.point);
    waiting_.resize(hull_->complex().places());
    distribute();
  }

  /// What is loose, among the faces that were created last.
  void distribute() {
    const auto created = hull_->complex().created();
    for (const Index face : created)
      waiting_[face].stamp = ++stamp_;
    Index near = created.front();
    for (const Index point : loose_) {
      near = hull_->complex().locate(point, near);
      put_over(near, point);
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
    if (waiting_[face].first == kDone) return worst;
    const FacePlane plane = outside ? FacePlane{} : plane_of(a, b, c);
    for (Index point = waiting_[face].first; point != kDone; point = next_[point]) {
      // Beyond the border come first, the furthest of each side before others.
      const double error = outside ? 1e30 + static_cast<double>(turn(a, b, point))
                                   : std::abs(plane.height_above(place_of(point)));
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

  /// Steps in plan, and the height.
  [[nodiscard]] Eigen::Vector3d place_of(Index point) const {
    const PlanPoint& place = hull_->points()[point];
    return {static_cast<double>(place.x), static_cast<double>(place.y), points_[point].z()};
  }

  struct FacePlane {
    Eigen::Vector3d corner = Eigen::Vector3d::Zero();
    Eigen::Vector2d slope = Eigen::Vector2d::Zero();
    [[nodiscard]] double height_above(const Eigen::Vector3d& place) const {
      const Eigen::Vector3d away = place - corner;
      return away.z() - slope.dot(away.head<2>());
    }
  };
  [[nodiscard]] FacePlane plane_of(Index a, Index b, Index c) const {
    const Eigen::Vector3d corner = place_of(a);
    const Eigen::Vector3d u = place_of(b) - corner;
    const Eigen::Vector3d v = place_of(c) - corner;
    const auto area = static_cast<double>(turn(a, b, c));  // exact, as a face at the border may be thin
    return {corner, {(u.z() * v.y() - u.y() * v.z()) / area, (u.x() * v.z() - u.z() * v.x()) / area}};
  }

  [[nodiscard]] Mesh mesh() const {
    Mesh mesh;
    mesh.faces = hull_->complex().finite_faces(context_);
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
  std::vector<Index> next_;       ///< of each point
  std::vector<Index> loose_;
  std::uint64_t stamp_ = 0;
  WorstFirst queue_;
};

}  // namespace

Mesh greedy_mesh(const Context& context, const std::vector<Eigen::Vector3d>& points, double tolerance,
                 const std::vector<std::uint32_t>& begin_with) {
  if (points.size() < 3) return {};
  return GreedyMesh(context, points, tolerance).run(begin_with);
}

}  // namespace ray
