#pragma once
/// The hidden `--generate`: everything else that comes from a command's table.

#include "cli/command.h"

#include <span>
#include <string>

namespace ray::cli {

/// `arguments` are `--generate` and one of `man`, `markdown`, `bash`, `zsh`, `fish`, `summary`, or `complete`
/// and the words typed so far. Throws std::logic_error if the table has mistakes, UsageError for another
/// word.
[[nodiscard]] std::string generate(const Command& command, std::span<const std::string> arguments);

/// The manual page in roff, for section 1.
[[nodiscard]] std::string man_page(const Command& command);

/// The page for `docs/`.
[[nodiscard]] std::string markdown_page(const Command& command);

}  // namespace ray::cli
