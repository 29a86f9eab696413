#pragma once
/// Moving a whole cloud in space and time.

#include <raycloud/core/bend.h>
#include <raycloud/core/pose.h>
#include <raycloud/core/units.h>
#include <raycloud/exec/context.h>
#include <raycloud/exec/stream.h>

namespace ray {

/// Applies `pose` to starts and ends and adds `time_shift` to the times, in double. What does not move keeps
/// every bit: nothing changes under the identity and a shift of 0.
///
/// Streaming; memory: the chunks. The result depends on neither threads nor chunks. Reads `source` from where
/// it stands to its end and leaves `sink->finish()` to the caller. Throws Error(usage) if pose or shift are
/// not finite.
StreamCounts transform_cloud(const Context& context, RaySource& source, RaySink& sink, const Pose& pose,
                             Seconds time_shift = {});

/// As above, without a shift of the times, and then bends: see bend_rays.
StreamCounts transform_cloud(const Context& context, RaySource& source, RaySink& sink, const Pose& pose,
                             const Bend& bend);

}  // namespace ray
