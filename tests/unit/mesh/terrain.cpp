#include "mesh/plan_opening.h"
#include "shapes.h"

#include <raycloud/core/error.h>
#include <raycloud/core/memory_stream.h>
#include <raycloud/mesh/cone_envelope.h>
#include <raycloud/mesh/mesh_height.h>
#include <raycloud/mesh/terrain.h>
#include <raycloud/mesh/topology.h>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <functional>
#include <limits>

namespace ray {
namespace {

using namespace test;
using Vector = Eigen::Vector3d;

RC_GTEST_PROP(ConeEnvelope, IsWhatAllPairsSay, ()) {
  const RandomStream random(*rc::gen::arbitrary<std::uint64_t>(), "cones");
  const double gradient = *rc::gen::element(0.0, 0.3, 1.0, 7.0);
  const bool on_grid = *rc::gen::arbitrary<bool>();  // points exactly on cones, and at one place
  std::vector<Vector> points;
  for (std::uint64_t i = 0; i < 300; ++i) {
    Vector point = random_place(random, i, 6).cwiseProduct(Vector(1, 1, 0.4));
    if (on_grid) point = point.array().round();
    points.push_back(point);
  }
  const auto found = cone_envelope({}, points, gradient);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vector& p = points[i];
    const bool above = std::any_of(points.begin(), points.end(), [&](const Vector& q) {
      return q.z() + gradient * (q - p).head<2>().norm() < p.z();
    });
    RC_ASSERT((found[i] == 0) == above);
  }
}

RC_GTEST_PROP(PlanOpening, IsWhatLookingAtEveryWindowSays, ()) {
  constexpr float kNone = std::numeric_limits<float>::infinity();
  const RandomStream random(*rc::gen::arbitrary<std::uint64_t>(), "openings");
  const PlanRaster raster{.columns = *rc::gen::inRange(1, 40), .rows = *rc::gen::inRange(1, 20)};
  const std::int64_t radius = *rc::gen::inRange(1, 12);
  std::vector<float> heights;
  for (std::size_t i = 0; i < raster.size(); ++i)
    heights.push_back(random.below(4, i) == 0 ? kNone : static_cast<float>(random.uniform(i, 1)));
  const auto at_every_cell = [&](const std::vector<float>& from, bool lowest) {
    std::vector<float> found(from.size(), kNone);
    for (std::size_t cell = 0; cell < from.size(); ++cell) {
      raster.around(
          cell,
          [&](std::size_t near) {
            if (from[near] == kNone) return;
            const bool is_better = found[cell] == kNone || (from[near] < found[cell]) == lowest;
            if (is_better) found[cell] = from[near];
          },
          radius);
    }
    return found;
  };
  const std::vector<float> slow = at_every_cell(at_every_cell(heights, true), false);
  RC_ASSERT(plan_opening({.threads = 2}, heights, raster, radius) == slow);
}

/// Normal numbers, nearly.
double noise(const RandomStream& random, std::uint64_t i) {
  double sum = -6.0;
  for (std::uint64_t draw = 100; draw < 112; ++draw)
    sum += random.uniform(i, draw);
  return sum;
}

double hill(double x, double y) {
  return 2.0 * std::sin(x / 7) * std::cos(y / 9) + 0.3 * x;
}

struct Place {
  double noise = 0.02;
  double false_returns = 0.0;  ///< share of ends
  bool box = false;            ///< a house, 10 m by 10 m and 5 m high
  bool trees = false;          ///< a fifth of the ends up to 8 m above the ground
};

RayCloud hillside(const Place& place, std::size_t rays = 40'000) {
  const RandomStream random(9, "hillside");
  RayCloud cloud;
  cloud.resize(rays);
  for (std::size_t i = 0; i < rays; ++i) {
    const double x = 40 * random.uniform(i, 0), y = 40 * random.uniform(i, 1);
    double z = hill(x, y) + place.noise * noise(random, i);
    if (place.box && std::abs(x - 20) < 5 && std::abs(y - 20) < 5)
      z = hill(20, 20) + 5 + place.noise * noise(random, i);
    if (place.trees && random.below(5, i, 2) == 0) z += 0.3 + 8 * random.uniform(i, 3);
    if (random.uniform(i, 4) < place.false_returns) z -= 0.5 + 5 * random.uniform(i, 5);
    cloud.ends[i] = {x, y, z};
    cloud.starts[i] = {20, 20, 50};
    cloud.times[i] = 0;
    cloud.bounded[i] = 1;
  }
  return cloud;
}

Terrain terrain_of(const RayCloud& cloud, const TerrainOptions& options = {}, std::size_t chunk = 5000,
                   const Context& context = {.threads = 1}) {
  MemorySource source(cloud, chunk);
  return extract_terrain(context, source, options);
}

struct HeightErrors {
  double root_mean_square = 0.0;
  double mean = 0.0;
  double worst = 0.0;
};

HeightErrors errors_of(const Mesh& mesh) {
  const MeshHeight height(mesh);
  HeightErrors errors;
  int count = 0;
  for (double x = 1; x < 39; x += 0.5) {
    for (double y = 1; y < 39; y += 0.5, ++count) {
      const double error = height.at(x, y).height - hill(x, y);
      errors.root_mean_square += error * error;
      errors.mean += error;
      errors.worst = std::max(errors.worst, std::abs(error));
    }
  }
  errors.root_mean_square = std::sqrt(errors.root_mean_square / count);
  errors.mean /= count;
  return errors;
}

TEST(Terrain, LiesInTheMiddleOfNoise) {
  const Terrain terrain = terrain_of(hillside({}));
  EXPECT_TRUE(topology_of(terrain.mesh).is_disc());
  EXPECT_TRUE(self_intersections(terrain.mesh).empty());
  const HeightErrors errors = errors_of(terrain.mesh);
  EXPECT_LT(errors.root_mean_square, 0.03);
  EXPECT_LT(std::abs(errors.mean), 0.01);
  EXPECT_LT(errors.worst, 0.2);
}

TEST(Terrain, FalseReturnsDigNoPits) {
  const HeightErrors errors = errors_of(terrain_of(hillside({.false_returns = 0.002})).mesh);
  EXPECT_LT(errors.root_mean_square, 0.03);
  EXPECT_LT(errors.worst, 0.25);
}

TEST(Terrain, HousesAndTreesAreTakenOff) {
  const HeightErrors trees = errors_of(terrain_of(hillside({.trees = true})).mesh);
  EXPECT_LT(trees.root_mean_square, 0.03);
  EXPECT_LT(trees.worst, 0.3);
  EXPECT_LT(errors_of(terrain_of(hillside({.box = true})).mesh).worst, 1.5);  // the hill under it is not seen
}

/// Ends of a height that depends on x, in 40 m by 20 m.
RayCloud ends_over(const std::function<double(double)>& height, std::size_t rays) {
  const RandomStream random(4, "steps");
  RayCloud cloud;
  cloud.resize(rays);
  for (std::size_t i = 0; i < rays; ++i) {
    const double x = 40 * random.uniform(i, 0);
    cloud.ends[i] = {x, 20 * random.uniform(i, 1), height(x) + 0.01 * noise(random, i)};
    cloud.starts[i] = cloud.ends[i] + Vector(0, 0, 50);
    cloud.bounded[i] = 1;
  }
  return cloud;
}

TEST(Terrain, ATerraceIsGroundUpToItsStepAndAHallIsNot) {
  // The cone alone would cut 2 m off the upper ground.
  const MeshHeight terrace(
      terrain_of(ends_over([](double x) { return 0.1 * x + (x > 20 ? 2 : 0); }, 20'000)).mesh);
  for (double x = 2; x < 39; x += 0.5) {
    if (std::abs(x - 20) < 0.6) continue;
    EXPECT_NEAR(terrace.at(x, 10).height, 0.1 * x + (x > 20 ? 2 : 0), 0.1) << x;
  }
  const MeshHeight hall(
      terrain_of(ends_over([](double x) { return 0.1 * x + (x > 8 && x < 32 ? 6 : 0); }, 20'000)).mesh);
  for (double x = 1; x < 39; x += 0.5)
    EXPECT_NEAR(hall.at(x, 10).height, 0.1 * x, 0.15) << x;
}

TEST(Terrain, WhatIsBehindTheGroundIsNoPit) {
  // A hillside seen from its foot. Three rays in a hundred come back late, so many that they have company.
  const RandomStream random(5, "late");
  RayCloud cloud = ends_over([](double x) { return 0.8 * x; }, 20'000);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    cloud.starts[i] = {-10, 10, 2};
    if (random.uniform(i) < 0.03)
      cloud.ends[i] += (1 + 3 * random.uniform(i, 1)) * (cloud.ends[i] - cloud.starts[i]).normalized();
  }
  const MeshHeight ground(terrain_of(cloud).mesh);
  for (double x = 2; x < 38; x += 0.25)
    for (double y = 2; y < 18; y += 0.25)
      EXPECT_NEAR(ground.at(x, y).height, 0.8 * x, 0.3) << x << ' ' << y;
}

TEST(Terrain, WhatRaysPassUnderIsNoGround) {
  // An awning so low and wide that it might be a terrace. Nobody has seen the ground below it, but rays from
  // a sensor that is lower still pass under it to the ground beyond.
  const auto is_awning = [](const Vector& end) {
    return std::abs(end.x() - 18) < 3 && std::abs(end.y() - 10) < 3;
  };
  RayCloud cloud = ends_over([](double) { return 0.0; }, 60'000);
  for (Vector& end : cloud.ends)
    if (is_awning(end)) end.z() += 0.5;
  const auto highest = [&] {
    const MeshHeight ground(terrain_of(cloud).mesh);
    double height = 0.0;
    for (double x = 15; x < 21; x += 0.5)
      for (double y = 7; y < 13; y += 0.5)
        height = std::max(height, ground.at(x, y).height);
    return height;
  };
  EXPECT_GT(highest(), 0.45);
  for (std::size_t i = 0; i < cloud.size(); ++i)
    if (cloud.ends[i].x() > 21) cloud.starts[i] = {-10, cloud.ends[i].y(), 0.3};
  EXPECT_LT(highest(), 0.1);
}

TEST(Terrain, DependsOnNeitherThreadsNorChunks) {
  const RayCloud cloud = hillside({.false_returns = 0.001, .trees = true}, 8000);
  const Mesh one = terrain_of(cloud).mesh;
  const Mesh other = terrain_of(cloud, {}, 77, {.threads = 3}).mesh;
  EXPECT_EQ(one.faces, other.faces);
  EXPECT_EQ(one.vertices, other.vertices);
}

TEST(Terrain, AToleranceLeavesTrianglesOut) {
  const RayCloud cloud = hillside({}, 20'000);
  const Mesh fine = terrain_of(cloud, {.tolerance = 0.0}).mesh;
  const Mesh coarse = terrain_of(cloud, {.tolerance = 0.1}).mesh;
  EXPECT_LT(coarse.faces.size() * 3, fine.faces.size());
  EXPECT_TRUE(topology_of(coarse).is_disc());
  const MeshHeight height(coarse);
  for (const Vector& vertex : fine.vertices)
    EXPECT_LT(std::abs(height.at(vertex.x(), vertex.y()).height - vertex.z()), 0.1 + 1e-6);
}

TEST(Terrain, OneEndFarAwayChangesNoCells) {
  RayCloud cloud = hillside({}, 20'000);
  const double cell = terrain_of(cloud).cell;
  cloud.ends[77] = {4e6, -2e6, 9e3};
  const Terrain terrain = terrain_of(cloud);
  EXPECT_LT(terrain.cell, 1.2 * cell);
  EXPECT_LT(errors_of(terrain.mesh).root_mean_square, 0.03);
}

TEST(Terrain, SaysWhereThereIsNone) {
  const auto code_of = [](const RayCloud& cloud, const TerrainOptions& options) {
    try {
      (void)terrain_of(cloud, options);
    } catch (const Error& error) {
      return error.code();
    }
    return ErrorCode::cancelled;
  };
  RayCloud cloud = hillside({}, 100);
  EXPECT_EQ(code_of(cloud, {.gradient = 0.0}), ErrorCode::usage);
  EXPECT_EQ(code_of(cloud, {.gradient = -1.0}), ErrorCode::usage);
  EXPECT_EQ(code_of(cloud, {.gradient = std::nan("")}), ErrorCode::usage);
  EXPECT_EQ(code_of(cloud, {.tolerance = -1.0}), ErrorCode::usage);
  EXPECT_EQ(code_of({}, {}), ErrorCode::no_data);
  EXPECT_EQ(code_of(hillside({}, 1), {}), ErrorCode::no_data);
  std::fill(cloud.bounded.begin(), cloud.bounded.end(), std::uint8_t{0});
  EXPECT_EQ(code_of(cloud, {}), ErrorCode::no_data);
}

}  // namespace
}  // namespace ray
