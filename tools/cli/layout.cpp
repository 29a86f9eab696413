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

}  // namespace

std::vector<std::string> paragraphs(std::string_view text) {
  std::vector<std::string> found;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find("\n\n"), text.size());
    std::string paragraph;
    for (const std::string& word : split_words(text.substr(0, end))) {
      paragraph += (paragraph.empty() ? "" : " ") + word;
    }
    if (!paragraph.empty()) found.push_back(std::move(paragraph));
    text.remove_prefix(std::min(end + 2, text.size()));
  }
  return found;
}

std::string wrapped(std::string_view text, std::size_t indent) {
  std::string lines;
  for (const std::string& paragraph : paragraphs(text)) {
    lines += (lines.empty() ? "" : "\n") + filled(std::string(indent, ' '), paragraph, indent);
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
