#pragma once
/// Carving a body out of tetrahedra, from the outside and as deep as a ball of some radius gets, so that what
/// is left has a surface without holes, handles and pinches.

#include "tetrahedra.h"

#include <cstdint>
#include <vector>

namespace ray {

/// By place of a cell, whether it is outside.
///
/// The outside is a ball of cells (in the sphere that infinity closes space to) and stays one: a cell joins
/// it that meets it in one face and whose fourth vertex is not on the surface, or in two faces and whose
/// sixth edge is not on the surface (Boissonnat, "Geometric structures for three-dimensional shape
/// representation", 1984). Vertices never leave the surface. Of all cells that may join, the one with the
/// largest sphere goes first, those of at least the least radius only (squared, in steps). Of cells with the
/// same radius that with the largest vertices goes first, so their places leave no trace. It looks at the
/// outside and its neighbours only. Precondition: `outside` is a ball.
///
/// About 1 µs for each cell that it looks at.
[[nodiscard]] std::vector<std::uint8_t> carve(const Tetrahedra& cells, double least_squared_radius,
                                              const std::vector<Tetrahedra::Index>& outside);

/// The squared radius of a finite cell's sphere: the same bits for the same four points.
[[nodiscard]] double squared_radius_of(const Tetrahedra& cells, Tetrahedra::Index at);

}  // namespace ray
