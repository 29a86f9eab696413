#pragma once
/// Laying out plain text on a terminal, 80 columns wide.

#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace ray::cli {

/// The text with every line indented and broken between words, each paragraph (parted by an empty line) kept;
/// ends with a newline.
[[nodiscard]] std::string wrapped(std::string_view text, std::size_t indent);

/// The paragraphs of a text, each on one line.
[[nodiscard]] std::vector<std::string> paragraphs(std::string_view text);

/// Names on the left and their text on the right, all starting in the same column.
[[nodiscard]] std::string two_columns(const std::vector<std::pair<std::string, std::string>>& rows);

}  // namespace ray::cli
