#pragma once
/// Heights over a grid of the map: of a ground (DTM), of the tops of what was seen (DSM), and of what lies
/// between them.

#include <raycloud/core/mesh.h>
#include <raycloud/core/raster.h>
#include <raycloud/exec/context.h>
#include <raycloud/exec/stream.h>

#include <cstddef>

namespace ray {

/// The height of the mesh at the middle of each cell, the highest where faces lie above each other; none
/// beyond the mesh. Cells begin at multiples of their width, so rasters of neighbouring maps fit together.
/// O(faces + cells) time, 4 bytes a cell. Throws Error(usage) for a width that is not above 0,
/// Error(no_data) for a mesh without faces, and Error(out_of_range) if more than `most_cells` would be
/// needed.
[[nodiscard]] Raster height_raster(const Mesh& mesh, double cell, std::size_t most_cells);

/// The highest end of a bounded ray in each cell of `frame`, whose values do not matter. Reads the source to
/// its end. 4 bytes a cell.
[[nodiscard]] Raster surface_raster(const Context& context, RaySource& source, const Raster& frame);

/// surface - ground, not below 0; none where one of them has none. Precondition: the same frame.
[[nodiscard]] Raster canopy_raster(const Raster& surface, const Raster& ground);

}  // namespace ray
