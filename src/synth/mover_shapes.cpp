#include "mover_shapes.h"

#include "shapes.h"

namespace ray {

Mesh person_mesh() {
  constexpr std::size_t kSides = 10;
  MeshBuilder body;
  for (const double side : {-1.0, 1.0}) {
    const double step = 0.16 * side;  // one leg forward, the arm of the other side too
    body.tube({step, 0.1 * side, 0.0}, 0.055, {0.0, 0.09 * side, 0.86}, 0.09, kSides);
    body.box({step - 0.06, 0.1 * side - 0.045, 0.0}, {step + 0.18, 0.1 * side + 0.045, 0.07});
    body.tube({0.0, 0.21 * side, 1.42}, 0.05, {-1.3 * step, 0.26 * side, 0.82}, 0.04, kSides);
  }
  body.tube({0.0, 0.0, 0.82}, 0.15, {0.0, 0.0, 1.2}, 0.17, kSides);
  body.tube({0.0, 0.0, 1.2}, 0.17, {0.0, 0.0, 1.47}, 0.19, kSides);
  body.tube({0.0, 0.0, 1.47}, 0.06, {0.0, 0.0, 1.56}, 0.06, kSides);
  Mesh head = icosphere(2);
  for (Eigen::Vector3d& vertex : head.vertices)
    vertex = Eigen::Vector3d(0.11 * vertex.x(), 0.09 * vertex.y(), 1.63 + 0.13 * vertex.z());
  body.mesh(head);
  return body.take();
}

Mesh vehicle_mesh() {
  constexpr double kWheel = 0.32;  // m, radius
  MeshBuilder body;
  body.box({-2.1, -0.9, 0.3}, {2.1, 0.9, 0.85});
  body.hexahedron({{{-1.9, -0.85, 0.85},
                    {1.0, -0.85, 0.85},
                    {1.0, 0.85, 0.85},
                    {-1.9, 0.85, 0.85},
                    {-1.5, -0.7, 1.45},
                    {0.3, -0.7, 1.45},
                    {0.3, 0.7, 1.45},
                    {-1.5, 0.7, 1.45}}});
  for (const double x : {-1.35, 1.35}) {
    for (const double side : {-1.0, 1.0})
      body.tube({x, 0.72 * side, kWheel}, kWheel, {x, 0.93 * side, kWheel}, kWheel, 20);
  }
  return body.take();
}

}  // namespace ray
