#pragma once
/// What is behind mesh/wrap.h and mesh/full_wrap.h.

#include "ends_survey.h"

#include <raycloud/mesh/wrap.h>

namespace ray {

/// Of a source that is then at its beginning again. Throws if there is nothing to wrap, or no such curvature.
[[nodiscard]] EndsSurvey survey_for_wrap(const Context& context, RaySource& source, double curvature);

/// Upwards for `sign` 1, downwards for -1. The source is at its beginning.
[[nodiscard]] Wrap wrap_from_below(const Context& context, RaySource& source, const EndsSurvey& survey,
                                   double curvature, double sign);

/// From the outside of a middle for `sign` 1, from the inside for -1.
[[nodiscard]] Wrap wrap_around(const Context& context, RaySource& source, const EndsSurvey& survey,
                               double curvature, double sign);

}  // namespace ray
