/// Trees of several kinds on rough ground, with all that lies and grows below them.

#include "grow_tree.h"
#include "outdoors.h"
#include "scene_kinds.h"
#include "turn.h"

#include <algorithm>
#include <array>

namespace ray {
namespace {

constexpr double kHalf = 30.0;        // m, of the side of the stand
constexpr double kRim = 15.0;         // m of ground around it
constexpr double kTreeSpacing = 4.0;  // m, at least

struct Spot {
  Eigen::Vector2d place;
  double height;  // m
  std::size_t species;
};

// Dart throwing: a place is taken if no other is near (Poisson disc).
std::vector<Spot> scattered_trees(const RandomStream& random) {
  const auto wanted = 50 + random.below(15, 0, 9);
  std::vector<Spot> spots;
  for (std::uint64_t dart = 1; dart < 5000 && spots.size() < wanted; ++dart) {
    const double size = random.uniform(dart, 2);
    const Spot spot{{between(-kHalf, kHalf, random, dart, 0), between(-kHalf, kHalf, random, dart, 1)},
                    7 + 16 * std::sqrt(size),
                    static_cast<std::size_t>(random.below(3, dart, 3))};
    const bool is_near = std::any_of(spots.begin(), spots.end(), [&](const Spot& other) {
      return (other.place - spot.place).norm() < kTreeSpacing;
    });
    if (!is_near) spots.push_back(spot);
  }
  return spots;
}

void grow_trees(SceneBuilder& scene, const Ground& ground, const std::vector<Spot>& spots) {
  const std::array<const Species*, 3> kinds{&broadleaf(), &conifer(), &birch()};
  const RandomStream sizes = scene.random("sizes");
  name_tree_attributes(scene.scene().forest);
  for (std::size_t i = 0; i < spots.size(); ++i) {
    const Spot& spot = spots[i];
    const Species& species = *kinds[spot.species];
    const double radius = spot.height / species.slenderness / 2 * between(0.85, 1.2, sizes, i);
    const double z = ground.lowest_around(spot.place.x(), spot.place.y(), radius) - 0.02;
    const std::string number = std::to_string(i);
    add_tree(scene,
             grow_tree(species, {{spot.place.x(), spot.place.y(), z}, spot.height, radius},
                       scene.random("growth " + number)),
             species.foliage, scene.random("leaves " + number));
  }
}

bool is_clear(const std::vector<Spot>& spots, const Eigen::Vector2d& place, double distance) {
  return std::none_of(spots.begin(), spots.end(),
                      [&](const Spot& spot) { return (spot.place - place).norm() < distance; });
}

void fell_trunks(SceneBuilder& scene, const Ground& ground, const std::vector<Spot>& spots) {
  constexpr int kFallen = 6;
  const RandomStream random = scene.random("fallen trunks");
  int count = 0;
  for (std::uint64_t dart = 0; dart < 500 && count < kFallen; ++dart) {
    const Eigen::Vector2d from(between(-kHalf, kHalf, random, dart, 0),
                               between(-kHalf, kHalf, random, dart, 1));
    const double length = between(6, 12, random, dart, 2);
    const Eigen::Vector2d to = from + length * turned(random.uniform(dart, 3));
    bool fits = to.cwiseAbs().maxCoeff() < kHalf + 5;
    for (int i = 0; i <= 12 && fits; ++i)
      fits = is_clear(spots, from + (to - from) * i / 12, 1.0);
    if (!fits) continue;
    const double radius = between(0.15, 0.3, random, dart, 4);
    scene.add(SceneLabel::fallen_trunk, "fallen trunk " + std::to_string(++count),
              fallen_trunk(ground, from, to, radius, scene.random("stubs"), dart));
  }
  scene.fact("fallen_trunk_count", count, "");
}

void scatter_undergrowth(SceneBuilder& scene, const Ground& ground, const std::vector<Spot>& spots) {
  constexpr std::uint64_t kShrubs = 90;
  constexpr std::uint64_t kBoulders = 14;
  constexpr std::uint64_t kTufts = 700;
  const RandomStream places = scene.random("undergrowth");
  const RandomStream shapes = scene.random("undergrowth shapes");
  const auto place_of = [&](std::uint64_t i) {
    return Eigen::Vector2d(between(-kHalf, kHalf, places, i, 0), between(-kHalf, kHalf, places, i, 1));
  };
  const auto on_ground = [&](const Eigen::Vector2d& place) {
    return Eigen::Vector3d(place.x(), place.y(), ground.at(place.x(), place.y()));
  };
  double leaf_area = 0.0;
  MeshBuilder mesh;
  for (std::uint64_t i = 0; i < kShrubs; ++i) {
    const Eigen::Vector2d place = place_of(i);
    if (!is_clear(spots, place, 0.7)) continue;
    const Shrub shrub = grow_shrub(between(0.6, 2.0, places, i, 2), shapes, i);
    mesh.set_pose(placed(on_ground(place), 0));
    mesh.mesh(shrub.mesh);
    leaf_area += shrub.leaf_area;
    scene.add(SceneLabel::understorey, "shrub " + std::to_string(i + 1), mesh.take());
  }
  for (std::uint64_t i = 0; i < kBoulders; ++i) {
    const Eigen::Vector2d place = place_of(1000 + i);
    const double radius = between(0.25, 0.9, places, 1000 + i, 2);
    if (!is_clear(spots, place, radius + 0.8)) continue;
    mesh.set_pose(placed(on_ground(place), 0));
    mesh.mesh(boulder(radius, shapes, 1000 + i));
    scene.add(SceneLabel::boulder, "boulder " + std::to_string(i + 1), mesh.take());
  }
  MeshBuilder grass;
  for (std::uint64_t i = 0; i < kTufts; ++i)
    grass.mesh(grass_tuft(on_ground(place_of(2000 + i)), between(0.15, 0.45, places, 2000 + i, 2), shapes,
                          2000 + i));
  scene.add(SceneLabel::grass, "grass", grass.take());
  scene.fact("understorey_leaf_area", leaf_area, "m2");
}

const WalkOptions& forest_walk() {
  static const WalkOptions kOptions{.cell = 0.25, .clearance = 0.6};
  return kOptions;
}

}  // namespace

Scene make_forest(std::uint64_t seed) {
  SceneBuilder scene("forest", seed);
  const RandomStream bumps = scene.random("ground");
  const double tilt = between(0.03, 0.1, bumps, 1, 7);
  const double side = kHalf + kRim;
  const Mesh field = height_field({{-side, -side}, {side, side}}, 0.5, [&](double x, double y) {
    return tilt * x + fractal(bumps, x, y, {.wavelength = 35, .height = 4, .roughness = 0.45, .octaves = 6});
  });
  scene.scene().ground = field;
  scene.add(SceneLabel::ground, "ground", field);
  const Ground ground(field);
  const std::vector<Spot> spots = scattered_trees(scene.random("places"));
  grow_trees(scene, ground, spots);
  fell_trunks(scene, ground, spots);
  scatter_undergrowth(scene, ground, spots);
  state_tree_facts(scene);
  scene.fact("stand_area", 4 * kHalf * kHalf, "m2");
  scene.fact("stem_density", static_cast<double>(spots.size()) / (4 * kHalf * kHalf) * 1e4, "1/ha");
  const double walked = kHalf - 3;
  walk_outdoors(scene, ground, {{-kHalf, -kHalf}, {kHalf, kHalf}}, forest_walk(),
                meander({{-walked, -walked}, {walked, walked}}, 5, 5, 2.5, scene.random("walk")),
                {.head = 1.5, .speed = 1.0});
  return scene.take();
}

}  // namespace ray
