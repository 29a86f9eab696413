#include "cli/value.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <string_view>
#include <utility>

namespace ray::cli {
namespace {

constexpr double kLargestInteger = 9007199254740992.0;  // 2^53: above it doubles skip integers

struct Leading {
  double number = 0.0;
  std::string_view rest;
};

bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

/// The finite number that `text` begins with.
std::optional<Leading> leading_number(std::string_view text) {
  const std::size_t first = text.starts_with('-') || text.starts_with('+') ? 1 : 0;
  const bool plain = text.size() > first && (is_digit(text[first]) || text[first] == '.');
  if (!plain) return {};                           // "inf" and "nan", which from_chars would take
  if (text.front() == '+') text.remove_prefix(1);  // from_chars does not know it
  double number = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || !std::isfinite(number)) return {};
  return Leading{number, text.substr(static_cast<std::size_t>(end - text.data()))};
}

bool accepts(const Range& range, double number) {
  return (range.above_least ? number > range.least : number >= range.least) && number <= range.most;
}

bool is_whole(double number) {
  return std::floor(number) == number && std::abs(number) <= kLargestInteger;
}

Reading fits(Rank rank, std::vector<double> numbers = {}) {
  Reading reading;
  reading.used = 1;
  reading.numbers = std::move(numbers);
  reading.ranks = {rank};
  return reading;
}

bool looks_like_vector(std::string_view text) {
  if (text.find(',') == std::string_view::npos) return false;
  while (!text.empty()) {
    const auto leading = leading_number(text);
    if (!leading) return false;
    text = leading->rest;
    if (!text.empty() && text.front() != ',') return false;
    if (!text.empty()) text.remove_prefix(1);
  }
  return true;
}

Reading read_file(const std::string& argument, const Reserved& reserved) {
  if (argument.empty() || reserved.contains(argument) || looks_like_vector(argument)) return {};
  return fits(Rank::file);
}

Reading read_number(const Word& word, const std::string& argument) {
  const auto leading = leading_number(argument);
  if (!leading || !leading->rest.empty() || !accepts(word.range, leading->number)) return {};
  if (word.kind == Kind::integer && !is_whole(leading->number)) return {};
  return fits(Rank::number, {leading->number});
}

Reading read_vector(const Word& word, std::string_view argument) {
  std::vector<double> numbers;
  const auto most = static_cast<std::size_t>(word.components + word.spare_components);
  while (numbers.size() < most) {
    const auto leading = leading_number(argument);
    if (!leading || !accepts(word.range, leading->number)) return {};
    numbers.push_back(leading->number);
    argument = leading->rest;
    if (argument.empty()) break;
    if (argument.front() != ',') return {};
    argument.remove_prefix(1);
    if (numbers.size() == most) return {};
  }
  if (numbers.size() < static_cast<std::size_t>(word.components)) return {};
  return fits(Rank::number, std::move(numbers));
}

/// Divided rather than multiplied, so that 4 cm is exactly 0.04 m.
double in_metres(double number, std::string_view unit) {
  if (unit.starts_with("cm")) return number / 100.0;
  return unit.starts_with("mm") ? number / 1000.0 : number;
}

/// A number and its unit, in one argument or two.
Reading read_with_unit(const Word& word, std::span<const std::string> arguments) {
  const auto leading = leading_number(arguments.front());
  if (!leading) return {};
  const bool joined = !leading->rest.empty();
  const std::vector<std::string> units = unit_words(word);
  const std::string_view typed = joined                 ? leading->rest
                                 : arguments.size() > 1 ? std::string_view(arguments[1])
                                                        : std::string_view();
  const bool has_unit = std::find(units.begin(), units.end(), typed) != units.end();
  const bool good_number =
      accepts(word.range, leading->number) && (word.kind != Kind::count || is_whole(leading->number));
  Reading reading;
  reading.sure = has_unit && !good_number;
  if (!good_number || (joined && !has_unit)) return reading;
  reading.ranks = {Rank::number};
  reading.wrong = 1;
  if (!has_unit) return reading;
  if (!joined) reading.ranks.push_back(Rank::fixed);
  reading.used = joined ? 1 : 2;
  reading.numbers = {word.kind == Kind::length ? in_metres(leading->number, typed) : leading->number};
  return reading;
}

std::optional<double> bytes_per(std::string unit) {
  std::transform(unit.begin(), unit.end(), unit.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  if (unit.empty() || unit == "b") return 1.0;
  const std::size_t power = std::string_view("kmgt").find(unit.front());
  if (power == std::string_view::npos) return {};
  const std::string_view rest = std::string_view(unit).substr(1);
  if (rest == "ib") return std::pow(1024.0, static_cast<double>(power + 1));
  if (rest == "b" || rest.empty()) return std::pow(1000.0, static_cast<double>(power + 1));
  return {};
}

Reading read_size(const std::string& argument) {
  const auto leading = leading_number(argument);
  if (!leading) return {};
  const auto unit = bytes_per(std::string(leading->rest));
  if (!unit) return {};
  const double bytes = std::floor(leading->number * *unit);
  if (bytes < 1.0 || bytes > kLargestInteger) return {};
  return fits(Rank::number, {bytes});
}

}  // namespace

Reading read(const Word& word, std::span<const std::string> arguments, const Reserved& reserved) {
  if (arguments.empty()) return {};
  const std::string& first = arguments.front();
  switch (word.kind) {
    case Kind::literal:
      return first == word.name ? fits(Rank::fixed) : Reading{};
    case Kind::choice: {
      const bool found = std::find(word.choices.begin(), word.choices.end(), first) != word.choices.end();
      return found ? fits(Rank::fixed) : Reading{};
    }
    case Kind::input:
    case Kind::inputs:
    case Kind::output:
      return read_file(first, reserved);
    case Kind::number:
    case Kind::integer:
      return read_number(word, first);
    case Kind::vector:
      return read_vector(word, first);
    case Kind::length:
    case Kind::quantity:
    case Kind::count:
      return read_with_unit(word, arguments);
    case Kind::size:
      return read_size(first);
    case Kind::text:
    case Kind::texts:
      break;
  }
  return fits(Rank::text);
}

bool is_negative_value(const std::string& argument) {
  if (argument == "-") return true;
  return argument.size() > 1 && argument[0] == '-' && (is_digit(argument[1]) || argument[1] == '.');
}

}  // namespace ray::cli
