#pragma once
/// The two forms behind mesh/wrap.h.

#include "ends_survey.h"

#include <raycloud/mesh/wrap.h>

namespace ray {

/// Upwards for `sign` 1, downwards for -1. The source is at its beginning.
[[nodiscard]] Wrap wrap_from_below(const Context& context, RaySource& source, const EndsSurvey& survey,
                                   double curvature, double sign);

/// From the outside of a middle for `sign` 1, from the inside for -1.
[[nodiscard]] Wrap wrap_around(const Context& context, RaySource& source, const EndsSurvey& survey,
                               double curvature, double sign);

}  // namespace ray
