#include "indoors.h"

#include <algorithm>

namespace ray {

void build(SceneBuilder& scene, const WallPlan& plan) {
  Wall wall = plan.wall;
  wall.openings.insert(wall.openings.end(), plan.windows.begin(), plan.windows.end());
  for (const Door& door : plan.doors)
    wall.openings.push_back(door.opening);
  scene.add(SceneLabel::wall, plan.name, plate_mesh(plate_of(wall)));
  for (std::size_t i = 0; i < plan.windows.size(); ++i)
    scene.add(SceneLabel::window_frame, plan.name + ", window " + std::to_string(i + 1),
              window_mesh(wall, plan.windows[i]));
  for (std::size_t i = 0; i < plan.doors.size(); ++i) {
    const Door& door = plan.doors[i];
    scene.add(SceneLabel::door, plan.name + ", door " + std::to_string(i + 1),
              door_mesh(wall, door.opening, door.hinge, door.turns));
  }
}

Mesh floor_plate(const Area& area, double bottom, double top, const std::vector<Opening>& holes) {
  return plate_mesh({.corner = {area.low.x(), area.low.y(), bottom},
                     .width = area.size().x(),
                     .height = area.size().y(),
                     .thickness = top - bottom,
                     .openings = holes});
}

WalkOptions indoor_walk() {
  return {.cell = 0.1, .clearance = 0.25, .comfort = 0.7, .step = 0.25, .body = 1.85, .smoothing = 0.4};
}

SceneObject& Furnisher::put(const std::string& kind, const Mesh& mesh, const Eigen::Vector3d& place,
                            double turns) {
  const int number = ++count_[kind];
  return scene_.add(SceneLabel::furniture, kind + " " + std::to_string(number),
                    moved(mesh, placed(place, turns)));
}

double count_of(const Scene& scene, SceneLabel label) {
  return static_cast<double>(std::count_if(scene.objects.begin(), scene.objects.end(),
                                           [&](const SceneObject& object) { return object.label == label; }));
}

double length_of(const Trajectory& path) {
  double length = 0.0;
  for (std::size_t i = 1; i < path.size(); ++i)
    length += (path.positions[i] - path.positions[i - 1]).norm();
  return length;
}

}  // namespace ray
