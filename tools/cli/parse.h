#pragma once
/// From the words of a command line to a Match with one of the command's usages.

#include "cli/command.h"
#include "cli/match.h"

#include <cstddef>
#include <span>
#include <string>

namespace ray::cli {

/// Matches `arguments` (without the command's name) against the table. Where several usages fit, literal
/// words are preferred to numbers and numbers to file names, from left to right; then the earlier usage. A
/// word that is a literal or unit of the command is never taken for a file: write `./rays` for a file of that
/// name. Options may stand anywhere;
/// `--` ends them; `-5` and `-1,2,3` are values.
///
/// Throws UsageError, and nothing else whatever the arguments are. `command` must outlive the result.
[[nodiscard]] Match parse(const Command& command, std::span<const std::string> arguments);

}  // namespace ray::cli
