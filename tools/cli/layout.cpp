#include "cli/layout.h"

#include "cli/shell_words.h"

#include <algorithm>

namespace ray::cli {
namespace {

constexpr std::size_t kWidth = 80;

/// `first` and then the words, with a hanging indent from the second line on.
std::string filled(std::string first, std::string_view text, std::size_t indent) {
  std::string lines;
  std::string line = std::move(first);
  bool fresh = true;
  for (const std::string& word : split_words(text)) {
    if (!fresh && columns(line) + 1 + columns(word) > kWidth) {
      lines += line + "\n";
      line = std::string(indent, ' ');
      fresh = true;
    }
    line += (fresh ? "" : " ") + word;
    fresh = false;
  }
  return lines + line + "\n";
}

std::string joined(std::string_view text) {
  std::string line;
  for (const std::string& word : split_words(text))
    line += (line.empty() ? "" : " ") + word;
  return line;
}

std::vector<std::pair<std::string, std::string>> words_of(std::string_view lines) {
  std::vector<std::pair<std::string, std::string>> words;
  while (!lines.empty()) {
    const std::size_t end = std::min(lines.find('\n'), lines.size());
    const std::string line = joined(lines.substr(0, end));
    const std::size_t space = std::min(line.find(' '), line.size());
    if (!line.empty()) words.emplace_back(line.substr(0, space), joined(line.substr(space)));
    lines.remove_prefix(std::min(end + 1, lines.size()));
  }
  return words;
}

}  // namespace

std::vector<TextBlock> text_blocks(std::string_view text) {
  std::vector<TextBlock> found;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find("\n\n"), text.size());
    const std::string_view lines = text.substr(0, end);
    TextBlock block = lines.starts_with("  ") ? TextBlock{{}, words_of(lines)} : TextBlock{joined(lines), {}};
    if (!block.text.empty() || !block.words.empty()) found.push_back(std::move(block));
    text.remove_prefix(std::min(end + 2, text.size()));
  }
  return found;
}

std::string wrapped(std::string_view text, std::size_t indent) {
  std::string lines;
  for (const TextBlock& block : text_blocks(text)) {
    lines += (lines.empty() ? "" : "\n") + (block.words.empty()
                                                ? filled(std::string(indent, ' '), block.text, indent)
                                                : two_columns(block.words));
  }
  return lines;
}

std::string two_columns(const std::vector<std::pair<std::string, std::string>>& rows) {
  std::size_t widest = 0;
  for (const auto& [name, text] : rows)
    widest = std::max(widest, columns(name));
  const std::size_t indent = 2 + widest + 2;
  std::string lines;
  for (const auto& [name, text] : rows) {
    lines += filled("  " + name + std::string(indent - 2 - columns(name), ' '), text, indent);
  }
  return lines;
}

}  // namespace ray::cli
