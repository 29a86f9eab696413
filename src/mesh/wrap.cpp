#include "wrap_forms.h"

#include <raycloud/core/error.h>

#include <algorithm>
#include <cmath>

namespace ray {
namespace {

/// What wraps as the curvature would, with room for its products: the probe's sag across the cloud is then so
/// many times the cloud's size that no more makes a difference.
double sensible(double curvature, const Bounds& bounds) {
  constexpr double kMostSag = 1e30;
  return std::min(curvature, kMostSag / bounds.extent().norm());
}

}  // namespace

EndsSurvey survey_for_wrap(const Context& context, RaySource& source, double curvature) {
  if (!std::isfinite(curvature) || curvature < 0.0)
    throw Error(ErrorCode::usage, "the curvature must be 0 or more");
  const EndsSurvey survey = survey_ends(context, source);
  if (survey.bounded == 0)
    throw Error(ErrorCode::no_data, "has no bounded rays, so there is nothing to wrap");
  source.rewind();
  return survey;
}

Wrap wrap(const Context& context, RaySource& source, WrapDirection direction, double curvature) {
  const EndsSurvey survey = survey_for_wrap(context, source, curvature);
  curvature = sensible(curvature, survey.bounds);
  switch (direction) {
    case WrapDirection::upwards:
      return wrap_from_below(context, source, survey, curvature, 1.0);
    case WrapDirection::downwards:
      return wrap_from_below(context, source, survey, curvature, -1.0);
    case WrapDirection::inwards:
      return wrap_around(context, source, survey, curvature, 1.0);
    case WrapDirection::outwards:
      break;
  }
  return wrap_around(context, source, survey, curvature, -1.0);
}

}  // namespace ray
