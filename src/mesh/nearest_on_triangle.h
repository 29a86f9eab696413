#pragma once
/// The place of a triangle that is nearest to a point.

#include <raycloud/core/mesh.h>

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <limits>
#include <utility>

namespace ray {

/// Which part of a face a place belongs to: its corner `i`, its side from corner `i - 3` to the next, or its
/// inside.
using FacePart = std::uint8_t;
inline constexpr FacePart kInside = 6;

struct NearestPlace {
  Eigen::Vector3d place = Eigen::Vector3d::Zero();
  double squared = std::numeric_limits<double>::infinity();  ///< distance
  FacePart part = kInside;
};

/// A triangle by itself.
struct Corners {
  std::array<Eigen::Vector3d, 3> at;
  Mesh::Face vertices{};
};

/// On the side from corner `i` to the next, computed from the vertex with the lower number to the other, so
/// that the faces on both sides of an edge find the same bits.
[[nodiscard]] inline NearestPlace nearest_on_side(const Eigen::Vector3d& point, const Corners& face,
                                                  std::size_t i) {
  std::size_t from = i;
  std::size_t to = (i + 1) % 3;
  if (face.vertices[to] < face.vertices[from]) std::swap(from, to);
  const Eigen::Vector3d along = face.at[to] - face.at[from];
  const double t = (point - face.at[from]).dot(along) / along.squaredNorm();
  NearestPlace nearest;
  if (!(t > 0.0)) {
    nearest.place = face.at[from];
    nearest.part = static_cast<FacePart>(from);
  } else if (!(t < 1.0)) {
    nearest.place = face.at[to];
    nearest.part = static_cast<FacePart>(to);
  } else {
    nearest.place = face.at[from] + t * along;
    nearest.part = static_cast<FacePart>(3 + i);
  }
  nearest.squared = (point - nearest.place).squaredNorm();
  return nearest;
}

/// The place within the face, if the point lies above or below it; else that of the sides that it lies
/// beyond. May give up, with an infinite distance, if the face is further than sqrt(bound). Precondition: the
/// face has an area.
[[nodiscard]] inline NearestPlace nearest_on_face(const Eigen::Vector3d& point, const Corners& face,
                                                  double bound) {
  const Eigen::Vector3d& a = face.at[0];
  const Eigen::Vector3d& b = face.at[1];
  const Eigen::Vector3d& c = face.at[2];
  const Eigen::Vector3d normal = (b - a).cross(c - a);
  const double squared_normal = normal.squaredNorm();
  const double height = normal.dot(point - a);
  const double squared_height = height * height / squared_normal;
  if (squared_height > bound) return {};
  const double beyond[3] = {normal.dot((b - a).cross(point - a)), normal.dot((c - b).cross(point - b)),
                            normal.dot((a - c).cross(point - c))};
  if (beyond[0] >= 0.0 && beyond[1] >= 0.0 && beyond[2] >= 0.0)
    return {point - height / squared_normal * normal, squared_height, kInside};
  NearestPlace nearest;
  for (std::size_t side = 0; side < 3; ++side) {
    if (beyond[side] >= 0.0) continue;
    const NearestPlace candidate = nearest_on_side(point, face, side);
    if (candidate.squared < nearest.squared) nearest = candidate;
  }
  return nearest;
}

}  // namespace ray
