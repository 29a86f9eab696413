#pragma once
/// How strongly the evidence of an ellipsoid says that it was there only for a time.

#include <raycloud/volume/free_space.h>

namespace ray {

/// Share of the rays that met the ellipsoid and ended in it. Its own point, without which there would be no
/// ellipsoid, is left out where there are others.
[[nodiscard]] float opacity_of(const Evidence& evidence);

/// The share of rays that ended in it during its episodes.
[[nodiscard]] float opacity_while_there(const Evidence& evidence);

/// Numbers of rays, `n` of the paper, up to which the rays that passed earlier than the first hit, later than
/// the last, and in a pause between hits are a contradiction: passes · opacity >= n.
struct Transience {
  float before = 0.0F;
  float between = 0.0F;
  float after = 0.0F;
};

/// The paper's: the opacity is that of all rays, and pauses do not count.
[[nodiscard]] Transience paper_transience(const Evidence& evidence);

/// Ours: the opacity is that of the episodes, taken low where little is known of it (the lower bound of
/// Wilson's interval, 1927), and passes count as five for each look at most, and only from two looks. A pause
/// does not belong to the episodes if it contradicts them itself.
[[nodiscard]] Transience transience_of(const Evidence& evidence);

/// As that, but every pass counts and the point itself does too: what is enough beside what is surely
/// transient.
[[nodiscard]] Transience hint_of(const Evidence& evidence);

}  // namespace ray
