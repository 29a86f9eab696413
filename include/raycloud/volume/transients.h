#pragma once
/// What is there only for a part of the time: surfaces that other rays have seen through before they came or
/// after they went (paper, section VI-A).

#include <raycloud/core/column.h>
#include <raycloud/exec/stream.h>

#include <cstdint>
#include <vector>

namespace ray {

/// What goes where rays contradict each other (paper, figure 6).
enum class Merge : std::uint8_t {
  min,     ///< what was seen through
  max,     ///< the rays that saw through it
  oldest,  ///< what came later than they, or they if it went
  newest   ///< what had gone before they came, or they if it came later
};

struct TransientRule {
  Merge merge = Merge::min;
  double rays = 10.0;  ///< above 0: so many, divided by the opacity, must have seen through in a row
  bool paper = false;  ///< as the paper has it: every crossing counts, an ellipsoid has only its own evidence
  bool colour = false;  ///< replace red, green and blue by passes, opacity and hits
};

/// The columns of the results: those of the source, and for each ray
///   opacity     float32  share of the rays that met the ellipsoid around its end and ended there
///   hits        uint16   rays that did
///   passes      uint16   rays that went through
///   transience  float32  the most rays for which it would be transient; so with another number of rays the
///                        result is whatever is above that
/// All are 0 for unbounded rays. Throws Error(wrong_content) if a column of the source has one of the names
/// and another type.
[[nodiscard]] std::vector<ColumnInfo> transient_columns(std::vector<ColumnInfo> source);

struct TransientCounts {
  StreamCounts stream;
  std::uint64_t fixed = 0;
  std::uint64_t transient = 0;
};

/// Sends each ray to one of two sinks made with the columns of transient_columns(), in order and, but for
/// those columns, with every bit. Reads `source` four times. The method is that of
/// docs/algorithms/transients.md; neighbourhood shape. O(n log n): about 4 µs of one core a ray; 130 bytes a
/// bounded ray. Where that is more than context.memory, blocks of space are worked on one after the other, in
/// temporary files, in half as much processor time again: then 10 bytes an end are needed besides, and 4
/// bytes a ray where rays are taken out for what they passed. The result depends neither on threads nor on
/// memory.
///
/// Throws Error(usage) if `rule.rays` is not above 0, Error(no_data) if all bounded rays have one time,
/// Error(out_of_range) for more than 4 billion of them. An empty cloud, or one of unbounded rays only, is
/// fixed.
TransientCounts split_transients(const Context& context, RaySource& source, RaySink& fixed,
                                 RaySink& transient, const TransientRule& rule);

}  // namespace ray
