/// A living room, a bedroom beside it and a terrace before both.

#include "fractal.h"
#include "indoors.h"
#include "scene_kinds.h"

#include <algorithm>

namespace ray {
namespace {

constexpr double kWall = 0.1;       // m, thin on purpose: both sides are seen
constexpr double kTerrace = -0.15;  // m, height of the ground outside

// The wall between the rooms is at x = 0, the living room at x < 0.
struct RoomPlan {
  double living;   // m, its length
  double bedroom;  // m
  double depth;    // m, of both
  double height;   // m

  Area inside() const { return {{-living, -depth / 2}, {bedroom, depth / 2}}; }
  Area outside() const {
    const Eigen::Vector2d rim(kWall / 2, kWall / 2);
    return {inside().low - rim, inside().high + rim};
  }
};

RoomPlan drawn(const RandomStream& random) {
  return {between(5.2, 6.2, random, 0), between(3.3, 4.0, random, 1), between(4.7, 5.4, random, 2),
          between(2.4, 2.7, random, 3)};
}

void build_shell(SceneBuilder& scene, const RoomPlan& plan) {
  const auto [low, high] = plan.outside();
  const double side = plan.depth - kWall;
  const double length = high.x() - low.x();
  const auto wall = [&](double x0, double y0, double x1, double y1) {
    return Wall{.from = {x0, y0, 0}, .to = {x1, y1, 0}, .height = plan.height, .thickness = kWall};
  };
  const double south = -plan.depth / 2;
  build(scene, {.name = "south wall",
                .wall = wall(low.x(), south, high.x(), south),
                .windows = {{2.4, 4.2, 0.9, 2.1}, {length - 2.6, length - 1.0, 0.9, 2.1}},
                .doors = {{{0.6, 1.6, 0.0, 2.1}, Hinge::left, 0.27}}});
  build(scene, {.name = "north wall",
                .wall = wall(low.x(), -south, high.x(), -south),
                .windows = {{1.8, 3.6, 1.1, 2.1}}});
  build(scene, {.name = "west wall",
                .wall = wall(-plan.living, south + kWall / 2, -plan.living, -south - kWall / 2),
                .windows = {{side / 2 - 0.6, side / 2 + 0.6, 0.9, 2.1}}});
  build(scene, {.name = "east wall",
                .wall = wall(plan.bedroom, south + kWall / 2, plan.bedroom, -south - kWall / 2),
                .windows = {{0.8, 2.0, 0.9, 2.1}}});
  build(scene,
        {.name = "wall between the rooms",
         .wall = wall(0, south + kWall / 2, 0, -south - kWall / 2),
         .doors = {{{0.8, 1.7, 0.0, 2.05}, Hinge::left, between(-0.29, -0.24, scene.random("door"), 0)}}});
  scene.add(SceneLabel::floor, "floor", floor_plate(plan.outside(), -0.12, 0));
  scene.add(SceneLabel::ceiling, "ceiling", floor_plate(plan.outside(), plan.height, plan.height + 0.15));
}

void build_outside(SceneBuilder& scene) {
  const RandomStream random = scene.random("ground");
  const Mesh ground = height_field({{-18, -16}, {18, 16}}, 0.5, [&](double x, double y) {
    const double away = std::max({std::abs(x) - 8, std::abs(y) - 6, 0.0});
    return kTerrace + std::min(away / 6, 1.0) * fractal(random, x, y, {.wavelength = 9, .height = 0.8});
  });
  scene.scene().ground = ground;
  scene.add(SceneLabel::ground, "ground", ground);
}

struct Arrivals {
  std::vector<std::size_t> objects;
};

Arrivals furnish(SceneBuilder& scene, const RoomPlan& plan) {
  const RandomStream random = scene.random("furniture");
  const double north = plan.depth / 2 - kWall / 2 - 0.02;
  const double west = -plan.living + kWall / 2 + 0.02;
  const double east = plan.bedroom - kWall / 2 - 0.02;
  Furnisher furnisher(scene);
  const Eigen::Vector3d middle(-plan.living * 0.45, -0.25, 0);
  furnisher.put("table", table(1.6, 0.9), middle, 0);
  for (std::uint64_t i = 0; i < 4; ++i) {
    const double side = i < 2 ? 1.0 : -1.0;
    const Eigen::Vector3d seat(i % 2 == 0 ? -0.4 : 0.4, side * between(0.5, 0.7, random, i), 0);
    furnisher.put("chair", chair(), middle + seat, (i < 2 ? 0.0 : 0.5) + between(-0.04, 0.04, random, i, 1));
  }
  furnisher.put("sofa", sofa(1.9), {-plan.living * 0.45, north - 0.43, 0}, 0);
  furnisher.put("shelf", shelf(1.2, 1.9, 6), {west + 0.17, north - 0.8, 0}, 0.25);
  furnisher.put("floor lamp", floor_lamp(), {-0.4, north - 0.35, 0}, 0);
  furnisher.put("pot plant", pot_plant(), {west + 0.3, -north + 0.35, 0}, random.uniform(9));
  furnisher.put("ceiling lamp", ceiling_lamp(0.5), middle + Eigen::Vector3d(0, 0, plan.height), 0);
  furnisher.put("bed", bed(), {east - 1.1, north - 1.08, 0}, 0);
  furnisher.put("wardrobe", wardrobe(1.2), {0.72, north - 0.31, 0}, 0);
  furnisher.put("bedside table", table(0.4, 0.4), {east - 0.12, north - 0.25, 0}, 0);
  Arrivals arrivals;
  arrivals.objects.push_back(scene.scene().objects.size());
  furnisher.put("armchair", sofa(0.95), {-0.75, -north + 0.72, 0}, 0.625);
  arrivals.objects.push_back(scene.scene().objects.size());
  furnisher.put("cardboard boxes", boxes(), {east - 0.45, -north + 0.35, 0}, 0.02);
  return arrivals;
}

std::vector<Eigen::Vector3d> way_through(const Scene& scene, const RoomPlan& plan) {
  const auto [low, high] = plan.outside();
  const Area area{{low.x() - 2, low.y() - 3}, {high.x() + 2, high.y() + 1}};
  WalkMap map(
      area,
      [low = low, high = high](double x, double y) -> std::optional<double> {
        return x > low.x() && x < high.x() && y > low.y() && y < high.y() ? 0.0 : kTerrace;
      },
      indoor_walk());
  for (const SceneObject& object : scene.objects) {
    if (object.label != SceneLabel::ground) map.add_obstacle(object.mesh);
  }
  const double table_x = -plan.living * 0.45;
  const double door_x = -plan.living + 1.1;
  const double door_y = -plan.depth / 2 + 1.25;
  return map.route({{table_x - 1.4, 0.6},
                    {table_x, 1.05},
                    {table_x + 1.5, 0.2},
                    {table_x, -1.4},
                    {table_x - 1.5, -0.3},
                    {table_x, 1.05},
                    {-0.8, 0.4},
                    {0.7, door_y},
                    {1.2, 0.5},
                    {plan.bedroom - 0.8, -0.8},
                    {1.3, -1.2},
                    {0.5, door_y},
                    {-0.9, door_y},
                    {table_x, -1.3},
                    {door_x, -plan.depth / 2 + 0.4},
                    {door_x, low.y() - 1.2},
                    {0.5 * plan.bedroom, low.y() - 1.6},
                    {table_x, low.y() - 0.8},
                    {door_x, low.y() - 0.6},
                    {door_x, -plan.depth / 2 + 0.6},
                    {table_x - 1.4, 0.6},
                    {table_x, 1.05},
                    {-0.7, door_y},
                    {1.2, -0.2}});
}

}  // namespace

Scene make_room(std::uint64_t seed) {
  SceneBuilder scene("room", seed);
  const RoomPlan plan = drawn(scene.random("plan"));
  build_shell(scene, plan);
  build_outside(scene);
  const Arrivals arrivals = furnish(scene, plan);
  const std::vector<Eigen::Vector3d> way = way_through(scene.scene(), plan);
  scene.scene().path = walked(way, {.head = 1.4, .speed = 1.0});
  scene.scene().stations = stations_along(way, 6, 1.7);
  const double half_time = scene.scene().path.times.back() / 2;
  for (const std::size_t object : arrivals.objects)
    scene.scene().objects[object].present.first = half_time;

  const auto size = plan.inside().size();
  scene.fact("floor_area", (size.x() - 2 * kWall) * (size.y() - kWall), "m2");
  scene.fact("room_height", plan.height, "m");
  scene.fact("wall_thickness", kWall, "m");
  scene.fact("furniture_count", count_of(scene.scene(), SceneLabel::furniture), "");
  scene.fact("arrival_count", static_cast<double>(arrivals.objects.size()), "");
  scene.fact("arrival_time", half_time, "s");
  scene.fact("path_length", length_of(scene.scene().path), "m");
  return scene.take();
}

}  // namespace ray
