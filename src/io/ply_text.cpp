#include "ply_text.h"

#include <raycloud/core/error.h>

#include <charconv>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>
#include <string>
#include <type_traits>

namespace ray {
namespace {

bool is_space(char c) {
  return c == ' ' || (c >= '\t' && c <= '\r');
}

template <class T>
std::optional<T> parse_real(std::string_view token) {
  T value{};
  const char* const end = token.data() + token.size();
  const auto [rest, error] = std::from_chars(token.data(), end, value);
  if (error == std::errc::result_out_of_range && rest == end) {
    const bool tiny = token.find("e-") != token.npos || token.find("E-") != token.npos;
    value = tiny ? T{0} : std::numeric_limits<T>::infinity();
    return token.front() == '-' ? -value : value;
  }
  if (error == std::errc() && rest == end) return value;
  // "1.#QNAN", "-1.#IND": how older Windows programs write what is not a number.
  if (token.find('#') != token.npos) return std::numeric_limits<T>::quiet_NaN();
  return std::nullopt;
}

template <class T>
std::optional<T> parse_whole(std::string_view token) {
  T value{};
  const char* const end = token.data() + token.size();
  const auto [rest, error] = std::from_chars(token.data(), end, value);
  if (error == std::errc() && rest == end) return value;
  const auto real = parse_real<double>(token);
  if (!real || std::floor(*real) != *real) return std::nullopt;
  // 2^digits is the first value beyond the type, and exact in a double.
  const double beyond = std::ldexp(1.0, std::numeric_limits<T>::digits);
  if (*real >= beyond || *real < (std::is_signed_v<T> ? -beyond : 0.0)) return std::nullopt;
  return static_cast<T>(*real);
}

template <class T>
std::optional<T> parse_value(std::string_view token) {
  if (token.size() > 1 && token[0] == '+' && token[1] != '-') token.remove_prefix(1);
  if constexpr (std::is_floating_point_v<T>)
    return parse_real<T>(token);
  else
    return parse_whole<T>(token);
}

/// Parses one line into one row.
class LineParser {
 public:
  LineParser(const PlyHeader& header, const PlyRowNames& names)
      : header_(header), properties_(header.elements[header.vertex].properties), names_(names) {}

  /// Returns where the row ends.
  std::byte* parse(std::string_view line, std::uint64_t row, std::byte* out) const {
    for (const PlyProperty& property : properties_) {
      if (property.list_count) {
        skip_list(property, line, row);
        continue;
      }
      const auto token = take_ply_token(line);
      if (!parse_ply_value(token, property.type, out)) fail(row, property, token);
      out += size_of(property.type);
    }
    if (!take_ply_token(line).empty()) {
      fail(row, "more values than the header has properties");
    }
    return out;
  }

 private:
  void skip_list(const PlyProperty& property, std::string_view& line, std::uint64_t row) const {
    const auto token = take_ply_token(line);
    const auto count = token.empty() ? std::nullopt : parse_value<std::uint64_t>(token);
    if (!count) fail(row, property, token);
    for (std::uint64_t i = 0; i < *count; ++i) {
      if (take_ply_token(line).empty()) fail(row, property, {});
    }
  }

  [[noreturn]] void fail(std::uint64_t row, const PlyProperty& property, std::string_view token) const {
    const std::string name = property.name.substr(0, 40);
    if (token.empty()) fail(row, "no value for " + name);
    fail(row, "'" + std::string(token.substr(0, 40)) + "' is not a value for " + name + " (" +
                  std::string(name_of(property.list_count.value_or(property.type))) + ")");
  }

  [[noreturn]] void fail(std::uint64_t row, const std::string& what) const {
    throw Error(ErrorCode::file_format, names_.path + ": " + names_.noun + " " + std::to_string(row + 1) +
                                            " of " + std::to_string(header_.elements[header_.vertex].count) +
                                            ": " + what);
  }

  const PlyHeader& header_;
  const std::vector<PlyProperty>& properties_;
  const PlyRowNames& names_;
};

}  // namespace

std::string_view take_ply_token(std::string_view& text) {
  const char* next = text.data();
  const char* const end = next + text.size();
  while (next != end && is_space(*next))
    ++next;
  const char* const begin = next;
  while (next != end && !is_space(*next))
    ++next;
  text = {next, static_cast<std::size_t>(end - next)};
  return {begin, static_cast<std::size_t>(next - begin)};
}

bool parse_ply_value(std::string_view token, ScalarType type, std::byte* out) {
  return visit_scalar(type, [&]<class T>() {
    const auto value = token.empty() ? std::nullopt : parse_value<T>(token);
    if (value) std::memcpy(out, &*value, sizeof(T));
    return value.has_value();
  });
}

bool is_blank_line(std::string_view line) {
  return take_ply_token(line).empty();
}

void parse_ply_lines(std::string_view text, const PlyHeader& header, const PlyRowNames& names,
                     std::uint64_t first_row, std::span<std::byte> rows) {
  const LineParser parser(header, names);
  std::byte* out = rows.data();
  for (std::uint64_t row = first_row; out != rows.data() + rows.size() && !text.empty();) {
    const auto end = text.find(header.line_end);
    const auto line = text.substr(0, end);
    text.remove_prefix(end == text.npos ? text.size() : end + 1);
    if (!is_blank_line(line)) out = parser.parse(line, row++, out);
  }
}

}  // namespace ray
