#include "cli/word.h"

#include <algorithm>
#include <cstdio>
#include <utility>

namespace ray::cli {
namespace {

Word named(Kind kind, std::string name) {
  Word word;
  word.kind = kind;
  word.name = std::move(name);
  return word;
}

Word file(Kind kind, std::string name, Extensions extensions) {
  Word word = named(kind, std::move(name));
  word.choices = std::move(extensions);
  return word;
}

Word ranged(Kind kind, std::string name, Range range) {
  Word word = named(kind, std::move(name));
  word.range = range;
  return word;
}

Word with_unit(Kind kind, std::string name, std::string unit) {
  Word word = ranged(kind, std::move(name), kPositive);
  word.unit = std::move(unit);
  return word;
}

Extensions ray_cloud_extensions() {
  return {".ply", ".laz", ".las"};
}

std::string shown(double number) {
  char text[32];
  std::snprintf(text, sizeof text, "%g", number);
  return text;
}

std::string described(const Range& range) {
  const bool low = range.least > kAny.least;
  const bool high = range.most < kAny.most;
  if (range.above_least) return " above " + shown(range.least) + (high ? " up to " + shown(range.most) : "");
  if (low && high) return " from " + shown(range.least) + " to " + shown(range.most);
  if (low) return " of at least " + shown(range.least);
  return high ? " of at most " + shown(range.most) : "";
}

}  // namespace

Word literal(std::string word) {
  return named(Kind::literal, std::move(word));
}

Word choice(std::string name, std::vector<std::string> words) {
  Word word = named(Kind::choice, std::move(name));
  word.choices = std::move(words);
  return word;
}

Word cloud(std::string name) {
  return input(std::move(name), ray_cloud_extensions());
}
Word clouds(std::string name) {
  return inputs(std::move(name), ray_cloud_extensions());
}

Word input(std::string name, Extensions extensions) {
  return file(Kind::input, std::move(name), std::move(extensions));
}

Word inputs(std::string name, Extensions extensions) {
  return file(Kind::inputs, std::move(name), std::move(extensions));
}

Word output(std::string name, Extensions extensions) {
  return file(Kind::output, std::move(name), std::move(extensions));
}

Word number(std::string name, Range range) {
  return ranged(Kind::number, std::move(name), range);
}
Word integer(std::string name, Range range) {
  return ranged(Kind::integer, std::move(name), range);
}

Word vector(std::string name, Range range) {
  const auto components = [](std::string_view part) {
    return static_cast<int>(std::count(part.begin(), part.end(), ','));
  };
  const std::size_t bracket = std::min(name.find('['), name.size());
  const int needed = 1 + components(std::string_view(name).substr(0, bracket));
  const int spare = components(std::string_view(name).substr(bracket));
  Word word = ranged(Kind::vector, std::move(name), range);
  word.components = needed;
  word.spare_components = spare;
  return word;
}

Word colour(std::string name) {
  return vector(std::move(name), between(0.0, 1.0));
}
Word length(std::string name) {
  return with_unit(Kind::length, std::move(name), "");
}
Word length_per(std::string name, std::string unit) {
  return with_unit(Kind::length, std::move(name), std::move(unit));
}
Word quantity(std::string name, std::string unit) {
  return with_unit(Kind::quantity, std::move(name), std::move(unit));
}
Word count(std::string name, std::string unit) {
  return with_unit(Kind::count, std::move(name), std::move(unit));
}
Word size(std::string name) {
  return ranged(Kind::size, std::move(name), kPositive);
}
Word text(std::string name) {
  return named(Kind::text, std::move(name));
}

Word texts(std::string name) {
  return named(Kind::texts, std::move(name));
}

Word optional(Word word) {
  word.optional = true;
  return word;
}

std::string plural(const std::string& unit) {
  if (unit == "%") return unit;
  const bool hisses =
      unit.ends_with("s") || unit.ends_with("x") || unit.ends_with("ch") || unit.ends_with("sh");
  return unit + (hisses ? "es" : "s");
}

std::vector<std::string> unit_words(const Word& word) {
  if (word.kind == Kind::length) {
    const std::string per = word.unit.empty() ? "" : "/" + word.unit;
    return {"cm" + per, "mm" + per, "m" + per};
  }
  if (word.kind != Kind::quantity && word.kind != Kind::count) return {};
  if (plural(word.unit) == word.unit) return {word.unit};
  return {plural(word.unit), word.unit};
}

std::vector<std::string> usual_units(const Word& word) {
  std::vector<std::string> units = unit_words(word);
  if (word.kind != Kind::length && units.size() > 1) units.resize(1);
  return units;
}

std::vector<std::string> spelled_words(const Word& word) {
  if (word.kind == Kind::literal) return {word.name};
  if (word.kind == Kind::choice) return word.choices;
  return {};
}

std::vector<std::string> fixed_words(const Word& word) {
  return unit_words(word).empty() ? spelled_words(word) : unit_words(word);
}

std::string either(const std::vector<std::string>& words) {
  std::string text = words.front();
  for (std::size_t i = 1; i < words.size(); ++i)
    text += (i + 1 < words.size() ? ", " : " or ") + words[i];
  return text;
}

bool is_file(const Word& word) {
  return word.kind == Kind::input || word.kind == Kind::inputs || word.kind == Kind::output;
}

bool is_list(const Word& word) {
  return word.kind == Kind::inputs || word.kind == Kind::texts;
}

std::string form(const Word& word) {
  std::string text = word.name;
  if (word.kind == Kind::choice) {
    text.clear();
    for (const std::string& one : word.choices)
      text += (text.empty() ? "" : "|") + one;
  }
  if (is_list(word)) text += "...";
  const std::vector<std::string> units = unit_words(word);
  if (!units.empty()) text += " " + units.front();
  return word.optional ? "[" + text + "]" : text;
}

std::string expectation(const Word& word) {
  const auto a_number = [&](const char* kind) {
    return std::string(kind) + described(word.range) + " (" + word.name + ")";
  };
  switch (word.kind) {
    case Kind::literal:
      return word.name;
    case Kind::choice:
      return either(word.choices);
    case Kind::input:
      return "a file to read (" + word.name + ")";
    case Kind::inputs:
      return "one or more files to read (" + word.name + ")";
    case Kind::output:
      return "a file to write (" + word.name + ")";
    case Kind::number:
      return a_number("a number");
    case Kind::integer:
      return a_number("a whole number");
    case Kind::vector:
      return word.name + ": numbers" + described(word.range) + " joined by commas without spaces";
    case Kind::length:
      return "a length above 0 such as 4 " + unit_words(word).front();
    case Kind::quantity:
      return "a number above 0 and its unit such as 3 " + unit_words(word).front();
    case Kind::count:
      return "a whole number from 1 and its unit such as 10 " + unit_words(word).front();
    case Kind::size:
      return "an amount of memory such as 4GB (" + word.name + ")";
    case Kind::text:
    case Kind::texts:
      break;
  }
  return word.name;
}

}  // namespace ray::cli
