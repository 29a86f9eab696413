#pragma once
/// Completion in the shell. The scripts are a few lines that ask the command itself what may follow, so that
/// they know exactly the grammar that the parser knows.

#include "cli/command.h"

#include <span>
#include <string>

namespace ray::cli {

/// What the last of `words` may become, given those before it. One line each: `word TAB what it is`, or a
/// line that starts with a TAB for files, with the extensions to offer: `TAB ply laz`, all files if there are
/// none.
[[nodiscard]] std::string complete(const Command& command, std::span<const std::string> words);

/// The scripts. They fall back to file names where the command offers nothing.
[[nodiscard]] std::string bash_completion(const std::string& command);
[[nodiscard]] std::string zsh_completion(const std::string& command);
[[nodiscard]] std::string fish_completion(const std::string& command);

}  // namespace ray::cli
