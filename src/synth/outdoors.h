#pragma once
/// What grows and lies on the ground, and the walk between.

#include "fractal.h"
#include "ground.h"
#include "scene_builder.h"
#include "tree_mesh.h"
#include "walk.h"

#include <string>
#include <vector>

namespace ray {

/// Several thin stems in a cloud of leaves, at the origin. Sheets and closed tubes.
struct Shrub {
  Mesh mesh;
  double leaf_area = 0.0;  ///< m2
};
[[nodiscard]] Shrub grow_shrub(double height, const RandomStream& random, std::uint64_t index);

/// A lump of about the given radius, closed, its middle a little above z = 0.
[[nodiscard]] Mesh boulder(double radius, const RandomStream& random, std::uint64_t index);

/// Blades of grass around a point of the ground: sheets.
[[nodiscard]] Mesh grass_tuft(const Eigen::Vector3d& place, double height, const RandomStream& random,
                              std::uint64_t index);

/// A stem along the ground with stubs of branches: closed tubes. `from` and `to` are places of the plane.
[[nodiscard]] Mesh fallen_trunk(const Ground& ground, const Eigen::Vector2d& from, const Eigen::Vector2d& to,
                                double radius, const RandomStream& random, std::uint64_t index);

/// Adds a tree as objects "tree N trunk", "… branches", "… leaves", and to the scene's forest with the
/// attributes height, crown_radius, leaf_area and wood_volume after those it has.
void add_tree(SceneBuilder& scene, Tree tree, const Foliage& foliage, const RandomStream& leaves);
/// Names those attributes. Before the first add_tree.
void name_tree_attributes(Forest& forest);
/// States tree count, leaf area, wood volume (from the tree file, and from the mesh), and the volume that
/// programs find which take each segment for a cylinder of its radius.
void state_tree_facts(SceneBuilder& scene);

/// Puts the path and the stations along the goals, clear of all objects but ground and grass.
/// Error wrong_content if there is nowhere to walk.
void walk_outdoors(SceneBuilder& scene, const Ground& ground, const Area& area, const WalkOptions& options,
                   const std::vector<Eigen::Vector2d>& goals, const Walk& walk);

/// Rows to and fro over an area: `rows` of them, `columns` goals each, moved aside by up to `jitter` m.
[[nodiscard]] std::vector<Eigen::Vector2d> meander(const Area& area, int rows, int columns, double jitter,
                                                   const RandomStream& random);

}  // namespace ray
