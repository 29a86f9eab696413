#pragma once
/// Mixed pixels: one beam met two surfaces, and its end lies between them.

#include "scan_lines.h"

#include <cstdint>
#include <vector>

namespace ray {

struct RangeEdges {
  std::vector<std::uint8_t> mixed;  ///< 1 for each beam whose end is between two surfaces
  bool in_scan_order = true;        ///< false: the beams did not tell which of them are next to each other
};

/// An end is between two surfaces if its range differs by more than `distance` (m) from those of both beams
/// next to it on its line and lies between them, or differs from both and lies so between the beams of the
/// lines beside it. But not where either beam next to it is on no surface, nor where one of the lines beside
/// has the same range, nor where the ranges before or after it go on as they began, as on a slanted surface.
///
/// Time: that of find_scan_lines, and little. Memory: 9 bytes a beam. Without scan order: about 2 µs a beam
/// and thread, 80 bytes. Precondition: distance > 0.
[[nodiscard]] RangeEdges range_edges(const Context& context, const Beams& beams, double distance);

/// The same without lines: by the eight beams nearest in angle, where the sensor stood still, or nearest in
/// space. (In mixed_in_space.cpp.)
[[nodiscard]] std::vector<std::uint8_t> mixed_in_space(const Context& context, const Beams& beams,
                                                       double distance);

}  // namespace ray
