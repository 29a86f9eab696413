// Which ends the probes of wraps touch, against slow wraps that share no code with them, and whether each
// face has a probe of the curvature that meets no end before it.
#include "slow_hull.h"
#include "wrapped_points.h"

#include <raycloud/mesh/topology.h>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <limits>

namespace ray {
namespace {

using namespace test;
using Vector = Eigen::Vector3d;

/// Makes the paraboloids of a curvature planes.
struct Lift {
  double curvature, sign;
  Vector operator()(const Vector& point) const {
    return {point.x(), point.y(), sign * point.z() + 0.5 * curvature * point.head<2>().squaredNorm()};
  }
};

/// Makes the conics of a curvature planes.
struct RadialMap {
  Vector middle;
  double curvature, sign;
  Vector operator()(const Vector& point) const {
    return (point - middle) / (curvature * (point - middle).norm() + sign);
  }
};

template <class Map>
std::vector<Vector> mapped(std::vector<Vector> points, const Map& map) {
  for (Vector& point : points)
    point = map(point);
  return points;
}

Vector mean_of(const std::vector<Vector>& points) {
  Vector sum = Vector::Zero();
  for (const Vector& point : points)
    sum += point;
  return sum / static_cast<double>(points.size());
}

std::set<std::size_t> slow_hull(std::vector<Vector> points) {
  std::set<std::size_t> corners = corners_of(slow_lower_hull(points));
  for (Vector& point : points)
    point.z() = -point.z();
  corners.merge(corners_of(slow_lower_hull(points)));
  return corners;
}

Mesh turned_over(Mesh mesh) {
  for (Mesh::Face& face : mesh.faces)
    std::swap(face[1], face[2]);
  return mesh;
}

/// Whether no point is in front of a face by more than `room`, where probes are planes.
template <class Map>
bool are_behind(const Mesh& mesh, const std::vector<Vector>& points, const Map& map, double room = 1e-6) {
  const std::vector<Vector> vertices = mapped(mesh.vertices, map), all = mapped(points, map);
  return std::all_of(mesh.faces.begin(), mesh.faces.end(), [&](const Mesh::Face& face) {
    const Vector& at = vertices[face[0]];
    const Vector normal = (vertices[face[1]] - at).cross(vertices[face[2]] - at).normalized();
    return std::all_of(all.begin(), all.end(),
                       [&](const Vector& point) { return normal.dot(point - at) < room; });
  });
}

RC_GTEST_PROP(WrapProbes, UpwardsAndDownwardsTouchWhatASlowWrapTouches, ()) {
  const auto seed = *rc::gen::arbitrary<std::uint64_t>();
  const double curvature = *rc::gen::element(0.0, 0.01, 0.3, 50.0);
  const bool down = *rc::gen::arbitrary<bool>();
  const std::vector<Vector> points = rough_points(seed, *rc::gen::element(4, 30, 300), 20.0);
  const Wrap result =
      wrapped(cloud_of(points), down ? WrapDirection::downwards : WrapDirection::upwards, curvature);
  const Lift lift{curvature, down ? -1.0 : 1.0};
  RC_ASSERT(vertices_of(result.mesh, points) == corners_of(slow_lower_hull(mapped(points, lift))));
  RC_ASSERT(topology_of(result.mesh).is_disc());
  RC_ASSERT(self_intersections(result.mesh).empty());
}

RC_GTEST_PROP(WrapProbes, UpwardsAndDownwardsMeetNoEndBeforeTheirFace, ()) {
  constexpr double kExtent = 20.0;  // m
  // Ends are rounded to a 2^30th of the extent in plan, where probes of the largest curvature rise 700 m a
  // metre.
  constexpr double kRoom = 1e-6 * kExtent;
  const std::vector<Vector> points = rough_points(*rc::gen::arbitrary<std::uint64_t>(), 150, kExtent);
  const double curvature = *rc::gen::element(0.0, 0.01, 0.3, 50.0);
  const Mesh up = wrapped(cloud_of(points), WrapDirection::upwards, curvature).mesh;
  RC_ASSERT(are_behind(turned_over(up), points, Lift{curvature, 1.0}, kRoom));
  const Mesh down = wrapped(cloud_of(points), WrapDirection::downwards, curvature).mesh;
  RC_ASSERT(are_behind(turned_over(down), points, Lift{curvature, -1.0}, kRoom));
}

TEST(WrapProbes, UpwardsAndDownwardsTouchWhatASlowWrapOf2000PointsTouches) {
  const std::vector<Vector> points = rough_points(11, 2000, 30.0);
  for (const double curvature : {0.02, 1.0}) {
    const Mesh up = wrapped(cloud_of(points), WrapDirection::upwards, curvature).mesh;
    EXPECT_EQ(vertices_of(up, points), corners_of(slow_lower_hull(mapped(points, Lift{curvature, 1.0}))));
    const Mesh down = wrapped(cloud_of(points), WrapDirection::downwards, curvature).mesh;
    EXPECT_EQ(vertices_of(down, points), corners_of(slow_lower_hull(mapped(points, Lift{curvature, -1.0}))));
  }
}

TEST(WrapProbes, InwardsAndOutwardsTouchWhatASlowWrapOf2000PointsTouches) {
  const std::vector<Vector> points = star_points(12, 2000);
  for (const double curvature : {0.0, 0.3, 3.0}) {
    const Mesh mesh = wrapped(cloud_of(points), WrapDirection::inwards, curvature).mesh;
    EXPECT_EQ(vertices_of(mesh, points),
              slow_hull(mapped(points, RadialMap{mean_of(points), curvature, 1.0})));
  }
  for (const double curvature : {0.8, 3.0}) {
    const Mesh mesh = wrapped(cloud_of(points), WrapDirection::outwards, curvature).mesh;
    EXPECT_EQ(vertices_of(mesh, points),
              slow_hull(mapped(points, RadialMap{Vector::Zero(), curvature, -1.0})));
  }
}

RC_GTEST_PROP(WrapProbes, InwardsAndOutwardsMeetNoEndBeforeTheirFace, ()) {
  const std::vector<Vector> points = star_points(*rc::gen::arbitrary<std::uint64_t>(), 150);
  for (const double curvature : {0.0, 0.1, 2.0}) {
    const RadialMap map{mean_of(points), curvature, 1.0};
    RC_ASSERT(are_behind(wrapped(cloud_of(points), WrapDirection::inwards, curvature).mesh, points, map));
  }
  for (const double curvature : {0.8, 2.0}) {
    const RadialMap map{Vector::Zero(), curvature, -1.0};
    RC_ASSERT(are_behind(wrapped(cloud_of(points), WrapDirection::outwards, curvature).mesh, points, map));
  }
}

TEST(WrapProbes, MoreCurvatureTouchesMoreOfARoom) {
  const std::vector<Vector> points = star_points(5, 3000);
  std::size_t before = 0;
  for (const double curvature : {0.8, 2.0, 20.0}) {
    const std::size_t touched =
        wrapped(cloud_of(points), WrapDirection::outwards, curvature).mesh.vertices.size();
    EXPECT_GT(touched, before);
    before = touched;
  }
}

TEST(WrapProbes, OfAHugeCurvatureTouchesAll) {
  // Far apart, and all at one height.
  std::vector<Vector> wide = rough_points(6, 300, 1e6), flat = rough_points(7, 300, 10.0);
  for (Vector& point : flat)
    point.z() = 2.0;
  for (const double curvature : {1e30, 1e300, std::numeric_limits<double>::max()}) {
    for (const auto& points : {wide, flat}) {
      for (const WrapDirection direction : {WrapDirection::upwards, WrapDirection::downwards})
        EXPECT_EQ(wrapped(cloud_of(points), direction, curvature).mesh.vertices.size(), points.size());
    }
    const std::vector<Vector> star = star_points(8, 300);
    for (const WrapDirection direction : {WrapDirection::inwards, WrapDirection::outwards})
      EXPECT_EQ(wrapped(cloud_of(star), direction, curvature).mesh.vertices.size(), star.size());
  }
}

}  // namespace
}  // namespace ray
