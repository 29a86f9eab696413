#include <raycloud/core/error.h>
#include <raycloud/filter/transform.h>

#include <cmath>

namespace ray {

StreamCounts transform_cloud(const Context& context, RaySource& source, RaySink& sink, const Pose& pose,
                             Seconds time_shift) {
  if (!pose.rotation.allFinite() || !pose.translation.allFinite() || !std::isfinite(time_shift.value)) {
    throw Error(ErrorCode::usage, "a cloud can only be moved by finite numbers");
  }
  const bool moves = !pose.is_identity();
  return stream_each(context, source, sink, [&](RayCloud& rays) {
    if (moves) rays.transform(pose);
    if (time_shift.value == 0.0) return;  // −0 + 0 would change a bit
    for (double& time : rays.times)
      time += time_shift.value;
  });
}

StreamCounts transform_cloud(const Context& context, RaySource& source, RaySink& sink, const Pose& pose,
                             const Bend& bend) {
  if (bend.is_none()) return transform_cloud(context, source, sink, pose);
  if (!pose.rotation.allFinite() || !pose.translation.allFinite() || !bend.centre.allFinite() ||
      !bend.shifts.allFinite())
    throw Error(ErrorCode::usage, "a cloud can only be moved by finite numbers");
  return stream_each(context, source, sink, [&](RayCloud& rays) {
    if (!pose.is_identity()) rays.transform(pose);
    bend_rays(bend, rays);
  });
}

}  // namespace ray
