#pragma once
/// Worlds worth scanning: a room, a building, a tree, a forest, a terrain and a field, whose every surface
/// and number is known, and worlds around the trees or the ground of a file. All lengths are in m, z is up,
/// and the generated scenes lie around the origin.
///
/// Deterministic: a seed gives the same bits on every machine. Random numbers come from RandomStream, keyed
/// by what they are for, and only + - * / and square roots are used, never a function of the maths library.
/// What the scenes contain and which facts they state: docs/algorithms/scenes.md.

#include <raycloud/synth/scene.h>

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

namespace ray {

enum class SceneKind : std::uint8_t { room, building, tree, forest, terrain, field };

/// The kind that is called `word`, as in the enumeration.
[[nodiscard]] std::optional<SceneKind> scene_kind(std::string_view word);

/// Builds a scene: at most 3 million triangles (forest), in about a second; up to 100 bytes a triangle.
/// Closed shapes (walls, wood, boulders, furniture, wires) have their fronts outside; leaves, blades and the
/// ground are sheets. The path and the stations keep clear of every surface. The seed may be any number.
[[nodiscard]] Scene make_scene(SceneKind kind, std::uint64_t seed);

/// The given trees on a ground that passes under their feet, with leaves on their thin ends. A tree of one
/// segment (place and radius known, no branches) is grown to its attribute `height`, or to a usual height for
/// its radius. The attribute `leaf_area` (m2), where given and not negative, is met exactly; without it every
/// thin end bears six leaves of 25 cm2. Scene::forest has the trees as built, with their attributes and,
/// besides, `height`, `crown_radius`, `leaf_area` and `wood_volume`. O(trees × ground cells) time. Errors:
/// no_data without trees; wrong_content for a number that is not finite, a radius that is not positive, a
/// parent that is not before its child, or a stand so dense that nobody can walk in it.
[[nodiscard]] Scene forest_scene(const Forest& trees, std::uint64_t seed);

/// The mesh as the ground, with a walk over it where it is wide and flat enough to walk. O(faces + area of
/// the bounding box in steps of 1/300 of its longer side). Errors: no_data without faces; wrong_content if no
/// part of it can be stood on (all of it steeper than 45 degrees).
[[nodiscard]] Scene terrain_scene(const Mesh& ground);

/// Which child continues its parent rather than branches off: for each segment the thickest of its children,
/// the first of equals; TreeSegment::kNoParent for an end.
[[nodiscard]] std::vector<std::size_t> continuations(const Tree& tree);

/// The volume of the wood in m3: the sum of the frusta of all segments. A frustum ends with its segment's
/// radius, and begins with its parent's if it continues the parent (see above), otherwise with its own.
/// Overlaps at forks count twice, as they do in the mesh. O(segments).
[[nodiscard]] double wood_volume(const Tree& tree);

}  // namespace ray
