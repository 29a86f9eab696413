#pragma once
/// Moving a cloud where it lies: raytranslate and rayrotate.

#include "cli/session.h"

#include <raycloud/core/pose.h>
#include <raycloud/core/units.h>

#include <filesystem>

namespace ray::tools {

/// Replaces the cloud by the moved one, flushed to the disk first, so that whatever happens one of the two is
/// there. A move by nothing leaves the file alone. A move keeps 10 µm, finer than the 0.1 mm of a file, so
/// that a hundred moves there and back stay within that.
void move_in_place(cli::Session& session, const std::filesystem::path& cloud, const Pose& pose,
                   Seconds time_shift);

}  // namespace ray::tools
