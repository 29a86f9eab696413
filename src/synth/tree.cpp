/// One tree on a patch of ground.

#include "grow_tree.h"
#include "outdoors.h"
#include "scene_kinds.h"
#include "turn.h"

namespace ray {

Scene make_tree(std::uint64_t seed) {
  SceneBuilder scene("tree", seed);
  const RandomStream plan = scene.random("plan");
  const RandomStream bumps = scene.random("ground");
  scene.scene().ground = height_field({{-16, -16}, {16, 16}}, 0.25, [&](double x, double y) {
    return fractal(bumps, x, y, {.wavelength = 12, .height = 0.7});
  });
  const Mesh field = scene.scene().ground;
  const Ground ground(field);
  scene.add(SceneLabel::ground, "ground", field);

  Species species = broadleaf();
  species.whorls = 15;
  species.twigs = 2;
  species.orders = 4;
  species.foliage = {.leaves_per_end = 6, .leaf_area = between(0.003, 0.004, plan, 3), .leaf_length = 0.09};
  const double height = between(9.0, 12.0, plan, 0);
  const double foot_radius = height / 2 / between(34, 44, plan, 1);
  const Eigen::Vector3d foot(0, 0, ground.lowest_around(0, 0, foot_radius) - 0.02);
  name_tree_attributes(scene.scene().forest);
  add_tree(scene, grow_tree(species, {foot, height, foot_radius}, scene.random("growth")), species.foliage,
           scene.random("leaves"));
  state_tree_facts(scene);
  scene.fact("foot_radius", foot_radius, "m");
  scene.fact("height", tree_height(scene.scene().forest.trees.front()), "m");

  std::vector<Eigen::Vector2d> circles;
  for (int i = 0; i <= 24; ++i)  // two turns, from near to far
    circles.push_back((6.0 + 5.0 * i / 24) * Eigen::Vector2d(turned(i / 12.0)));
  walk_outdoors(scene, ground, {{-14, -14}, {14, 14}}, {.cell = 0.2}, circles, {.head = 1.5, .speed = 1.0});
  return scene.take();
}

}  // namespace ray
