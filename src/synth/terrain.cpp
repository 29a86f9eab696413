/// Slopes, ridges and gullies with boulders and grass; or the ground of a file.

#include "outdoors.h"
#include "scene_kinds.h"
#include "turn.h"

#include <raycloud/core/error.h>
#include <raycloud/synth/scenes.h>

#include <algorithm>
#include <cmath>

namespace ray {
namespace {

constexpr double kHalf = 100.0;    // m
constexpr double kSteepest = 0.8;  // slope that a person walks

Mesh hills(const SceneBuilder& scene) {
  const RandomStream broad = scene.random("hills");
  const RandomStream ridges = scene.random("ridges");
  const RandomStream gullies = scene.random("gullies");
  const RandomStream fine = scene.random("bumps");
  return height_field({{-kHalf, -kHalf}, {kHalf, kHalf}}, 0.5, [&](double x, double y) {
    const double hill = fractal(broad, x, y, {.wavelength = 130, .height = 26, .octaves = 2});
    const double ridge = 1 - std::min(1.0, 5 * std::abs(gradient_noise(ridges, x / 90, y / 90)));
    const double gully = 1 - std::min(1.0, 10 * std::abs(gradient_noise(gullies, x / 75, y / 75)));
    return hill + 5 * ridge * ridge - 2.5 * gully * gully * (3 - 2 * gully) +
           fractal(fine, x, y, {.wavelength = 18, .height = 1.0, .roughness = 0.42, .octaves = 6});
  });
}

void scatter(SceneBuilder& scene, const Ground& ground) {
  constexpr std::uint64_t kBoulders = 60;
  constexpr std::uint64_t kTufts = 4000;
  const RandomStream places = scene.random("places");
  const RandomStream shapes = scene.random("shapes");
  const auto place_of = [&](std::uint64_t i) {
    const double rim = kHalf - 3;
    const double x = between(-rim, rim, places, i, 0);
    const double y = between(-rim, rim, places, i, 1);
    return Eigen::Vector3d(x, y, ground.at(x, y));
  };
  MeshBuilder mesh;
  for (std::uint64_t i = 0; i < kBoulders; ++i) {
    const double small = places.uniform(i, 2);
    mesh.set_pose(placed(place_of(i), 0));
    mesh.mesh(boulder(0.3 + 1.9 * small * small, shapes, i));
    scene.add(SceneLabel::boulder, "boulder " + std::to_string(i + 1), mesh.take());
  }
  MeshBuilder grass;
  for (std::uint64_t i = 0; i < kTufts; ++i)
    grass.mesh(grass_tuft(place_of(1000 + i), between(0.2, 0.6, places, 1000 + i, 2), shapes, 1000 + i));
  const double grass_area = surface_area(grass.built());
  scene.add(SceneLabel::grass, "grass", grass.take());
  scene.fact("boulder_count", kBoulders, "");
  scene.fact("grass_tuft_count", kTufts, "");
  scene.fact("grass_area", grass_area, "m2");
}

// A loop that comes near the middle and the rim in turn.
std::vector<Eigen::Vector2d> wandering(const Area& area) {
  constexpr int kGoals = 16;
  const Eigen::Vector2d middle = (area.low + area.high) / 2;
  std::vector<Eigen::Vector2d> goals;
  for (int i = 0; i <= kGoals; ++i) {
    const double reach = i % 2 == 0 ? 0.4 : 0.22;
    goals.push_back(middle + reach * area.size().cwiseProduct(turned(static_cast<double>(i) / kGoals)));
  }
  return goals;
}

void state_ground(SceneBuilder& scene, const Ground& ground) {
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  for (const Eigen::Vector3d& vertex : scene.scene().ground.vertices) {
    low = std::min(low, vertex.z());
    high = std::max(high, vertex.z());
  }
  const Eigen::Vector2d size = ground.area().size();
  scene.fact("ground_area", surface_area(scene.scene().ground), "m2");
  scene.fact("plan_area", size.x() * size.y(), "m2");
  scene.fact("relief", high - low, "m");
}

}  // namespace

Scene make_terrain(std::uint64_t seed) {
  SceneBuilder scene("terrain", seed);
  const Mesh field = hills(scene);
  scene.scene().ground = field;
  scene.add(SceneLabel::ground, "ground", field);
  const Ground ground(field);
  scatter(scene, ground);
  state_ground(scene, ground);
  walk_outdoors(scene, ground, ground.area(),
                {.cell = 0.4, .clearance = 1.0, .comfort = 2.0, .steepest = kSteepest},
                wandering(ground.area()), {.head = 1.5, .speed = 1.4});
  return scene.take();
}

Scene terrain_scene(const Mesh& mesh) {
  if (mesh.empty()) throw Error(ErrorCode::no_data, "the ground has no faces");
  if (!std::all_of(mesh.vertices.begin(), mesh.vertices.end(),
                   [](const auto& vertex) { return vertex.allFinite(); }))
    throw Error(ErrorCode::wrong_content, "a vertex of the ground is not finite");
  SceneBuilder scene("terrain", 0);
  scene.scene().ground = {.vertices = mesh.vertices, .faces = mesh.faces, .face_columns = {}};
  scene.add(SceneLabel::ground, "ground", scene.scene().ground);
  const Mesh field = scene.scene().ground;
  const Ground ground(field);
  state_ground(scene, ground);
  const double cell = std::max(ground.area().size().maxCoeff() / 300, 1e-3);
  walk_outdoors(
      scene, ground, ground.area(),
      {.cell = cell, .clearance = 2 * cell, .comfort = 6 * cell, .smoothing = 4 * cell, .steepest = 1.0},
      wandering(ground.area()), {.head = 1.5, .speed = 1.4});
  return scene.take();
}

}  // namespace ray
