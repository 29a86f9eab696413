// What every wrap must be: a disc or a sphere with all ends on the right side. `wrap_probes.cpp` has what it
// touches.
#include "shapes.h"
#include "wrapped_points.h"

#include <raycloud/core/error.h>
#include <raycloud/mesh/mesh_distance.h>
#include <raycloud/mesh/mesh_height.h>
#include <raycloud/mesh/topology.h>
#include <raycloud/mesh/weld.h>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace ray {
namespace {

using namespace test;
using Vector = Eigen::Vector3d;

RC_GTEST_PROP(Wrap, NoEndIsBelowAndTheMeshIsADiscEvenOnGrids, ()) {
  const RandomStream random(*rc::gen::arbitrary<std::uint64_t>(), "grid");
  const double step = *rc::gen::element(1.0, 0.001);
  const Vector away = *rc::gen::element(Vector(0, 0, 0), Vector(5e5, 5e6, 300));
  std::vector<Vector> points;
  for (std::uint64_t i = 0; i < 400; ++i) {  // many on lines, on circles, and at one place of the map
    points.push_back(away + step * Vector(double(random.below(9, i, 0)), double(random.below(9, i, 1)),
                                          double(random.below(4, i, 2))));
  }
  points.push_back(away), points.push_back(away + Vector(step, 0, 0)),
      points.push_back(away + Vector(0, step, 0));
  const double curvature = *rc::gen::element(0.0, 0.5, 1000.0);
  const Wrap result = wrapped(cloud_of(points), WrapDirection::upwards, curvature / step);
  RC_ASSERT(topology_of(result.mesh).is_disc());
  RC_ASSERT(self_intersections(result.mesh).empty());
  const MeshHeight height(result.mesh);
  for (const Vector& point : points) {
    const HeightAt at = height.at(point.x(), point.y());
    RC_ASSERT(point.z() >= at.height - 1e-6 * 9 * step - 1e-8);
  }
  for (const Mesh::Face& face : result.mesh.faces) {
    const Vector u = result.mesh.vertices[face[1]] - result.mesh.vertices[face[0]];
    const Vector v = result.mesh.vertices[face[2]] - result.mesh.vertices[face[0]];
    RC_ASSERT(u.cross(v).z() > 0);
  }
}

RC_GTEST_PROP(Wrap, InwardsIsASphereAroundAllEnds, ()) {
  const std::vector<Vector> points = star_points(*rc::gen::arbitrary<std::uint64_t>(), 150);
  const double curvature = *rc::gen::element(0.0, 0.1, 2.0);
  const Wrap result = wrapped(cloud_of(points), WrapDirection::inwards, curvature);
  RC_ASSERT(topology_of(result.mesh).is_sphere());
  RC_ASSERT(self_intersections(result.mesh).empty());
  RC_ASSERT(result.cut_off == 0u);
  const MeshDistance distance(result.mesh);
  for (const Vector& point : points)
    RC_ASSERT(distance.at(point) < 1e-9);
}

RC_GTEST_PROP(Wrap, InwardsIsWholeEvenOnGrids, ()) {
  const RandomStream random(*rc::gen::arbitrary<std::uint64_t>(), "grid");
  const Vector away = *rc::gen::element(Vector(0, 0, 0), Vector(5e5, 5e6, 300));
  std::vector<Vector> points;
  for (std::uint64_t i = 0; i < 100; ++i) {
    points.push_back(away + Vector(double(random.below(5, i, 0)), double(random.below(5, i, 1)),
                                   double(random.below(3, i, 2))));
  }
  for (const Vector& corner : {Vector(0, 0, 0), Vector(1, 0, 0), Vector(0, 1, 0), Vector(0, 0, 1)})
    points.push_back(away + corner);
  const Mesh mesh =
      wrapped(cloud_of(points), WrapDirection::inwards, *rc::gen::element(0.0, 0.5, 1000.0)).mesh;
  RC_ASSERT(topology_of(weld(mesh).mesh).is_sphere());
  RC_ASSERT(self_intersections(mesh).empty());
  const MeshDistance distance(mesh);
  for (const Vector& point : points)
    RC_ASSERT(distance.at(point) < 1e-6);
}

RC_GTEST_PROP(Wrap, OutwardsIsASphereWithNoEndInside, ()) {
  const std::vector<Vector> points = star_points(*rc::gen::arbitrary<std::uint64_t>(), 150);
  const double curvature = *rc::gen::element(0.8, 2.0, 20.0);
  const Wrap result = wrapped(cloud_of(points), WrapDirection::outwards, curvature);
  RC_ASSERT(topology_of(result.mesh).is_sphere());
  RC_ASSERT(self_intersections(result.mesh).empty());
  RC_ASSERT(result.cut_off == 0u);
  const MeshDistance distance(result.mesh);
  for (const Vector& point : points)
    RC_ASSERT(distance.at(point) > -1e-9);
  RC_ASSERT(distance.at(Vector::Zero()) < -1.0);
}

/// How often the faces turn around a place that is on none of them, by their solid angles (van Oosterom and
/// Strackee, 1983).
int turns_around(const Mesh& mesh, const Vector& place) {
  double sum = 0.0;
  for (const Mesh::Face& face : mesh.faces) {
    const Vector a = (mesh.vertices[face[0]] - place).normalized();
    const Vector b = (mesh.vertices[face[1]] - place).normalized();
    const Vector c = (mesh.vertices[face[2]] - place).normalized();
    sum += std::atan2(a.dot(b.cross(c)), 1.0 + a.dot(b) + b.dot(c) + c.dot(a));
  }
  return static_cast<int>(std::lround(std::abs(sum) / (2.0 * std::numbers::pi)));
}

TEST(Wrap, OutwardsCountsEndsThatItCutsOff) {
  // A floor without walls or ceiling, all of it to one side of the sensor.
  const std::vector<Vector> points = rough_points(2, 500, 20.0);
  const Wrap result = wrapped(cloud_of(points, {15, 0, 12}), WrapDirection::outwards, 0.3);
  const MeshDistance distance(result.mesh);
  std::uint64_t inside = 0;
  for (const Vector& point : points)
    inside += std::abs(distance.at(point)) > 4e-5 && turns_around(result.mesh, point) > 0 ? 1 : 0;
  EXPECT_EQ(result.cut_off, inside);
  EXPECT_GT(result.cut_off, 0u);
}

TEST(Wrap, DependsOnNeitherThreadsNorChunks) {
  const RayCloud rough = cloud_of(rough_points(3, 20'000, 50.0), {1, 2, 30});
  const RayCloud star = cloud_of(star_points(3, 20'000));
  for (const WrapDirection direction :
       {WrapDirection::upwards, WrapDirection::downwards, WrapDirection::inwards, WrapDirection::outwards}) {
    const bool is_around = direction == WrapDirection::outwards;
    const RayCloud& cloud = is_around ? star : rough;
    const double curvature = is_around ? 2.0 : 0.2;
    const Mesh one = wrapped(cloud, direction, curvature).mesh;
    for (const std::size_t chunk : {std::size_t{77}, std::size_t{20'000}}) {
      const Mesh other = wrapped(cloud, direction, curvature, chunk, {.threads = 3, .memory = 1000}).mesh;
      EXPECT_EQ(one.faces, other.faces);
      EXPECT_EQ(one.vertices, other.vertices);
    }
  }
}

ErrorCode code_of(const RayCloud& cloud, WrapDirection direction, double curvature) {
  try {
    (void)wrapped(cloud, direction, curvature);
  } catch (const Error& error) {
    return error.code();
  }
  ADD_FAILURE() << "nothing was thrown";
  return ErrorCode::cancelled;
}

TEST(Wrap, SaysWhatCannotBeWrapped) {
  const double kNaN = std::numeric_limits<double>::quiet_NaN();
  const RayCloud good = cloud_of(star_points(1, 50));
  RayCloud unbounded = good;
  std::fill(unbounded.bounded.begin(), unbounded.bounded.end(), std::uint8_t{0});
  std::vector<Vector> line, plane;
  for (int i = 0; i < 9; ++i) {
    line.emplace_back(i, 2 * i, i * i);
    plane.emplace_back(i % 3, i / 3, 1);
  }
  for (const auto direction :
       {WrapDirection::upwards, WrapDirection::downwards, WrapDirection::inwards, WrapDirection::outwards}) {
    EXPECT_EQ(code_of(good, direction, -1.0), ErrorCode::usage);
    EXPECT_EQ(code_of(good, direction, kNaN), ErrorCode::usage);
    EXPECT_EQ(code_of({}, direction, 1.0), ErrorCode::no_data);
    EXPECT_EQ(code_of(unbounded, direction, 1.0), ErrorCode::no_data);
    EXPECT_EQ(code_of(cloud_of({{1, 2, 3}}, {0, 0, 9}), direction, 1.0), ErrorCode::no_data);
  }
  EXPECT_EQ(code_of(cloud_of(line), WrapDirection::upwards, 1.0), ErrorCode::no_data);
  EXPECT_EQ(code_of(cloud_of(plane), WrapDirection::inwards, 1.0), ErrorCode::no_data);
  EXPECT_EQ(code_of(good, WrapDirection::outwards, 0.1), ErrorCode::out_of_range);
  EXPECT_TRUE(topology_of(wrapped(cloud_of(plane), WrapDirection::upwards, 0.0).mesh).is_disc());
  EXPECT_EQ(
      wrapped(cloud_of({{0, 0, 0}, {1, 0, 5}, {0, 1, 9}}), WrapDirection::upwards, 1e9).mesh.faces.size(),
      1u);
}

}  // namespace
}  // namespace ray
