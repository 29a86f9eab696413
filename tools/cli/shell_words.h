#pragma once
/// Command lines as people type them: quoting a word, splitting an example.

#include <string>
#include <string_view>
#include <vector>

namespace ray::cli {

/// The word as it can be shown in one line and typed in a shell: in single quotes if it has anything special,
/// control characters and broken UTF-8 replaced by `?`.
[[nodiscard]] std::string shell_quoted(std::string_view word);

/// The words between spaces; quotes are not understood.
[[nodiscard]] std::vector<std::string> split_words(std::string_view line);

/// How many columns a line of UTF-8 takes on a terminal, counting each code point as one.
[[nodiscard]] std::size_t columns(std::string_view text);

}  // namespace ray::cli
