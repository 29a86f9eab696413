#pragma once
/// What rooms and buildings are put together from.

#include "furniture.h"
#include "plate.h"
#include "scene_builder.h"
#include "walk.h"

#include <map>
#include <string>
#include <vector>

namespace ray {

struct Door {
  Opening opening;
  Hinge hinge = Hinge::left;
  double turns = 0.25;  ///< whole turns, as door_mesh
};

/// A wall with what is in it.
struct WallPlan {
  std::string name;
  Wall wall;  ///< `openings` are those without window or door
  std::vector<Opening> windows = {};
  std::vector<Door> doors = {};
};
/// The wall, its window frames and its door leaves, each an object of its own.
void build(SceneBuilder& scene, const WallPlan& plan);

/// A horizontal plate between two heights, with holes measured from its low corner.
[[nodiscard]] Mesh floor_plate(const Area& area, double bottom, double top,
                               const std::vector<Opening>& holes = {});

/// A person among walls: 25 cm from anything.
[[nodiscard]] WalkOptions indoor_walk();

/// Adds furniture; a second piece of one kind is called "chair 2".
class Furnisher {
 public:
  explicit Furnisher(SceneBuilder& scene) : scene_(scene) {}
  /// At a place on a floor, turned by whole turns.
  SceneObject& put(const std::string& kind, const Mesh& mesh, const Eigen::Vector3d& place, double turns);

 private:
  SceneBuilder& scene_;
  std::map<std::string, int> count_;
};

/// The number of objects with a label.
[[nodiscard]] double count_of(const Scene& scene, SceneLabel label);
/// The length of a path in m.
[[nodiscard]] double length_of(const Trajectory& path);

}  // namespace ray
