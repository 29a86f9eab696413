/// Three floors of rooms on both sides of a corridor, joined by a staircase.

#include "building.h"

#include "fractal.h"
#include "scene_kinds.h"

#include <algorithm>

namespace ray {
namespace building {
namespace {

// Rooms lie between these: north of the corridor (the last is the staircase) and south of it.
constexpr std::array kNorthCuts{-kLength / 2, -4.0, 1.0, kStairsWest, kLength / 2};
constexpr std::array kSouthCuts{-kLength / 2, -4.5, 0.0, 4.5, kLength / 2};
constexpr double kCorridor = 1.05;      // m, from its middle to the middle of its walls
constexpr double kCorridorWall = 0.15;  // m

struct Side {
  std::string name;
  double sign;  // of y
  std::span<const double> cuts;
  std::size_t rooms;
};

const std::array<Side, 2>& sides() {
  static const std::array<Side, 2> kSides{{{"north", 1.0, kNorthCuts, 3}, {"south", -1.0, kSouthCuts, 4}}};
  return kSides;
}

void build_outer_walls(SceneBuilder& scene) {
  const double x = kLength / 2 + kOuterWall / 2;
  const double y = kWidth / 2 + kOuterWall / 2;
  const double bottom = kGround - 0.1;
  const double height = kFloors * kStorey + 0.6 - bottom;
  const auto wall = [&](double x0, double y0, double x1, double y1) {
    return Wall{{x0, y0, bottom}, {x1, y1, bottom}, height, kOuterWall, {}};
  };
  for (const Side& side : sides()) {
    WallPlan plan{.name = side.name + " wall",
                  .wall = wall(-x - kOuterWall / 2, side.sign * y, x + kOuterWall / 2, side.sign * y)};
    for (int floor = 0; floor < kFloors; ++floor) {
      const double sill = floor * kStorey + 0.9 - bottom;
      for (std::size_t room = 0; room + 1 < side.cuts.size(); ++room) {
        const bool is_stairs = room == side.rooms;
        const double middle = (side.cuts[room] + side.cuts[room + 1]) / 2 + x + kOuterWall / 2;
        const double rise = is_stairs ? kStorey / 2 : 0.0;
        if (is_stairs && floor + 1 == kFloors) continue;
        plan.windows.push_back({middle - (is_stairs ? 0.6 : 0.9), middle + (is_stairs ? 0.6 : 0.9),
                                sill + rise, sill + rise + 1.3});
      }
    }
    build(scene, plan);
  }
  WallPlan west{.name = "west wall", .wall = wall(-x, -y + kOuterWall / 2, -x, y - kOuterWall / 2)};
  WallPlan east{.name = "east wall", .wall = wall(x, -y + kOuterWall / 2, x, y - kOuterWall / 2)};
  for (int floor = 0; floor < kFloors; ++floor) {
    const double base = floor * kStorey - bottom;
    const double middle = kWidth / 2;
    east.windows.push_back({middle - 0.6, middle + 0.6, base + 0.9, base + 2.2});
    if (floor > 0) west.windows.push_back({middle - 0.6, middle + 0.6, base + 0.9, base + 2.2});
  }
  west.doors.push_back({{kWidth / 2 - 0.55, kWidth / 2 + 0.55, -bottom, 2.15 - bottom}, Hinge::left, -0.26});
  build(scene, west);
  build(scene, east);
}

void build_slabs(SceneBuilder& scene) {
  const Area inside{{-kLength / 2, -kWidth / 2}, {kLength / 2, kWidth / 2}};
  for (int floor = 0; floor <= kFloors; ++floor) {
    const double top = floor * kStorey;
    std::vector<Opening> holes;
    if (floor > 0 && floor < kFloors)
      holes.push_back({kStairsWest + 0.06 + kLength / 2, kLength, kFlightSouth + kWidth / 2, kWidth});
    const bool is_roof = floor == kFloors;
    const std::string number = std::to_string(floor);
    scene.add(SceneLabel::floor, is_roof ? "roof" : "floor " + number,
              floor_plate(inside, top - kSlab / 2, top, holes));
    if (floor > 0)
      scene.add(SceneLabel::ceiling, "ceiling below floor " + number,
                floor_plate(inside, top - kSlab, top - kSlab / 2, holes));
  }
}

// Doors into the rooms that the walk visits stand open.
bool is_visited(int floor, const Side& side, std::size_t room) {
  return (static_cast<std::size_t>(floor) + room + (side.sign > 0 ? 0 : 1)) % 2 == 0;
}

void build_corridor_wall(SceneBuilder& scene, const RandomStream& random, int floor, const Side& side) {
  const double base = floor * kStorey;
  WallPlan plan{.name = "corridor wall " + side.name + ", floor " + std::to_string(floor),
                .wall = {.from = {-kLength / 2, side.sign * kCorridor, base},
                         .to = {kLength / 2, side.sign * kCorridor, base},
                         .height = kStorey - kSlab,
                         .thickness = kCorridorWall}};
  for (std::size_t room = 0; room < side.rooms; ++room) {
    const double left = side.cuts[room] + kLength / 2 + 0.6;
    const auto key = static_cast<std::uint64_t>(floor) * 16 + room + (side.sign > 0 ? 0 : 8);
    const double open = is_visited(floor, side, room) ? between(0.23, 0.29, random, key) : 0.004;
    plan.doors.push_back({{left, left + 0.95, 0.0, 2.05}, Hinge::left, side.sign * open});
  }
  if (side.sign > 0)  // the staircase is open to the corridor
    plan.wall.openings.push_back({kStairsWest + 0.05 + kLength / 2, kLength, 0.0, 2.4});
  build(scene, plan);
}

void build_partitions(SceneBuilder& scene, int floor, const Side& side) {
  const double base = floor * kStorey;
  for (std::size_t cut = 1; cut + 1 < side.cuts.size(); ++cut) {
    WallPlan plan{
        .name = "partition " + side.name + " " + std::to_string(cut) + ", floor " + std::to_string(floor),
        .wall = {.from = {side.cuts[cut], side.sign * (kCorridor + kCorridorWall / 2), base},
                 .to = {side.cuts[cut], side.sign * kWidth / 2, base},
                 .height = kStorey - kSlab,
                 .thickness = cut == 2 ? 0.2 : 0.1}};
    if (cut == 1) plan.wall.openings.push_back({2.2, 3.2, 0.0, 2.05});  // a way from room to room
    build(scene, plan);
  }
}

// Furniture of a room whose outer wall is north of its middle.
void furnish(Furnisher& furnisher, int kind, const Eigen::Vector3d& middle, double half_width,
             bool is_turned) {
  const Pose frame = placed(middle, is_turned ? 0.5 : 0.0);
  const double north = (kWidth / 2 - kCorridor) / 2 - 0.1;
  const auto put = [&](const std::string& name, const Mesh& mesh, double x, double y, double turns) {
    furnisher.put(name, mesh, frame * Eigen::Vector3d(x, y, 0), turns + (is_turned ? 0.5 : 0.0));
  };
  const double east = half_width - 0.15;
  switch (kind) {
    case 0:  // office
      put("desk", desk(), 0.2, north - 0.45, 0.5);
      put("chair", chair(), 0.1, north - 1.2, 0.47);
      put("shelf", shelf(1.2, 1.9, 6), east - 0.2, -0.6, 0.75);
      put("pot plant", pot_plant(), east - 0.35, north - 0.35, 0.1);
      break;
    case 1:  // meeting room
      put("table", table(1.8, 0.9), 0.2, 0.45, 0);
      for (const double x : {-0.5, 0.2, 0.9}) {
        put("chair", chair(), x, 1.1, 0.01);
        put("chair", chair(), x, -0.2, 0.49);
      }
      break;
    case 2:  // bedroom
      put("bed", bed(), 0.3, north - 1.1, 0);
      put("wardrobe", wardrobe(1.2), east - 0.34, -0.8, 0.75);
      put("floor lamp", floor_lamp(), east - 0.3, north - 0.3, 0);
      break;
    default:  // lounge
      put("sofa", sofa(1.9), 0.1, north - 0.5, 0);
      put("table", table(1.0, 0.6), 0.1, north - 1.5, 0);
      put("pot plant", pot_plant(), east - 0.4, north - 0.4, 0.3);
      put("shelf", shelf(0.9, 1.4, 4), east - 0.2, -0.7, 0.75);
      break;
  }
}

void build_floor(SceneBuilder& scene, Furnisher& furnisher, int floor) {
  const RandomStream random = scene.random("floors");
  for (const Side& side : sides()) {
    build_corridor_wall(scene, random, floor, side);
    build_partitions(scene, floor, side);
    for (std::size_t room = 0; room < side.rooms; ++room) {
      const auto key = static_cast<std::uint64_t>(floor) * 16 + room + (side.sign > 0 ? 0 : 8);
      const Eigen::Vector3d middle((side.cuts[room] + side.cuts[room + 1]) / 2,
                                   side.sign * (kCorridor + kWidth / 2) / 2, floor * kStorey);
      furnish(furnisher, static_cast<int>(random.below(4, key, 1)), middle,
              (side.cuts[room + 1] - side.cuts[room]) / 2, side.sign < 0);
    }
  }
}

void build_outside(SceneBuilder& scene) {
  const RandomStream random = scene.random("ground");
  const Mesh ground = height_field({{-35, -30}, {35, 30}}, 0.5, [&](double x, double y) {
    const double away = std::max({std::abs(x) - 13, std::abs(y) - 10, 0.0});
    return kGround + std::min(away / 8, 1.0) * fractal(random, x, y, {.wavelength = 15, .height = 1.2});
  });
  scene.scene().ground = ground;
  scene.add(SceneLabel::ground, "ground", ground);
}

using Way = std::vector<Eigen::Vector3d>;

std::optional<double> floor_at(int floor, double x, double y) {
  if (std::abs(x) < kLength / 2 + kOuterWall && std::abs(y) < kWidth / 2 + kOuterWall) {
    if (x > kStairsWest && y > kFlightSouth) return std::nullopt;
    return floor * kStorey;
  }
  if (floor > 0) return std::nullopt;
  return kGround;
}

Way way_on(const Scene& scene, int floor) {
  const double rim = floor == 0 ? 5.0 : 0.4;
  const Area area{{-kLength / 2 - rim, -kWidth / 2 - rim}, {kLength / 2 + rim, kWidth / 2 + rim}};
  WalkMap map(
      area, [floor](double x, double y) { return floor_at(floor, x, y); }, indoor_walk());
  for (const SceneObject& object : scene.objects) {
    if (object.label != SceneLabel::ground) map.add_obstacle(object.mesh);
  }
  std::vector<Eigen::Vector2d> goals;
  if (floor == 0) {
    const double x = kLength / 2 + 3;
    const double y = kWidth / 2 + 3;
    goals = {{-x, 0}, {-x, -y}, {0, -y}, {x, -y}, {x, y}, {0, y}, {-x, y}, {-x, 0}, {-kLength / 2 + 0.8, 0}};
  } else {
    goals = {{kFlightEast, kFlightSouth - 0.3}};
  }
  std::vector<Eigen::Vector2d> rooms;
  for (const Side& side : sides()) {
    for (std::size_t room = 0; room < side.rooms; ++room) {
      if (!is_visited(floor, side, room)) continue;
      const double door = side.cuts[room] + 1.07;
      rooms.insert(rooms.end(), {{door, 0},
                                 {door, side.sign * 2.0},
                                 {door + 0.6, side.sign * 3.4},
                                 {door, side.sign * 2.0},
                                 {door, 0}});
    }
  }
  if (floor % 2 == 1) std::reverse(rooms.begin(), rooms.end());
  goals.insert(goals.end(), rooms.begin(), rooms.end());
  goals.emplace_back(kLength / 2 - 1.0, 0);
  if (floor + 1 < kFloors)
    goals.emplace_back(kFlightWest, kFlightSouth - 0.3);
  else
    goals.emplace_back(-kLength / 2 + 1.0, 0);
  return map.route(goals);
}

void append_line(Way& way, const Eigen::Vector3d& to) {
  const Eigen::Vector3d from = way.back();
  const int steps = 1 + static_cast<int>((to - from).norm() / 0.05);
  for (int i = 1; i <= steps; ++i)
    way.push_back(from + (to - from) * i / steps);
}

Way whole_way(const Scene& scene) {
  Way way;
  for (int floor = 0; floor < kFloors; ++floor) {
    const Way here = way_on(scene, floor);
    way.insert(way.end(), here.begin(), here.end());
    if (floor + 1 == kFloors) break;
    const double base = floor * kStorey;
    append_line(way, {kFlightWest, kFlightSouth - 0.2, base});
    append_line(way, {kFlightWest, kFlightNorth, base + kStorey / 2});
    append_line(way, {kFlightWest, kFlightNorth + 0.4, base + kStorey / 2});
    append_line(way, {kFlightWest + 0.4, kFlightNorth + 0.75, base + kStorey / 2});
    append_line(way, {kFlightEast - 0.4, kFlightNorth + 0.75, base + kStorey / 2});
    append_line(way, {kFlightEast, kFlightNorth + 0.4, base + kStorey / 2});
    append_line(way, {kFlightEast, kFlightNorth, base + kStorey / 2});
    append_line(way, {kFlightEast, kFlightSouth - 0.2, base + kStorey});
  }
  return way;
}

}  // namespace
}  // namespace building

Scene make_building(std::uint64_t seed) {
  using namespace building;
  SceneBuilder scene("building", seed);
  build_outer_walls(scene);
  build_slabs(scene);
  Furnisher furnisher(scene);
  for (int floor = 0; floor < kFloors; ++floor)
    build_floor(scene, furnisher, floor);
  build_staircase(scene);
  build_outside(scene);
  const std::vector<Eigen::Vector3d> way = whole_way(scene.scene());
  scene.scene().path = walked(way, {.head = 1.4, .speed = 1.0});
  scene.scene().stations = stations_along(way, 8, 1.7);

  scene.fact("floor_count", kFloors, "");
  scene.fact("storey_height", kStorey, "m");
  scene.fact("slab_thickness", kSlab, "m");
  scene.fact("outer_wall_thickness", kOuterWall, "m");
  scene.fact("footprint", (kLength + 2 * kOuterWall) * (kWidth + 2 * kOuterWall), "m2");
  scene.fact("riser_count", 2.0 * (kFloors - 1) * kRisers, "");
  scene.fact("riser", kStorey / 2 / kRisers, "m");
  scene.fact("furniture_count", count_of(scene.scene(), SceneLabel::furniture), "");
  scene.fact("path_length", length_of(scene.scene().path), "m");
  return scene.take();
}

}  // namespace ray
