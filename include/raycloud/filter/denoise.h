#pragma once
/// Rays whose end points are noise, taken out (paper, section VIII-C).

#include <raycloud/core/units.h>
#include <raycloud/exec/context.h>
#include <raycloud/exec/stream.h>

#include <cstdint>
#include <variant>

namespace ray {

/// Ends with fewer than `min_neighbours` others within `distance` (inclusive).
struct FarFromOthers {
  Metres distance;
  unsigned min_neighbours = 1;
};

/// Ends further from the surface of their neighbours than so many standard deviations of it; and those that
/// are alone where other rays go through, but wires stay.
struct OutsideNeighbours {
  double sigmas = 3.0;
};

/// Ends between two surfaces, where one beam met both: further than `distance` from the nearest of the beams
/// around it, along the ray.
struct OnRangeEdges {
  Metres distance;
};

using Noise = std::variant<FarFromOthers, OutsideNeighbours, OnRangeEdges>;

struct Denoised {
  StreamCounts counts;
  bool in_scan_order = true;  ///< OnRangeEdges: false where neighbours in space had to do
};

/// Leaves out bounded rays with noise for an end. Unbounded rays stay, in order, and everything keeps every
/// bit.
///
/// Neighbourhood shape: reads twice, OutsideNeighbours four times, rewinding in between. The result depends
/// neither on threads nor on memory. Leaves `sink->finish()` to the caller. Throws Error(usage) for distances
/// and sigmas that are not above 0.
Denoised remove_noise(const Context& context, RaySource& source, RaySink& sink, const Noise& noise);

}  // namespace ray
