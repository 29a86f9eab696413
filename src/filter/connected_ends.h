#pragma once
/// Which points hang together.

#include "cell_grid.h"

#include <raycloud/exec/context.h>

#include <vector>

namespace ray {

/// A point of a connected set is in one of its cells, and no point of another set is.
struct ConnectedCells {
  CellGrid grid;
  std::vector<std::uint64_t> keys;
};

/// The cells of the largest connected set of points; of equal ones, that of the earliest point. Points nearer
/// than `gap` are connected. Each cell is so small that all of its points are.
[[nodiscard]] ConnectedCells largest_connected_set(const Context& context,
                                                   std::vector<Eigen::Vector3d> points, double gap);

}  // namespace ray
