#pragma once
/// Moving a cloud where it lies: raytranslate and rayrotate.

#include "cli/session.h"

#include <raycloud/core/pose.h>
#include <raycloud/core/units.h>

#include <filesystem>

namespace ray::tools {

struct Move {
  Pose pose;
  Seconds time_shift;
  /// The most that a move may lose of a coordinate; beyond it the file becomes double. A hundred moves there
  /// and back must stay within 0.1 mm: rounding repeats itself after a translation (the second trip takes
  /// every point to where the first did) but wanders for a while after rotations, to some 60 times the loss
  /// of one.
  Metres tolerance;
};

/// Replaces the cloud by the moved one, flushed to the disk first, so that whatever happens one of the two is
/// there. A move by nothing leaves the file alone.
void move_in_place(cli::Session& session, const std::filesystem::path& cloud, const Move& move);

}  // namespace ray::tools
