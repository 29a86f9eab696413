#pragma once
/// A small scene and a slow, plain intersector, for tests. Shares no code with the library.

#include <raycloud/synth/scene.h>

#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <optional>

namespace ray::test {

inline Mesh box_mesh(const Eigen::Vector3d& low, const Eigen::Vector3d& high) {
  Mesh mesh;
  for (int i = 0; i < 8; ++i)
    mesh.vertices.emplace_back(i & 1 ? high.x() : low.x(), i & 2 ? high.y() : low.y(),
                               i & 4 ? high.z() : low.z());
  mesh.faces = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return mesh;
}

inline SceneObject& add_object(Scene& scene, SceneLabel label, Mesh mesh) {
  SceneObject object;
  object.id = static_cast<std::int32_t>(scene.objects.size());
  object.label = label;
  object.name = label_name(label);
  object.mesh = std::move(mesh);
  scene.objects.push_back(std::move(object));
  return scene.objects.back();
}

/// 20 s around a box on a floor without walls, so that there is sky; a chest that arrives at 10 s, a crate
/// that leaves at 5 s, and a person that walks past and turns on the spot.
inline Scene small_scene() {
  Scene scene;
  scene.kind = "small";
  Mesh floor;
  floor.vertices = {{-12, -12, 0}, {12, -12, 0}, {12, 12, 0}, {-12, 12, 0}};
  floor.faces = {{0, 1, 2}, {0, 2, 3}};
  add_object(scene, SceneLabel::floor, floor);
  add_object(scene, SceneLabel::furniture, box_mesh({-1, -1, 0}, {1, 0.5, 1.2}));
  add_object(scene, SceneLabel::wall, box_mesh({6, -8, 0}, {6.1, 8, 3}));
  add_object(scene, SceneLabel::furniture, box_mesh({2, 3, 0}, {3, 4, 0.8})).present.first = 10.0;
  add_object(scene, SceneLabel::furniture, box_mesh({-4, 3, 0}, {-3, 4, 0.8})).present.second = 5.0;
  SceneObject& person = add_object(scene, SceneLabel::person, box_mesh({-0.3, -0.2, 0}, {0.3, 0.2, 1.8}));
  person.motion.times = {0, 10, 12, 20};
  person.motion.positions = {{-5, -6, 0}, {0, -5, 0}, {0, -5, 0}, {5, -6, 0}};
  for (const double half_turn : {0.0, 0.1, 0.5, 0.3})
    person.motion.orientations.emplace_back(std::cos(half_turn), 0.0, 0.0, std::sin(half_turn));
  scene.path.times = {0, 5, 10, 15, 20};
  scene.path.positions = {{3, 0, 1.5}, {0, 2.5, 1.4}, {-3, 0, 1.5}, {0, -2.5, 1.6}, {3, 0, 1.5}};
  scene.stations = {{4, 4, 1.7}, {-4, -4, 1.7}, {-4, 5, 1.7}};
  return scene;
}

struct SlowHit {
  double range = std::numeric_limits<double>::infinity();
  std::size_t object = 0;
  double margin = 0.0;  ///< how far inside its triangle, as a barycentric coordinate
};

/// Möller and Trumbore in long double, triangle after triangle. The object must stand still.
inline SlowHit slow_cast_mesh(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
                              const Mesh& mesh) {
  using Vector = Eigen::Matrix<long double, 3, 1>;
  SlowHit best;
  const Vector from = origin.cast<long double>();
  const Vector along = direction.cast<long double>();
  for (const Mesh::Face& face : mesh.faces) {
    const Vector a = mesh.vertices[face[0]].cast<long double>();
    const Vector e1 = mesh.vertices[face[1]].cast<long double>() - a;
    const Vector e2 = mesh.vertices[face[2]].cast<long double>() - a;
    const Vector p = along.cross(e2);
    const long double det = e1.dot(p);
    if (det == 0) continue;
    const Vector s = from - a;
    const long double u = s.dot(p) / det;
    const Vector q = s.cross(e1);
    const long double v = along.dot(q) / det;
    const long double t = e2.dot(q) / det;
    if (u < 0 || v < 0 || u + v > 1 || t <= 0 || t >= best.range) continue;
    best.range = static_cast<double>(t);
    best.margin = static_cast<double>(std::min({u, v, 1 - u - v}));
  }
  return best;
}

/// Slerp of Eigen where the library has its own way.
inline SlowHit slow_cast(const Scene& scene, const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
                         double time) {
  SlowHit best;
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    const SceneObject& object = scene.objects[i];
    if (time < object.present.first || time >= object.present.second) continue;
    Mesh mesh = object.mesh;
    if (!object.motion.empty()) {
      const TrajectorySpot spot = spot_at(object.motion, time);
      const Eigen::Quaterniond turn = orientation_at(object.motion, spot);
      for (Eigen::Vector3d& vertex : mesh.vertices)
        vertex = turn * vertex + position_at(object.motion, spot);
    }
    SlowHit hit = slow_cast_mesh(origin, direction, mesh);
    if (hit.range < best.range) {
      best = hit;
      best.object = i;
    }
  }
  return best;
}

}  // namespace ray::test
