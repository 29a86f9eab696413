#pragma once
/// Laying out plain text on a terminal, 80 columns wide.

#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace ray::cli {

/// A paragraph on one line, or words and what each means.
struct TextBlock {
  std::string text;
  std::vector<std::pair<std::string, std::string>> words;  ///< empty for a paragraph
};
/// The blocks of a text, parted by empty lines. One of which every line begins with two spaces has a word and
/// its meaning on each.
[[nodiscard]] std::vector<TextBlock> text_blocks(std::string_view text);

/// The text with every line of its paragraphs indented and broken between words, and words in two columns;
/// ends with a newline.
[[nodiscard]] std::string wrapped(std::string_view text, std::size_t indent);

/// Names on the left and their text on the right, all starting in the same column.
[[nodiscard]] std::string two_columns(const std::vector<std::pair<std::string, std::string>>& rows);

}  // namespace ray::cli
