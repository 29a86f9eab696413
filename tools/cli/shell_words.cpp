#include "cli/shell_words.h"

#include <algorithm>
#include <sstream>

namespace ray::cli {
namespace {

bool is_continuation(char c) {
  return (static_cast<unsigned char>(c) & 0xC0u) == 0x80u;
}

/// Bytes of the UTF-8 code point at the front, 0 if it is broken.
std::size_t code_point_size(std::string_view text) {
  const auto lead = static_cast<unsigned char>(text.front());
  const std::size_t size = lead < 0x80u ? 1 : lead >= 0xF0u ? 4 : lead >= 0xE0u ? 3 : lead >= 0xC2u ? 2 : 0;
  if (size == 0 || size > text.size() || lead > 0xF4u) return 0;
  const std::string_view rest = text.substr(1, size - 1);
  return std::all_of(rest.begin(), rest.end(), is_continuation) ? size : 0;
}

std::string printable(std::string_view text) {
  std::string clean;
  while (!text.empty()) {
    const std::size_t size = code_point_size(text);
    const auto first = static_cast<unsigned char>(text.front());
    const bool control = first < 0x20u || first == 0x7Fu || (first == 0xC2u && size == 2 && text[1] < '\xA0');
    clean += size == 0 || control ? std::string_view("?") : text.substr(0, size);
    text.remove_prefix(std::max<std::size_t>(size, 1));
  }
  return clean;
}

}  // namespace

std::string shell_quoted(std::string_view word) {
  const std::string clean = printable(word);
  constexpr std::string_view kSpecial = " \"'`$&|;<>()*?[]{}!#~\\";
  if (!clean.empty() && clean.find_first_of(kSpecial) == std::string::npos) return clean;
  std::string quoted = "'";
  for (const char c : clean) {
    if (c == '\'') quoted += "'\\'";
    quoted += c;
  }
  return quoted + "'";
}

std::vector<std::string> split_words(std::string_view line) {
  std::istringstream stream{std::string(line)};
  std::vector<std::string> words;
  for (std::string word; stream >> word;)
    words.push_back(word);
  return words;
}

std::size_t columns(std::string_view text) {
  return static_cast<std::size_t>(
      std::count_if(text.begin(), text.end(), [](char c) { return !is_continuation(c); }));
}

}  // namespace ray::cli
