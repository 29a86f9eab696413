#include "text_fields.h"

#include <algorithm>
#include <charconv>
#include <limits>

namespace ray::text {
namespace {

bool is_space(char c) {
  return c == ' ' || c == '\t' || c == '\r';
}

template <class T>
void append_shortest(std::string& text, T value) {
  char digits[32];
  const auto end = std::to_chars(digits, digits + sizeof digits, value).ptr;
  text.append(digits, end);
}

}  // namespace

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && is_space(text.front()))
    text.remove_prefix(1);
  while (!text.empty() && is_space(text.back()))
    text.remove_suffix(1);
  return text;
}

bool is_blank(std::string_view line) {
  return trimmed(line).empty();
}

bool is_comment(std::string_view line) {
  line = trimmed(line);
  return line.starts_with('#') || line.starts_with('%') || line.starts_with("//");
}

std::string_view comment_text(std::string_view line) {
  line = trimmed(line);
  while (!line.empty() && (line.front() == '#' || line.front() == '%' || line.front() == '/'))
    line.remove_prefix(1);
  return trimmed(line);
}

std::string_view take_line(std::string_view& text) {
  const std::size_t end = text.find('\n');
  const std::string_view line = text.substr(0, end);
  text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  return line;
}

char separator_of(std::string_view line) {
  for (const char separator : {';', ','})
    if (line.find(separator) != std::string_view::npos) return separator;
  return ' ';
}

Fields::Fields(std::string_view line, char separator)
    : rest_(trimmed(line)), separator_(separator), at_end_(rest_.empty()) {}

std::optional<std::string_view> Fields::next() {
  if (at_end_) return std::nullopt;
  std::size_t end = 0;
  if (separator_ == ' ') {
    while (end < rest_.size() && !is_space(rest_[end]))
      ++end;
  } else {
    end = std::min(rest_.find(separator_), rest_.size());
  }
  std::string_view field = trimmed(rest_.substr(0, end));
  rest_.remove_prefix(end);
  if (separator_ == ' ') {
    rest_ = trimmed(rest_);
    at_end_ = rest_.empty();
  } else if (rest_.empty()) {
    at_end_ = true;
  } else {
    rest_.remove_prefix(1);
  }
  if (field.size() >= 2 && field.front() == '"' && field.back() == '"')
    field = trimmed(field.substr(1, field.size() - 2));
  return field;
}

std::vector<std::string_view> all_fields(std::string_view line, char separator) {
  std::vector<std::string_view> fields;
  Fields reader(line, separator);
  while (const auto field = reader.next())
    fields.push_back(*field);
  return fields;
}

std::optional<double> number(std::string_view field) {
  if (field.starts_with('+') && !field.starts_with("+-")) field.remove_prefix(1);
  double value = 0.0;
  const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), value);
  if (end != field.data() + field.size() || error == std::errc::invalid_argument) return std::nullopt;
  if (error == std::errc::result_out_of_range) {
    const bool tiny =
        field.find("e-") != std::string_view::npos || field.find("E-") != std::string_view::npos;
    return tiny ? 0.0 : std::numeric_limits<double>::infinity();
  }
  return value;
}

std::string plain_name(std::string_view name) {
  std::string plain;
  for (const char c : trimmed(name)) {
    if (c == '[' || c == '(') break;
    if (c == '_' || c == ' ' || c == '"') continue;
    plain += c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  }
  return plain;
}

std::string quoted(std::string_view field) {
  constexpr std::size_t kMost = 24;
  std::string text = "'";
  for (const char c : field.substr(0, kMost))
    text += c >= ' ' && c <= '~' ? c : '?';
  return text + (field.size() > kMost ? "…'" : "'");
}

void append_number(std::string& text, double value) {
  append_shortest(text, value);
}
void append_number(std::string& text, float value) {
  append_shortest(text, value);
}

}  // namespace ray::text
