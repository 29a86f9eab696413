#pragma once
/// The comment by which a decimated cloud remembers how it was made, so that rayrestore can check it.

#include "cli/match.h"

#include <raycloud/core/cloud_info.h>

#include <cstdint>
#include <optional>
#include <string>

namespace ray::tools {

/// "decimated 10 cm of 000016000000 rays", for a command line with WIDTH or N; the number is what the header
/// of the full cloud states, 0 if it is not known yet. Of the same length for every number, so that a pipe
/// can put it in at the end.
[[nodiscard]] std::string decimation_note(const cli::Match& match, std::optional<std::uint64_t> full_rays);

/// Throws Error(wrong_content), which names both, if the decimated cloud says that it was decimated, but not
/// in this way. One that says nothing is believed. `note` is that of decimation_note().
void check_decimation(const CloudInfo& decimated, const std::string& path, const std::string& note);

}  // namespace ray::tools
