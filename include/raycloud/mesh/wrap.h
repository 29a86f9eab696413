#pragma once
/// Wrapping a cloud in a surface (paper, section VIII-I): the end points that a probe of a given curvature
/// can touch from one side, joined by triangles.

#include <raycloud/core/mesh.h>
#include <raycloud/exec/context.h>
#include <raycloud/exec/stream.h>

#include <cstdint>

namespace ray {

enum class WrapDirection : std::uint8_t { upwards, downwards, inwards, outwards };

struct Wrap {
  Mesh mesh;
  StreamCounts stream;
  std::uint64_t bounded = 0;  ///< rays, whose ends are wrapped
  std::uint64_t cut_off = 0;  ///< ends on the wrong side of the mesh by more than 1e-6 of their extent
};

/// The fast form of the wrap: without overhangs, as seen from below (`upwards`), above (`downwards`), or from
/// or towards a middle.
///
/// Upwards, the probe is a paraboloid z = c - curvature/2 ρ² that may stand anywhere: the mesh is the highest
/// surface below all ends that it reaches, a disc with fronts upwards. In plan it is the regular
/// triangulation of the ends with weights -2 z / curvature, and exact: no end lies below it. Downwards is the
/// same from above. Ends are moved to a grid in plan, of 2^-30 of the map's longer side.
///
/// `inwards` and `outwards` probe with conics that have a focus in the middle of the cloud and the given
/// curvature at their apex; the mesh is a sphere with fronts outside. The middle is the mean of the ends for
/// inwards, of the starts for outwards. No end lies outside of the inwards mesh. None lies within the
/// outwards mesh, if the ends are all around the middle, as in a room; where they are not the mesh is no good
/// (it may go through itself), and ends that it cuts off are counted.
///
/// Reads the source three times or more, rewinding it. Memory: what the probe may touch, some 200 bytes an
/// end, which is a few percent of a cloud but all of it for a large curvature. The result depends on neither
/// threads nor chunks. Throws Error(usage) for a curvature that is negative or not finite; Error(no_data)
/// without bounded rays, or if all their ends lie on a line of the map (upwards, downwards) or in a plane
/// (inwards, outwards); Error(out_of_range) outwards, if a ball of that curvature around the middle does not
/// fit between the ends.
[[nodiscard]] Wrap wrap(const Context& context, RaySource& source, WrapDirection direction, double curvature);

}  // namespace ray
