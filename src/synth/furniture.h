#pragma once
/// Furniture in real sizes (m), made of closed boxes. Each piece stands on z = 0 around the origin and faces
/// −y; a pose puts it where it belongs. Parts touch or overlap as carpentry does.

#include "shapes.h"

namespace ray {

[[nodiscard]] Mesh table(double width, double depth);
[[nodiscard]] Mesh chair();
/// Its back is at y = depth / 2.
[[nodiscard]] Mesh sofa(double width);
/// An open bookcase of `boards` boards with books on them.
[[nodiscard]] Mesh shelf(double width, double height, int boards);
[[nodiscard]] Mesh wardrobe(double width);
/// The head is at y = 1.
[[nodiscard]] Mesh bed();
[[nodiscard]] Mesh desk();
/// A foot, a rod and a shade.
[[nodiscard]] Mesh floor_lamp();
/// Hangs from z = 0.
[[nodiscard]] Mesh ceiling_lamp(double cord);
/// Two cardboard boxes on each other.
[[nodiscard]] Mesh boxes();
/// A pot with a plant of leaves that are sheets.
[[nodiscard]] Mesh pot_plant();

/// The mesh moved.
[[nodiscard]] Mesh moved(const Mesh& mesh, const Pose& pose);

}  // namespace ray
