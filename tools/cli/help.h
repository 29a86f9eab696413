#pragma once
/// What `--help` prints.

#include "cli/command.h"

#include <string>
#include <vector>

namespace ray::cli {

enum class HelpDepth { most_needed, all };

/// Usages with an example each, and the options most people need, or the description and all options.
[[nodiscard]] std::string help(const Command& command, HelpDepth depth);

/// Remarks that follow from the kinds of words a command takes: units of lengths and the like. Empty or one
/// paragraph.
[[nodiscard]] std::string word_remarks(const Command& command);

/// "only with `rayextract trunks CLOUD`", empty for an option of all usages.
[[nodiscard]] std::string takers(const Command& command, const Option& option);

}  // namespace ray::cli
