#pragma once
/// A body carved out of points, of which only those are triangulated that have a say.

#include "carving.h"

#include <raycloud/exec/context.h>

#include <functional>
#include <vector>

namespace ray {

struct CarvedBody {
  Tetrahedra cells;
  std::vector<std::uint8_t> outside;  ///< by cell
};

/// The cells that are outside to begin with.
using FirstOutside = std::function<std::vector<Tetrahedra::Index>(const Tetrahedra& cells)>;

/// Carves as if all points were triangulated. Points are added in rounds, each four times the one before, and
/// only those that lie in the sphere of a cell that may have a say in the carving: one that the ball comes
/// to, or a neighbour of one. When no point lies in any such sphere, all these cells are cells of all points,
/// and as carving looks at no others, it is theirs.
///
/// `first_outside` must return the same set for two triangulations that agree on that set, on the neighbours
/// of its cells and on the cells of `witnesses`. Precondition: points near each other follow each other, no
/// two are the same, not all are in one plane.
[[nodiscard]] CarvedBody carve_body(const Context& context, std::span<const LatticePoint> points,
                                    double least_squared_radius, const FirstOutside& first_outside,
                                    const FirstOutside& witnesses);

}  // namespace ray
