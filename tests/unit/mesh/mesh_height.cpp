#include "shapes.h"
#include "support/random_cloud.h"

#include <raycloud/core/error.h>
#include <raycloud/core/memory_stream.h>
#include <raycloud/mesh/mesh_height.h>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <optional>

namespace ray {
namespace {

using namespace test;

/// The highest face above or below, by solving for the barycentric coordinates.
std::optional<double> slow_height(const Mesh& mesh, double x, double y) {
  std::optional<double> best;
  for (const auto& face : mesh.faces) {
    Eigen::Matrix3d corners;
    for (int i = 0; i < 3; ++i)
      corners.col(i) << mesh.vertices[face[i]].x(), mesh.vertices[face[i]].y(), 1;
    if (std::abs(corners.determinant()) < 1e-12) continue;
    const Eigen::Vector3d weights = corners.inverse() * Eigen::Vector3d(x, y, 1);
    if (weights.minCoeff() < 0) continue;
    double height = 0;
    for (int i = 0; i < 3; ++i)
      height += weights[i] * mesh.vertices[face[i]].z();
    best = std::max(best.value_or(height), height);
  }
  return best;
}

RC_GTEST_PROP(MeshHeight, IsTheHighestSurfaceOfASlowOracle, ()) {
  const RandomStream random(*rc::gen::arbitrary<std::uint64_t>(), "faces");
  const double size = *rc::gen::element(0.5, 4.0, 40.0);
  Mesh mesh;
  for (std::uint64_t i = 0; i < 120; ++i)
    mesh.vertices.push_back(random_place(random, 7 * (i / 3), 10) + random_place(random, 1000 + i, size));
  for (std::uint32_t i = 0; i < 120; i += 3)
    mesh.faces.push_back({i, i + 1, i + 2});
  const MeshHeight height(mesh);
  for (std::uint64_t i = 0; i < 300; ++i) {
    const Eigen::Vector3d place = random_place(random, 5000 + i, 15);
    const auto slow = slow_height(mesh, place.x(), place.y());
    const HeightAt found = height.at(place.x(), place.y());
    RC_ASSERT(found.beyond == !slow);
    if (slow) RC_ASSERT(std::abs(found.height - *slow) < 1e-9);
  }
}

RC_GTEST_PROP(MeshHeight, BeyondTheMeshTheNearestEdgeCounts, ()) {
  const RandomStream random(*rc::gen::arbitrary<std::uint64_t>(), "rim");
  Mesh ground = ground_shape(9, [&](int x, int y) { return 3 * random.uniform(x, y); });
  ground.faces.erase(ground.faces.begin() + 60, ground.faces.begin() + 64);  // a hole
  const MeshHeight height(ground);
  for (std::uint64_t i = 0; i < 200; ++i) {
    const Eigen::Vector3d place =
        Eigen::Vector3d(4, 4, 0) + random_place(random, 100 + i, i % 2 == 0 ? 6.0 : 300.0);
    const HeightAt found = height.at(place.x(), place.y());
    if (!found.beyond) continue;
    double best = 1e300, expected = 0;
    for (const auto& face : ground.faces) {
      for (int side = 0; side < 3; ++side) {  // inner edges are never nearer than the rim around them
        const Eigen::Vector3d a = ground.vertices[face[side]];
        const Eigen::Vector3d b = ground.vertices[face[(side + 1) % 3]];
        const Eigen::Vector2d along = (b - a).head<2>();
        const double t = std::clamp((place - a).head<2>().dot(along) / along.squaredNorm(), 0.0, 1.0);
        const double distance = (a + t * (b - a) - place).head<2>().norm();
        if (distance < best - 1e-12) best = distance, expected = (a + t * (b - a)).z();
      }
    }
    RC_ASSERT(std::abs(found.height - expected) < 1e-6);
  }
}

TEST(MeshHeight, OfABoxIsItsLidAndOfAWallNothing) {
  const MeshHeight box(box_shape({0, 0, 1}, {2, 2, 5}));
  EXPECT_EQ(box.at(1, 0.5).height, 5);
  EXPECT_EQ(box.at(2, 2).height, 5);
  EXPECT_TRUE(box.at(2.001, 1).beyond);
  EXPECT_EQ(box.at(7, 1).height, 5);
  Mesh wall;
  wall.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 0, 1}};
  wall.faces = {{0, 1, 2}};
  EXPECT_THROW((void)MeshHeight(wall), Error);
}

RC_GTEST_PROP(ShiftByHeight, IsUndoneByItsOppositeAndDoesNotDependOnChunks, ()) {
  const auto seed = *rc::gen::arbitrary<std::uint64_t>();
  const RandomStream random(seed, "hills");
  const MeshHeight ground(ground_shape(9, [&](int x, int y) { return 3 * random.uniform(x, y); }));
  const RayCloud cloud = random_cloud(seed, {.rays = 300, .extras = schema_of_every_type()});
  const auto shifted = [&](const RayCloud& rays, double factor, const Context& context, std::size_t chunk) {
    MemorySource source(rays, chunk);
    MemorySink sink(source.info().extras);
    const HeightShift shift = shift_by_height(context, source, sink, ground, factor);
    RC_ASSERT(shift.stream.rays_out == rays.size());
    return sink.cloud();
  };
  const RayCloud lifted = shifted(cloud, 1, {.threads = 1}, 300);
  RC_ASSERT(same_bits(lifted, shifted(cloud, 1, {.threads = 3}, 7)));
  RayCloud back = shifted(lifted, -1, {.threads = 2}, 50);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    RC_ASSERT((back.ends[i] - cloud.ends[i]).norm() < 1e-14 * 30);
    RC_ASSERT((back.starts[i] - cloud.starts[i]).norm() < 1e-14 * 60);
    RC_ASSERT(lifted.ends[i].z() - cloud.ends[i].z() >= -1e-12);
  }
  back.ends = cloud.ends;
  back.starts = cloud.starts;
  RC_ASSERT(same_bits(back, cloud));
}

}  // namespace
}  // namespace ray
