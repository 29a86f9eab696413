#pragma once
/// A world with known truth: surfaces, what they are, and when they are there.

#include <raycloud/core/forest.h>
#include <raycloud/core/mesh.h>
#include <raycloud/core/trajectory.h>

#include <cstdint>
#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace ray {

/// What a surface belongs to. The numbers are written into files: never change one.
enum class SceneLabel : std::uint8_t {
  nothing = 0,  ///< no surface: the end of an unbounded ray
  ground = 1,
  wall = 2,
  floor = 3,
  ceiling = 4,
  door = 5,
  window_frame = 6,
  furniture = 7,
  stairs = 8,
  trunk = 9,
  branch = 10,
  leaf = 11,
  understorey = 12,
  fallen_trunk = 13,
  boulder = 14,
  grass = 15,
  crop = 16,
  fence = 17,
  hedge = 18,
  person = 19,
  vehicle = 20
};
/// The name as in the enumeration.
[[nodiscard]] std::string label_name(SceneLabel label);

/// One thing of the world. Times are seconds since the scan began.
struct SceneObject {
  std::int32_t id = 0;  ///< its index in Scene::objects
  SceneLabel label = SceneLabel::nothing;
  std::string name;
  Mesh mesh;  ///< where the object stands at rest, or relative to its motion
  /// Present from `first` (included) to `second` (excluded).
  std::pair<double, double> present{-std::numeric_limits<double>::infinity(),
                                    std::numeric_limits<double>::infinity()};
  Trajectory motion;  ///< with orientations: mesh to world; empty for what never moves
  /// True for what moves or comes or goes: the `moving` column.
  [[nodiscard]] bool is_transient() const;
};

/// A number that the scene was built to have, with its unit: "leaf_area", 12.3, "m2".
struct SceneFact {
  std::string name;
  double value = 0.0;
  std::string unit;
};

/// Everything that is ever there. `ground` is the bare ground of outdoor scenes (a copy of the ground
/// object's mesh), `forest` the trees with their true radii.
struct Scene {
  std::string kind;  ///< "room", "forest" …
  std::uint64_t seed = 0;
  std::vector<SceneObject> objects;
  Mesh ground;
  Forest forest;
  std::vector<SceneFact> facts;
  Trajectory path;                        ///< where a moving scanner goes; positions of its head, upright
  std::vector<Eigen::Vector3d> stations;  ///< where a static one stands
};

}  // namespace ray
