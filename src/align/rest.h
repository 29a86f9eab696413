#pragma once
/// The last fit of a pose: where it rests, and how well it is held there.

#include "fine.h"
#include "jury.h"

#include <raycloud/exec/context.h>

namespace ray::align {

/// Two clouds, and the jury that judges poses of one on the other.
struct Case {
  const Context& context;
  const Known& cloud;
  const Known& reference;
  const Jury& jury;
};

/// The covariance of turns and shifts: the residuals stand for noise.
[[nodiscard]] Matrix6 covariance_of(const FineFit& fit);

[[nodiscard]] Eigen::Matrix3d shift_covariance(const FineFit& fit);

/// With all patches, and then with narrow ones, where these are wide enough for noise not to make them round.
/// Where they are not: with both together, and with strips of planes, which look round by noise; within twice
/// the distance first, so that it does not matter much from where.
[[nodiscard]] FineFit last_fit(const Context& context, const Known& cloud, const Known& reference,
                               const Pose& start);

/// Whether two poses put the cloud to different places, if only a quarter of a patch apart.
[[nodiscard]] bool is_elsewhere(const Pose& a, const Pose& b, const Known& cloud);

/// The patches leave some way open, by two standard errors, to shift the cloud elsewhere.
[[nodiscard]] bool is_loose(const FineFit& fit, const Known& cloud);

/// Where the last fit rests.
struct Rest {
  Hypothesis place;
  FineFit fit;
};

/// From a hypothesis: it may creep, and then is fitted again.
[[nodiscard]] Rest settled(const Case& of, const Hypothesis& hypothesis);

/// Where nothing holds the best along some way, the places on that way: one of them may be held, which the
/// fits before slid past. They are judged, too.
void look_along(const Case& of, std::vector<Hypothesis>& judged, Rest& best);

}  // namespace ray::align
