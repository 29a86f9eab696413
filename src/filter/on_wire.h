#pragma once
/// Points that lie on something so thin that it has no surface: a wire, a twig, a bar of a railing.

#include <raycloud/spatial/neighbour_search.h>

#include <cstddef>

namespace ray {

/// Whether the point at `place` and others lie on a line, as far as their ranges are noisy.
///
/// A range may be wrong, a direction is not: so points of a wire may be off its line along their rays, but
/// hardly to the side. Lines are tried from the point to each of its 64 nearest others. It is on a wire if on
/// one of the lines
///  - lie two more points, and a sixteenth of those around;
///  - lie, with their ranges, most of the points that do so as seen from the sensor: ends of beams that met
///    two surfaces lie on the edge of the nearer one as seen from there, but are spread along the rays;
///  - there are three times as many as close beside it;
///  - and the point itself is within the noise of the line through the others.
///
/// `search`: in the points that are on no surface. `spacing` (m): of the points on surfaces, the scale of the
/// noise. Some 10 µs. Depends on nothing further away than `reach` (m), nor on the tree.
[[nodiscard]] bool is_on_wire(NeighbourSearch& search, std::size_t place, double spacing, double reach);

}  // namespace ray
