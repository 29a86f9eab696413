#pragma once
/// The comment by which a decimated cloud remembers how it was made, so that rayrestore can check it.

#include "cli/match.h"

#include <raycloud/core/cloud_info.h>

#include <optional>
#include <string>

namespace ray::tools {

/// "decimated 10 cm of 16000000 rays", for a command line with WIDTH or N; the number is what the header of
/// the full cloud states.
[[nodiscard]] std::string decimation_note(const cli::Match& match, const CloudInfo& full);

/// Throws Error(wrong_content), which names both, if the decimated cloud says that it was decimated, but not
/// in this way. One that says nothing is believed.
void check_decimation(const CloudInfo& decimated, const std::string& path, const std::string& note);

}  // namespace ray::tools
