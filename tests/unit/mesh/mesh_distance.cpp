// The distance from a mesh against a slow oracle that shares no code with it: the nearest of densely refined
// places, and the side by the solid angle under which all faces are seen.
#include "shapes.h"

#include <raycloud/core/error.h>
#include <raycloud/mesh/mesh_distance.h>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <Eigen/LU>
#include <Eigen/QR>
#include <algorithm>

namespace ray {
namespace {

using namespace test;
using Vector = Eigen::Vector3d;

/// min |p - a - s u - t v| over s, t >= 0, s + t <= 1, by the conditions of Karush, Kuhn and Tucker: each of
/// the seven sets of active constraints is solved, and the best feasible solution is the minimum.
double slow_distance_to_face(const Vector& p, const Vector& a, const Vector& b, const Vector& c) {
  const Vector u = b - a, v = c - a;
  double best = std::min({(p - a).norm(), (p - b).norm(), (p - c).norm()});
  const auto on_line = [&](const Vector& from, const Vector& to) {
    const double t = (p - from).dot(to - from) / (to - from).squaredNorm();
    if (t > 0 && t < 1) best = std::min(best, (p - from - t * (to - from)).norm());
  };
  on_line(a, b), on_line(b, c), on_line(c, a);
  Eigen::Matrix<double, 3, 2> basis;
  basis << u, v;
  const Eigen::Vector2d st = basis.colPivHouseholderQr().solve(p - a);
  if (st.x() > 0 && st.y() > 0 && st.sum() < 1) best = std::min(best, (p - a - basis * st).norm());
  return best;
}

double slow_distance(const Vector& p, const Mesh& mesh) {
  double best = std::numeric_limits<double>::infinity();
  for (const auto& [a, b, c] : mesh.faces)
    best = std::min(best, slow_distance_to_face(p, mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]));
  return best;
}

/// 1 inside and 0 outside of a closed mesh (van Oosterom and Strackee's solid angle of a triangle).
double winding(const Vector& p, const Mesh& mesh) {
  double sum = 0;
  for (const auto& face : mesh.faces) {
    const Vector a = mesh.vertices[face[0]] - p, b = mesh.vertices[face[1]] - p,
                 c = mesh.vertices[face[2]] - p;
    const double la = a.norm(), lb = b.norm(), lc = c.norm();
    sum += 2 * std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
  }
  return sum / (4 * M_PI);
}

/// Places around a mesh, most of them near its vertices and edges, where signs go wrong.
std::vector<Vector> places_near(const Mesh& mesh, const RandomStream& random, std::size_t count) {
  std::vector<Vector> places;
  for (std::uint64_t i = 0; i < count; ++i) {
    const auto& face = mesh.faces[random.below(mesh.faces.size(), i, 10)];
    const Vector& a = mesh.vertices[face[0]];
    const Vector& b = mesh.vertices[face[1]];
    const double near = i % 3 == 0 ? 3.0 : 0.02;
    places.push_back((i % 2 == 0 ? a : (a + random.uniform(i, 11) * (b - a)).eval()) +
                     random_place(random, i, near));
  }
  return places;
}

RC_GTEST_PROP(MeshDistance, IsThatOfASlowOracleAroundClosedMeshes, ()) {
  const RandomStream random(*rc::gen::arbitrary<std::uint64_t>(), "dents");
  const Vector away = *rc::gen::element(Vector(0, 0, 0), Vector(5e5, 5e6, 100));
  std::uint64_t drawn = 0;
  Mesh mesh = sphere_shape(2, [&](const Vector&) { return 0.4 + 2 * random.uniform(++drawn, 20); });
  for (Vector& vertex : mesh.vertices)
    vertex += away;
  // Fronts inside, single faces and some of them turned make no difference.
  Mesh given = *rc::gen::arbitrary<bool>() ? unwelded(mesh) : mesh;
  for (std::size_t f = 0; f < given.faces.size(); f += *rc::gen::inRange(1, 3))
    std::swap(given.faces[f][0], given.faces[f][1]);
  const MeshDistance distance(given);
  RC_ASSERT(distance.topology().is_sphere());
  const std::vector<Vector> places = places_near(mesh, random, 50);
  const std::vector<double> found = distance.at(places);
  for (std::size_t i = 0; i < places.size(); ++i) {
    const double slow = slow_distance(places[i], mesh);
    RC_ASSERT(std::abs(std::abs(found[i]) - slow) < 1e-12 + 1e-15 * away.norm());
    if (slow > 1e-6) RC_ASSERT((found[i] < 0) == (winding(places[i], mesh) > 0.5));
    RC_ASSERT(found[i] == distance.at(places[i]));  // whatever came before
  }
  for (const double limit : {-0.5, -0.01, 0.0, 0.01, 0.5, found[7]}) {
    std::vector<std::uint8_t> beyond(places.size());
    distance.are_beyond(places, limit, beyond);
    for (std::size_t i = 0; i < places.size(); ++i)
      RC_ASSERT((beyond[i] == 1) == (found[i] > limit));
  }
}

TEST(MeshDistance, IsPositiveAboveAGroundWhicheverWayItsFacesLook) {
  const RandomStream random(3, "ground");
  Mesh ground = ground_shape(12, [&](int x, int y) { return random.uniform(x, y); });
  for (const bool turned : {false, true}) {
    if (turned) {
      for (auto& face : ground.faces)
        std::swap(face[0], face[1]);
    }
    const MeshDistance distance(ground);
    for (std::uint64_t i = 0; i < 300; ++i) {
      const Vector place(3 + 5 * random.uniform(i, 50), 3 + 5 * random.uniform(i, 51), 0);
      EXPECT_GT(distance.at(place + Vector(0, 0, 1.01)), 0);
      EXPECT_LT(distance.at(place - Vector(0, 0, 0.01)), 0);
    }
    // Beside it, the plane of the rim goes on.
    const MeshDistance flat(ground_shape(3, [](int, int) { return 0; }));
    EXPECT_EQ(flat.at({-3, 1, 4}), 5);
    EXPECT_EQ(flat.at({-3, 1, -4}), -5);
    EXPECT_EQ(flat.at({1, 1, 0}), 0);
  }
}

RC_GTEST_PROP(MeshDistance, OverAGroundIsThatOfASlowOracle, ()) {
  // Above or below, near it and far, over it and beside: also where the ground is not convex in plan.
  const RandomStream random(*rc::gen::arbitrary<std::uint64_t>(), "grounds");
  const Vector away = *rc::gen::element(Vector(0, 0, 0), Vector(5e5, 5e6, 100));
  Mesh ground = ground_shape(5, [&](int x, int y) { return 2 * random.uniform(x, y); });
  if (*rc::gen::arbitrary<bool>()) ground.faces.erase(ground.faces.begin(), ground.faces.begin() + 2);
  for (Vector& vertex : ground.vertices)
    vertex += away;
  const MeshDistance distance(ground);
  std::vector<Vector> places = places_near(ground, random, 40);
  for (std::size_t i = 0; i < places.size(); i += 4)
    places[i] += Vector(0, 0, 30 * (random.uniform(i, 30) - 0.5));
  const std::vector<double> found = distance.at(places);
  const double rounding = 1e-12 + 1e-15 * away.norm();
  for (std::size_t i = 0; i < places.size(); ++i) {
    const double slow = slow_distance(places[i], ground);
    RC_ASSERT(std::abs(std::abs(found[i]) - slow) < rounding);
    // Straight above or below a face the side is plain.
    for (const auto& [a, b, c] : ground.faces) {
      const Vector &u = ground.vertices[a], &v = ground.vertices[b], &w = ground.vertices[c];
      Eigen::Matrix3d corners;
      corners << u, v, w;
      corners.row(2).setOnes();
      const Vector weights = corners.fullPivLu().solve(Vector(places[i].x(), places[i].y(), 1));
      const double height = weights.dot(Vector(u.z(), v.z(), w.z()));
      if (away.norm() == 0 && weights.minCoeff() > 1e-6 && std::abs(places[i].z() - height) > 1e-6)
        RC_ASSERT((found[i] > 0) == (places[i].z() > height));
    }
  }
  for (const double limit : {-0.5, -0.01, 0.0, 0.01, 0.5, found[7], 1e9}) {
    std::vector<std::uint8_t> beyond(places.size());
    distance.are_beyond(places, limit, beyond);
    for (std::size_t i = 0; i < places.size(); ++i)
      RC_ASSERT((beyond[i] == 1) == (found[i] > limit));
  }
}

TEST(MeshDistance, ABoxWithoutALidStillKnowsItsSides) {
  Mesh box = box_shape({0, 0, 0}, {2, 2, 2});
  std::erase_if(box.faces, [&](const Mesh::Face& face) {
    return std::all_of(face.begin(), face.end(), [&](auto v) { return box.vertices[v].z() == 2; });
  });
  const MeshDistance distance(box);
  EXPECT_EQ(distance.topology().border_loops, 1u);
  EXPECT_EQ(distance.at({1, 1, 0.5}), -0.5);
  EXPECT_EQ(distance.at({1, 1, -0.5}), 0.5);
  EXPECT_EQ(distance.at({3, 1, 1}), 1);
}

TEST(MeshDistance, OfOneTriangleAndOfNone) {
  Mesh mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.faces = {{0, 1, 2}};
  EXPECT_EQ(MeshDistance(mesh).at({0.25, 0.25, -2}), -2);
  EXPECT_EQ(MeshDistance(mesh).at({0, -3, 4}), 5);
  mesh.faces = {{0, 1, 1}};
  EXPECT_THROW((void)MeshDistance(mesh), Error);
  EXPECT_THROW((void)MeshDistance(Mesh{}), Error);
}

}  // namespace
}  // namespace ray
