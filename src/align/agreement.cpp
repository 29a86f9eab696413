#include "agreement.h"

#include <cmath>
#include <limits>

namespace ray::align {

Agreement::Counts& Agreement::Counts::operator+=(const Counts& more) {
  same += more.same, other += more.other, empty += more.empty, unknown += more.unknown;
  squares += more.squares;
  return *this;
}

Agreement& Agreement::operator+=(const Agreement& more) {
  upright += more.upright;
  others += more.others;
  return *this;
}

Agreement agreement_of(std::span<const Patch> patches, const Pose& pose, const Observed& other,
                       double tolerance) {
  constexpr double kAligned = 0.8;  // cosine
  Agreement agreement;
  for (const Patch& patch : patches) {
    const Eigen::Vector3d place = pose * patch.mean, normal = pose.rotation * patch.normal;
    const bool is_flat = patch.is_flat();
    Agreement::Counts& counts = is_flat && std::abs(normal.z()) < 0.5 ? agreement.upright : agreement.others;
    bool beside = false;
    double nearest = std::numeric_limits<double>::infinity();
    other.level.each_near(place, [&](const Patch& surface) {
      beside = true;
      const Eigen::Vector3d apart = surface.mean - place;
      const bool fits = is_flat && surface.is_flat();
      if (fits && surface.normal.dot(normal) < kAligned) return;
      nearest = std::min(nearest, fits ? std::abs(surface.normal.dot(apart)) : apart.norm());
    });
    const bool is_same = nearest < (is_flat ? tolerance : other.level.width());
    if (is_same && is_flat) counts.squares += nearest * nearest;
    (is_same                        ? counts.same
     : beside                       ? counts.other
     : other.free.is_crossed(place) ? counts.empty
                                    : counts.unknown) += 1.0;
  }
  return agreement;
}

}  // namespace ray::align
