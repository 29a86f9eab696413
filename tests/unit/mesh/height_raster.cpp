#include "shapes.h"

#include <raycloud/core/error.h>
#include <raycloud/core/memory_stream.h>
#include <raycloud/mesh/height_raster.h>
#include <raycloud/mesh/mesh_height.h>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>

namespace ray {
namespace {

using namespace test;

Mesh rough_ground(const RandomStream& random, const Eigen::Vector3d& away, double size) {
  Mesh ground = ground_shape(9, [&](int x, int y) { return random.uniform(x, y); });
  for (Eigen::Vector3d& vertex : ground.vertices)
    vertex = vertex * size + away;
  return ground;
}

RC_GTEST_PROP(HeightRaster, IsTheHeightAtTheMiddleOfEachCell, ()) {
  const RandomStream random(*rc::gen::arbitrary<std::uint64_t>(), "heights");
  const auto away = *rc::gen::element(Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(-3.3, 7.1, 2),
                                      Eigen::Vector3d(512345.6, 5.4e6, 300));
  const double cell = *rc::gen::element(0.5, 1.0, 0.37, 5.0);
  const Mesh ground = rough_ground(random, away, *rc::gen::element(1.0, 0.9));
  const MeshHeight height(ground);
  const Raster raster = height_raster(ground, cell, 100'000);
  RC_ASSERT(raster.values.size() == raster.width * raster.height);
  // Rasters of neighbours fit together.
  RC_ASSERT(std::abs(std::remainder(raster.corner.x(), cell)) < 1e-9 * cell + 1e-9);
  for (std::size_t row = 0; row < raster.height; ++row) {
    for (std::size_t column = 0; column < raster.width; ++column) {
      const Eigen::Vector2d middle = raster.centre(column, row);
      const HeightAt slow = height.at(middle.x(), middle.y());
      const float found = raster.values[row * raster.width + column];
      RC_ASSERT(std::isnan(found) == slow.beyond);
      if (!slow.beyond) RC_ASSERT(found == static_cast<float>(slow.height));
    }
  }
  // Nothing of the mesh is beyond the raster.
  for (const Eigen::Vector3d& vertex : ground.vertices) {
    const Eigen::Vector2d from = vertex.head<2>() - raster.corner;
    RC_ASSERT(from.x() >= -1e-6 && from.x() <= static_cast<double>(raster.width) * cell + 1e-6);
    RC_ASSERT(-from.y() >= -1e-6 && -from.y() <= static_cast<double>(raster.height) * cell + 1e-6);
  }
}

TEST(HeightRaster, SurfaceAndCanopy) {
  const Mesh flat = ground_shape(3, [](int, int) { return 1; });
  const Raster ground = height_raster(flat, 1.0, 100);
  ASSERT_EQ(ground.values, std::vector<float>(4, 1.0F));
  RayCloud cloud;
  cloud.resize(6);
  // Two above each other, one under the ground, one without a surface, one beyond; one cell stays empty.
  cloud.ends = {{0.5, 0.5, 4}, {0.6, 0.4, 7}, {1.5, 0.5, 0.5}, {1.5, 1.5, 9}, {5, 5, 9}, {0.1, 1.9, 1}};
  cloud.bounded = {1, 1, 1, 0, 1, 1};
  for (const std::size_t chunk : {1U, 6U}) {
    MemorySource source(cloud, chunk);
    const Raster surface = surface_raster({.threads = 2}, source, ground);
    // Rows from the north.
    EXPECT_EQ(surface.values[0], 1.0F);
    EXPECT_TRUE(std::isnan(surface.values[1]));
    EXPECT_EQ(surface.values[2], 7.0F);
    EXPECT_EQ(surface.values[3], 0.5F);
    const Raster canopy = canopy_raster(surface, ground);
    EXPECT_EQ(canopy.values[0], 0.0F);
    EXPECT_TRUE(std::isnan(canopy.values[1]));
    EXPECT_EQ(canopy.values[2], 6.0F);
    EXPECT_EQ(canopy.values[3], 0.0F);
  }
}

TEST(HeightRaster, RefusesWhatMakesNoSense) {
  const Mesh flat = ground_shape(3, [](int, int) { return 1; });
  for (const double cell : {0.0, -1.0, std::nan(""), HUGE_VAL})
    EXPECT_THROW((void)height_raster(flat, cell, 100), Error);
  EXPECT_THROW((void)height_raster({}, 1.0, 100), Error);
  EXPECT_THROW((void)height_raster(flat, 0.01, 100), Error);
}

}  // namespace
}  // namespace ray
