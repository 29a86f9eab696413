#pragma once
/// How strongly the evidence of an ellipsoid says that it was there only for a time.

#include <raycloud/volume/free_space.h>

namespace ray {

/// Share of the rays that met the ellipsoid and ended in it; that of its own point is left out where there
/// are others.
[[nodiscard]] float opacity_of(const Evidence& evidence);

/// The numbers of rays, `n` of the paper, below which the rays that passed earlier than the first hit, and
/// later than the last, are a contradiction: passes · opacity > n.
struct Transience {
  float before = 0.0F;
  float after = 0.0F;
};

/// The paper's: the opacity is that of all rays.
[[nodiscard]] Transience paper_transience(const Evidence& evidence);

/// Ours: the opacity is that of the time between hits, taken low where little is known of it (the lower bound
/// of Wilson's interval, 1927), and passes count as three for each look at most, and only from two looks.
[[nodiscard]] Transience transience_of(const Evidence& evidence);

}  // namespace ray
