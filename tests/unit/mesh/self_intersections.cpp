// Faces that go through each other, against a slow search that parts convex shapes by planes, in whole
// numbers.
#include "shapes.h"

#include <raycloud/mesh/topology.h>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>

namespace ray {
namespace {

using namespace test;
using Whole = std::array<std::int64_t, 3>;
using Shape = std::vector<Whole>;

Whole minus(const Whole& a, const Whole& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
Whole cross(const Whole& a, const Whole& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
std::int64_t dot(const Whole& a, const Whole& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/// Flat convex shapes have no place in common if, and only if, a plane parts them whose normal is one of
/// theirs, of two of their sides, or in one's plane of one of its sides.
bool slow_meet(const Shape& a, const Shape& b) {
  std::vector<Whole> axes;
  const auto sides = [](const Shape& shape) {
    std::vector<Whole> found;
    for (std::size_t i = 0; i < shape.size(); ++i)
      found.push_back(minus(shape[(i + 1) % shape.size()], shape[i]));
    return found;
  };
  for (const Shape* shape : {&a, &b}) {
    const Whole normal = cross(sides(*shape)[0], sides(*shape)[1]);
    axes.push_back(normal);
    for (const Whole& side : sides(*shape))
      axes.push_back(cross(normal, side));
  }
  for (const Whole& u : sides(a))
    for (const Whole& v : sides(b))
      axes.push_back(cross(u, v));
  return std::none_of(axes.begin(), axes.end(), [&](const Whole& axis) {
    std::vector<std::int64_t> of_a, of_b;
    for (const Whole& corner : a)
      of_a.push_back(dot(axis, corner));
    for (const Whole& corner : b)
      of_b.push_back(dot(axis, corner));
    const auto [low_a, high_a] = std::minmax_element(of_a.begin(), of_a.end());
    const auto [low_b, high_b] = std::minmax_element(of_b.begin(), of_b.end());
    return *high_a < *low_b || *high_b < *low_a;
  });
}

/// Without a strip along what it shares with the other, in 1/64.
Shape without_shared(const Shape& a, const Shape& b) {
  Shape rest;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto mixed = [&](std::size_t j) {  // from a[i] a little towards a[j]
      Whole corner{};
      for (std::size_t x = 0; x < 3; ++x)
        corner[x] = 63 * a[i][x] + a[j][x];
      return corner;
    };
    const auto is_shared = [&](std::size_t j) { return std::find(b.begin(), b.end(), a[j]) != b.end(); };
    const std::size_t before = (i + 2) % 3, after = (i + 1) % 3;
    if (!is_shared(i)) {
      rest.push_back({64 * a[i][0], 64 * a[i][1], 64 * a[i][2]});
    } else {
      if (!is_shared(before)) rest.push_back(mixed(before));
      if (!is_shared(after)) rest.push_back(mixed(after));
    }
  }
  return rest;
}

bool slow_meet_beyond_shared(const Shape& a, const Shape& b) {
  const auto shared = std::count_if(a.begin(), a.end(), [&](const Whole& corner) {
    return std::find(b.begin(), b.end(), corner) != b.end();
  });
  if (shared == 3) return true;
  Shape large_a = a, large_b = b;
  for (Shape* shape : {&large_a, &large_b})
    for (Whole& corner : *shape)
      for (std::int64_t& coordinate : corner)
        coordinate *= 64;
  return slow_meet(without_shared(a, b), large_b) || slow_meet(large_a, without_shared(b, a));
}

RC_GTEST_PROP(SelfIntersections, AreThoseOfASlowSearch, ()) {
  const RandomStream random(*rc::gen::arbitrary<std::uint64_t>(), "soup");
  const std::uint64_t size = *rc::gen::element<std::uint64_t>(2, 4, 9);
  const bool flat = *rc::gen::arbitrary<bool>();
  const bool is_far = *rc::gen::arbitrary<bool>();  // where products of coordinates round
  const Eigen::Vector3d away = is_far ? Eigen::Vector3d(0x1p40, 0x1p41, 0x1p39) : Eigen::Vector3d(0, 0, 0);
  Mesh mesh;
  std::vector<Shape> shapes;
  const std::uint64_t faces = 40;
  for (std::uint64_t f = 0; f < faces; ++f) {
    Shape shape;
    for (std::uint64_t i = 0; i < 3; ++i) {
      Whole corner{};
      for (std::uint64_t x = 0; x < (flat ? 2 : 3); ++x)
        corner[x] = static_cast<std::int64_t>(random.below(size, 3 * f + i, x));
      shape.push_back(corner);
      mesh.vertices.push_back(
          away + 0x1p-10 * Eigen::Vector3d(double(corner[0]), double(corner[1]), double(corner[2])));
    }
    const auto first = static_cast<std::uint32_t>(3 * f);
    mesh.faces.push_back({first, first + 1, first + 2});
    shapes.push_back(shape);
  }
  const auto has_area = [&](std::size_t f) {
    const Shape& shape = shapes[f];
    return cross(minus(shape[1], shape[0]), minus(shape[2], shape[0])) != Whole{};
  };
  std::vector<std::array<std::uint32_t, 2>> slow;
  for (std::uint32_t a = 0; a < faces; ++a) {
    for (std::uint32_t b = a + 1; b < faces; ++b)
      if (has_area(a) && has_area(b) && slow_meet_beyond_shared(shapes[a], shapes[b])) slow.push_back({a, b});
  }
  RC_ASSERT(self_intersections(mesh) == slow);
}

TEST(SelfIntersections, AreNotInSurfaces) {
  EXPECT_TRUE(self_intersections({}).empty());
  EXPECT_TRUE(self_intersections(box_shape({-1, -1, -1}, {1, 1, 1})).empty());
  EXPECT_TRUE(self_intersections(torus_shape(20, 12)).empty());
  EXPECT_TRUE(self_intersections(unwelded(torus_shape(20, 12))).empty());
  EXPECT_TRUE(self_intersections(ground_shape(9, [](int x, int y) { return 0.1 * x * y; })).empty());
}

TEST(SelfIntersections, OfSpheresThatCrossAreWhereTheyCross) {
  Mesh mesh = sphere_shape(2, [](const auto&) { return 2.0; });
  const Mesh other = sphere_shape(2, [](const auto&) { return 2.0; });
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  const auto own_faces = static_cast<std::uint32_t>(mesh.faces.size());
  for (const Eigen::Vector3d& vertex : other.vertices)
    mesh.vertices.push_back(vertex + Eigen::Vector3d(1.0, 0.3, 0.1));
  for (const Mesh::Face& face : other.faces)
    mesh.faces.push_back({face[0] + first, face[1] + first, face[2] + first});
  const auto found = self_intersections(mesh);
  EXPECT_GT(found.size(), 20u);
  EXPECT_TRUE(std::is_sorted(found.begin(), found.end()));
  for (const auto& [a, b] : found) {
    EXPECT_LT(a, own_faces);
    EXPECT_GE(b, own_faces);
  }
}

TEST(SelfIntersections, SeesADoubtOfOneBit) {
  // A tip that ends in a face, just in front of it, just behind.
  const double third = 1.0 / 3.0;
  Mesh mesh;
  mesh.vertices = {{0, 0, third},       {1, 0, third}, {0, 1, third},
                   {0.25, 0.25, third}, {0.2, 0.2, 1}, {0.3, 0.2, 1}};
  mesh.faces = {{0, 1, 2}, {3, 4, 5}};
  EXPECT_EQ(self_intersections(mesh).size(), 1u);
  mesh.vertices[3].z() = std::nextafter(third, 1.0);
  EXPECT_EQ(self_intersections(mesh).size(), 0u);
  mesh.vertices[3].z() = std::nextafter(third, 0.0);
  EXPECT_EQ(self_intersections(mesh).size(), 1u);
}

}  // namespace
}  // namespace ray
