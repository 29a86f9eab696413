#include "space_hull.h"

#include "insertion_order.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace ray {
namespace {

std::vector<std::uint32_t> order_of_space(const std::vector<SpacePoint>& points) {
  std::vector<std::array<std::uint32_t, 3>> places(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (std::size_t axis = 0; axis < 3; ++axis)
      places[i][axis] = static_cast<std::uint32_t>(
          std::min((points[i][axis] + kSpaceSteps) >> 6, std::int64_t{0x7FFFFFFF}));
  }
  return insertion_order(places);
}

/// On a line, exactly.
bool are_collinear(const SpacePoint& a, const SpacePoint& b, const SpacePoint& c) {
  __extension__ using Wide = __int128;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3;
    if (Wide{b[i] - a[i]} * (c[j] - a[j]) != Wide{b[j] - a[j]} * (c[i] - a[i])) return false;
  }
  return true;
}

Eigen::Vector3d in_double(const SpacePoint& point) {
  return {static_cast<double>(point[0]), static_cast<double>(point[1]), static_cast<double>(point[2])};
}

}  // namespace

std::unique_ptr<SpaceHull> SpaceHull::make(std::vector<SpacePoint> points) {
  std::unique_ptr<SpaceHull> hull(new SpaceHull(std::move(points)));
  const std::vector<std::uint32_t> order = order_of_space(hull->points_);
  const auto first = hull->find_first(order);
  if (!first) return nullptr;
  SpacePoint sum{};
  for (const Index i : *first) {
    for (std::size_t axis = 0; axis < 3; ++axis)
      sum[axis] += hull->points_[i][axis];
  }
  hull->geometry_.set_inside(sum);
  hull->points_.emplace_back();
  hull->complex_.emplace(hull->geometry_, hull->points_.size(), *first);
  for (const Index i : order)
    hull->complex_->insert(i);
  return hull;
}

std::optional<std::array<SpaceHull::Index, 4>> SpaceHull::find_first(
    const std::vector<std::uint32_t>& order) const {
  std::array<Index, 4> first{};
  std::size_t found = 0;
  for (const Index i : order) {
    if (found == 0) {
      first[found++] = i;
    } else if (found == 1) {
      if (points_[i] != points_[first[0]]) first[found++] = i;
    } else if (found == 2) {
      if (!are_collinear(points_[first[0]], points_[first[1]], points_[i])) first[found++] = i;
    } else if (const int volume = geometry_.volume(first[0], first[1], first[2], i); volume != 0) {
      first[3] = i;
      if (volume > 0) std::swap(first[1], first[2]);  // the fourth is behind the others
      return first;
    }
  }
  return std::nullopt;
}

bool SpaceHull::holds(const SpacePoint& place) {
  const auto query = static_cast<Index>(points_.size() - 1);
  points_[query] = place;
  const std::vector<Mesh::Face> faces = complex_->finite_faces();
  return std::all_of(faces.begin(), faces.end(), [&](const Mesh::Face& face) {
    return geometry_.volume(face[0], face[1], face[2], query) < 0;
  });
}

double SpaceHull::gauge(const Eigen::Vector3d& direction) {
  const auto query = static_cast<Index>(points_.size() - 1);
  const Eigen::Vector3d place = inside() + direction;
  for (int axis = 0; axis < 3; ++axis)
    points_[query][static_cast<std::size_t>(axis)] = std::llround(place[axis]);
  if (!complex_->is_alive(asked_)) asked_ = complex_->created().front();
  asked_ = complex_->locate(query, asked_);
  const auto& vertices = complex_->face(asked_).vertices;
  const Eigen::Vector3d a = in_double(points_[vertices[0]]);
  const Eigen::Vector3d normal =
      (in_double(points_[vertices[1]]) - a).cross(in_double(points_[vertices[2]]) - a);
  return normal.dot(in_double(points_[query]) - inside()) / normal.dot(a - inside());
}

}  // namespace ray
