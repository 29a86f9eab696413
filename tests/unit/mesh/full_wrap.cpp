// The full wrap against a slow one that shares no code with it, and what each must be.
#include "slow_full_wrap.h"
#include "wrapped_points.h"

#include <raycloud/core/bounds.h>
#include <raycloud/core/error.h>
#include <raycloud/core/memory_stream.h>
#include <raycloud/mesh/full_wrap.h>
#include <raycloud/mesh/mesh_distance.h>
#include <raycloud/mesh/topology.h>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <map>

namespace ray {
namespace {

using namespace test;
using Vector = Eigen::Vector3d;

constexpr WrapDirection kDirections[] = {WrapDirection::upwards, WrapDirection::downwards,
                                         WrapDirection::inwards, WrapDirection::outwards};

Wrap fully_wrapped(const RayCloud& cloud, WrapDirection direction, double curvature, std::size_t chunk = 1000,
                   const Context& context = {.threads = 1}) {
  MemorySource source(cloud, chunk);
  return full_wrap(context, source, direction, curvature);
}

/// Places of a lattice that is coarse enough to be kept.
std::vector<Vector> rounded(std::vector<Vector> points) {
  for (Vector& point : points)
    point = (point * 0x1p20).array().round() * 0x1p-20;
  return points;
}

/// A bulk of points with a hollow on each side, of which some are under overhangs.
std::vector<Vector> hollow_points(std::uint64_t seed, std::size_t count) {
  const RandomStream random(seed, "hollow");
  std::vector<Vector> points;
  for (std::uint64_t i = 0; points.size() < count; ++i) {
    const Vector place = random_place(random, i, 10.0);
    const bool in_middle = place.norm() < 4.0;
    const bool below = (place - Vector(5, 0, -6)).norm() < 4.0 || (place - Vector(2, 0, -3)).norm() < 3.0;
    const bool above = (place - Vector(-6, 3, 7)).norm() < 3.0;
    if (!in_middle && !below && !above) points.push_back(place);
  }
  return rounded(points);
}

/// Faces as the numbers of points, seen from where the ball comes from.
std::set<Mesh::Face> faces_of(const Mesh& mesh, const std::vector<Vector>& points, bool as_they_are) {
  const auto less = [](const Vector& a, const Vector& b) {
    return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end());
  };
  std::map<Vector, std::uint32_t, decltype(less)> numbers(less);
  for (std::uint32_t i = 0; i < points.size(); ++i)
    numbers[points[i]] = i;
  std::set<Mesh::Face> faces;
  for (Mesh::Face face : mesh.faces) {
    for (std::uint32_t& vertex : face)
      vertex = numbers.at(mesh.vertices[vertex]);
    if (!as_they_are) std::swap(face[1], face[2]);
    faces.insert(SlowFullWrap::turned(face));
  }
  return faces;
}

std::set<Mesh::Face> slowly_wrapped(const std::vector<Vector>& points, WrapDirection direction,
                                    double radius) {
  SlowFullWrap slow(points);
  std::vector<Mesh::Face> first;
  if (direction == WrapDirection::outwards) {
    first = slow.faces_from_inside(slow.cell_at(Vector::Zero()));
  } else {
    if (direction != WrapDirection::downwards) first = slow.hull_seen_from(1);
    if (direction != WrapDirection::upwards) {
      const auto above = slow.hull_seen_from(-1);
      first.insert(first.end(), above.begin(), above.end());
    }
  }
  return slow.wrap(first, radius);
}

void expect_same_as_slow(const std::vector<Vector>& points, WrapDirection direction, double curvature) {
  const Wrap result = fully_wrapped(cloud_of(points), direction, curvature);
  const bool fronts_to_the_ball =
      direction == WrapDirection::downwards || direction == WrapDirection::inwards;
  EXPECT_EQ(faces_of(result.mesh, points, fronts_to_the_ball),
            slowly_wrapped(points, direction, 1.0 / curvature));
}

RC_GTEST_PROP(FullWrap, IsWhatASlowOneIs, ()) {
  const std::vector<Vector> points =
      hollow_points(*rc::gen::arbitrary<std::uint64_t>(), *rc::gen::element(20, 60, 200));
  const WrapDirection direction =
      *rc::gen::elementOf(std::vector<WrapDirection>(std::begin(kDirections), std::end(kDirections)));
  expect_same_as_slow(points, direction, *rc::gen::element(0.25, 0.4, 1.0, 1e3));
}

TEST(FullWrap, IsWhatASlowOneOf2000PointsIs) {
  for (const WrapDirection direction : kDirections)
    expect_same_as_slow(hollow_points(5, 2000), direction, 0.5);
}

/// Each face has an empty ball of at least the radius, on the side that the ball comes from.
void expect_room_for_balls(const std::set<Mesh::Face>& faces, const std::vector<Vector>& points,
                           double radius) {
  for (const Mesh::Face& face : faces) {
    const Vector& a = points[face[0]];
    const Vector u = points[face[1]] - a, v = points[face[2]] - a, n = u.cross(v);
    const Vector centre =
        (u.squaredNorm() * v.cross(n) + v.squaredNorm() * n.cross(u)) / (2 * n.squaredNorm());
    const double size = n.norm();
    double from = -std::numeric_limits<double>::infinity(), to = -from;  // centres along n from the middle
    for (const Vector& point : points) {
      const Vector p = point - a;
      const double height = n.dot(p) / size, power = p.squaredNorm() - 2 * p.dot(centre);
      if (std::abs(height) < 1e-9) {
        EXPECT_GT(power, -1e-6);
      } else if (height > 0) {
        to = std::min(to, power / (2 * height));
      } else {
        from = std::max(from, power / (2 * height));
      }
    }
    EXPECT_LE(from, to + 1e-6 * (1 + std::abs(to)));
    EXPECT_GT(std::hypot(centre.norm(), to), radius * (1 - 1e-6));
  }
}

/// What must be true of every one.
void expect_whole(const std::vector<Vector>& points, WrapDirection direction, double curvature) {
  SCOPED_TRACE(static_cast<int>(direction));
  const Mesh mesh = fully_wrapped(cloud_of(points, points.front()), direction, curvature).mesh;
  const bool is_sheet = direction == WrapDirection::upwards || direction == WrapDirection::downwards;
  EXPECT_TRUE(is_sheet ? topology_of(mesh).is_disc() : topology_of(mesh).is_sphere());
  EXPECT_TRUE(self_intersections(mesh).empty());
  Bounds bounds;
  for (const Vector& point : points)
    bounds.add(point);
  const bool up = direction == WrapDirection::upwards;
  const double level = up ? bounds.max.z() + 1.0 : bounds.min.z() - 1.0;
  const MeshDistance distance(is_sheet ? closed_sheet(mesh, up, level) : mesh);
  const double little = 1e-6 * bounds.extent().norm();
  for (const Vector& point : points) {
    const double outside = distance.at(point);
    EXPECT_LT(direction == WrapDirection::outwards ? -outside : outside, little);
  }
}

TEST(FullWrap, FacesHaveRoomForTheBallAndAllEndsAreOnTheirSide) {
  const std::vector<Vector> points = hollow_points(7, 300);
  for (const WrapDirection direction : kDirections) {
    for (const double curvature : {0.25, 0.6, 1e4}) {
      const Mesh mesh = fully_wrapped(cloud_of(points), direction, curvature).mesh;
      const bool fronts_to_the_ball =
          direction == WrapDirection::downwards || direction == WrapDirection::inwards;
      expect_room_for_balls(faces_of(mesh, points, fronts_to_the_ball), points, 1.0 / curvature);
      expect_whole(points, direction, curvature);
    }
  }
}

RC_GTEST_PROP(FullWrap, IsWholeEvenOnGrids, ()) {
  const RandomStream random(*rc::gen::arbitrary<std::uint64_t>(), "grid");
  const double step = *rc::gen::element(1.0, 0.001);
  const Vector away = *rc::gen::element(Vector(0, 0, 0), Vector(5e5, 5e6, 300));
  std::vector<Vector> points;
  const std::uint64_t height = *rc::gen::element<std::uint64_t>(2, 5);
  for (std::uint64_t i = 0; i < 120; ++i) {  // many on lines, in planes, on spheres, and at one place
    points.push_back(away + step * Vector(double(random.below(5, i, 0)), double(random.below(5, i, 1)),
                                          double(random.below(height, i, 2))));
  }
  for (const Vector& corner : {Vector(0, 0, 0), Vector(step, 0, 0), Vector(0, step, 0), Vector(0, 0, step)})
    points.push_back(away + corner);
  const WrapDirection direction =
      *rc::gen::element(WrapDirection::upwards, WrapDirection::downwards, WrapDirection::inwards);
  expect_whole(points, direction, *rc::gen::element(0.0, 0.9, 1000.0) / step);
  RC_ASSERT(!::testing::Test::HasFailure());
}

TEST(FullWrap, GoesUnderAnOverhangThatTheFastOneDoesNotSee) {
  std::vector<Vector> points;  // a table on a floor
  for (int x = -10; x <= 10; ++x) {
    for (int y = -10; y <= 10; ++y) {
      points.emplace_back(x, y, 0.1 * ((x * 7 + y * 3) % 5));
      if (std::abs(x) < 5 && std::abs(y) < 5) points.emplace_back(x, y, 6.0);
      if (x == 0 && y == 0)
        for (int z = 1; z < 6; ++z)
          points.emplace_back(x, y, z);
    }
  }
  const RayCloud cloud = cloud_of(points);
  const auto under_the_table = [](const Mesh& mesh) {
    return std::count_if(mesh.faces.begin(), mesh.faces.end(), [&](const Mesh::Face& face) {
      const Vector& a = mesh.vertices[face[0]];
      return (mesh.vertices[face[1]] - a).cross(mesh.vertices[face[2]] - a).z() < -0.5 && a.z() > 5;
    });
  };
  MemorySource source(cloud);
  EXPECT_EQ(under_the_table(wrap({.threads = 1}, source, WrapDirection::downwards, 1.0).mesh), 0);
  EXPECT_GT(under_the_table(fully_wrapped(cloud, WrapDirection::downwards, 1.0).mesh), 20);
}

TEST(FullWrap, OfCurvature0IsTheConvexHull) {
  const std::vector<Vector> points = hollow_points(3, 200);
  const Mesh full = fully_wrapped(cloud_of(points), WrapDirection::inwards, 0.0).mesh;
  const RayCloud cloud = cloud_of(points);
  MemorySource source(cloud);
  const Mesh fast = wrap({.threads = 1}, source, WrapDirection::inwards, 0.0).mesh;
  EXPECT_EQ(faces_of(full, points, true), faces_of(fast, points, true));
}

TEST(FullWrap, DependsOnNeitherThreadsNorChunksNorTheOrderOfRays) {
  std::vector<Vector> points = hollow_points(9, 8000);
  for (const WrapDirection direction : {WrapDirection::upwards, WrapDirection::inwards}) {
    const Mesh one = fully_wrapped(cloud_of(points), direction, 0.4).mesh;
    std::reverse(points.begin(), points.end());
    const Mesh other = fully_wrapped(cloud_of(points), direction, 0.4, 77, {.threads = 3}).mesh;
    EXPECT_EQ(one.faces, other.faces);
    EXPECT_EQ(one.vertices, other.vertices);
  }
}

ErrorCode code_of_full(const std::vector<Vector>& points, WrapDirection direction, double curvature,
                       bool bounded = true) {
  RayCloud cloud = cloud_of(points);
  if (!bounded) std::fill(cloud.bounded.begin(), cloud.bounded.end(), std::uint8_t{0});
  try {
    (void)fully_wrapped(cloud, direction, curvature);
  } catch (const Error& error) {
    return error.code();
  }
  ADD_FAILURE() << "nothing was thrown";
  return ErrorCode::cancelled;
}

TEST(FullWrap, SaysWhatCannotBeWrapped) {
  const std::vector<Vector> good = hollow_points(1, 30);
  const std::vector<Vector> same(5, Vector(1, 2, 3));
  std::vector<Vector> line, plane;
  for (int i = 0; i < 9; ++i) {
    line.emplace_back(i, 2 * i, 3 * i);
    plane.emplace_back(i % 3, i / 3, 1);
  }
  for (const WrapDirection direction : kDirections) {
    SCOPED_TRACE(static_cast<int>(direction));
    EXPECT_EQ(code_of_full(good, direction, -1.0), ErrorCode::usage);
    EXPECT_EQ(code_of_full(good, direction, std::nan("")), ErrorCode::usage);
    EXPECT_EQ(code_of_full({}, direction, 1.0), ErrorCode::no_data);
    EXPECT_EQ(code_of_full(good, direction, 1.0, false), ErrorCode::no_data);
    EXPECT_EQ(code_of_full({{1, 2, 3}}, direction, 1.0), ErrorCode::no_data);
    EXPECT_EQ(code_of_full(same, direction, 1.0), ErrorCode::no_data);
    EXPECT_EQ(code_of_full(line, direction, 1.0), ErrorCode::no_data);
  }
  for (const WrapDirection direction : {WrapDirection::inwards, WrapDirection::outwards}) {
    EXPECT_EQ(code_of_full(plane, direction, 1.0), ErrorCode::no_data);
    EXPECT_EQ(code_of_full({{0, 0, 0}, {1, 0, 5}, {0, 1, 9}}, direction, 1.0), ErrorCode::no_data);
  }
  EXPECT_EQ(code_of_full(good, WrapDirection::outwards, 1e-4), ErrorCode::out_of_range);
  EXPECT_EQ(code_of_full({{1, 0, 0}, {2, 0, 0}, {1, 1, 0}, {1, 0, 1}}, WrapDirection::outwards, 9.0),
            ErrorCode::out_of_range);  // the middle of the starts is not between them
  for (const WrapDirection direction : {WrapDirection::upwards, WrapDirection::downwards})
    EXPECT_TRUE(topology_of(fully_wrapped(cloud_of(plane), direction, 1.0).mesh).is_disc());
}

}  // namespace
}  // namespace ray
