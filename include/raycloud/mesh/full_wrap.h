#pragma once
/// The wrap with overhangs (paper, section VIII-I, `--full`): a ball of a given curvature rolls over the
/// ends.

#include <raycloud/mesh/wrap.h>

namespace ray {

/// The body of the ends, all tetrahedra of Delaunay between them, is carved from the given side, as long as a
/// ball of at least 1 / curvature fits around a tetrahedron without an end in it, the largest first. From
/// below (`upwards`) or above (`downwards`) the mesh is a disc with fronts upwards, whose border is that of
/// the map; from all around (`inwards`) a sphere; from the middle of the starts (`outwards`) a sphere with
/// all ends outside. Fronts of spheres are outside.
///
/// Guaranteed, as all decisions are exact: no end is on the wrong side of the mesh, and none is cut off; it
/// has no holes, handles, pinched vertices or edges of three faces, and does not intersect itself; each face
/// has, on the side the ball comes from, a ball through its corners that holds no end and has at most the
/// curvature. As the mesh has to stay a disc or a sphere, the ball does not go on where two of its fronts
/// meet.
///
/// Ends are moved to a lattice of 2^-30 of the longest side of their bounds; vertices are places of it. Only
/// those ends are triangulated that the ball may touch and that prove it. Reads the source twice. Memory: 50
/// bytes an end, and 300 for each that is triangulated; time: some 5 µs for each of them. The mesh depends
/// on neither threads nor the order of rays.
///
/// Ends in one plane: upwards and downwards the wrap is the fast one (`mesh/wrap.h`). Throws as that does;
/// out_of_range if no such ball fits around the middle.
[[nodiscard]] Wrap full_wrap(const Context& context, RaySource& source, WrapDirection direction,
                             double curvature);

}  // namespace ray
