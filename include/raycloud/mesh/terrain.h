#pragma once
/// The ground under a cloud (paper, section VIII-F), with what grows and stands on it taken off.

#include <raycloud/core/mesh.h>
#include <raycloud/exec/context.h>
#include <raycloud/exec/stream.h>

#include <cstdint>

namespace ray {

struct TerrainOptions {
  double gradient = 1.0;    ///< the steepest that ground is, above 0; 1 is 45 degrees
  double tolerance = 0.02;  ///< m, 0 or more; the mesh is this near to the heights that were found
};

struct Terrain {
  Mesh mesh;
  StreamCounts stream;
  std::uint64_t bounded = 0;  ///< rays, whose ends count
  double cell = 0.0;          ///< m; one height was found for each square of this size
  std::uint64_t heights = 0;  ///< of such squares
};

/// A mesh of the ground: a disc of triangles with fronts upwards, which spans gaps where no ground was seen
/// and ends at the convex hull of where it was. The method is in docs/algorithms/terrain.md: false returns
/// below the ground are told by their lack of company and by rays that seem to come through the ground,
/// things on it by the gradient, by their width and by rays that pass under them, and noise by the height at
/// which most ends lie.
///
/// Reads the source three times, rewinding it. Memory: 100 bytes a cell, which is about two point spacings
/// wide, and 300 more for each that has ends; at most 2^22 cells, and wider ones where that is not enough.
/// The result depends on neither threads nor chunks. Throws Error(usage) for options out of range;
/// Error(no_data) without bounded rays, or where no ground is found (all ends on one line of the map).
[[nodiscard]] Terrain extract_terrain(const Context& context, RaySource& source,
                                      const TerrainOptions& options);

}  // namespace ray
