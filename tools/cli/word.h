#pragma once
/// The words of a command line: one builder per kind of word, so that a usage in a command's table reads like
/// the line in its manual: `{input("CLOUD"), length("WIDTH")}` is `CLOUD WIDTH cm`.

#include <limits>
#include <string>
#include <vector>

namespace ray::cli {

/// The numbers a word accepts. Infinity and NaN are never accepted.
struct Range {
  double least = -std::numeric_limits<double>::infinity();
  double most = std::numeric_limits<double>::infinity();
  bool above_least = false;  ///< `least` itself is refused
};
inline constexpr Range kAny{};
inline constexpr Range kPositive{.least = 0.0, .above_least = true};
inline constexpr Range kNonNegative{.least = 0.0};
[[nodiscard]] constexpr Range between(double least, double most) {
  return {.least = least, .most = most};
}

enum class Kind {
  literal,
  choice,
  input,
  inputs,
  output,
  number,
  integer,
  vector,
  length,
  quantity,
  count,
  size,
  text,
  texts,
};

/// One word of a usage, or the value of an option. Make it with the builders below.
struct Word {
  Kind kind = Kind::text;
  std::string name;                  ///< as in the manual: CAPITALS for values, the word itself for literals
  std::vector<std::string> choices;  ///< choice: what may be typed. Files: extensions that completion offers
  std::string unit;  ///< quantity, count: the singular; length: what follows the slash, if any
  Range range = kAny;
  int components = 1;        ///< vector: how many numbers
  int spare_components = 0;  ///< vector: how many more may follow
  bool optional = false;
};

using Extensions = std::vector<std::string>;

/// A word typed exactly so.
[[nodiscard]] Word literal(std::string word);
/// One of several words. `match.text(name)` says which.
[[nodiscard]] Word choice(std::string name, std::vector<std::string> words);
/// A ray cloud to read: `input` with the extensions of ray clouds.
[[nodiscard]] Word cloud(std::string name = "CLOUD");
/// One or more ray clouds to read.
[[nodiscard]] Word clouds(std::string name = "CLOUDS");
/// A file or folder to read. The extensions guide completion; any name is accepted.
[[nodiscard]] Word input(std::string name, Extensions extensions = {});
/// One or more files to read.
[[nodiscard]] Word inputs(std::string name, Extensions extensions = {});
/// A file to write. `-` is accepted too, for the command to interpret.
[[nodiscard]] Word output(std::string name, Extensions extensions = {});
/// A real number, `-0.5` or `1e-3`.
[[nodiscard]] Word number(std::string name, Range range = kAny);
/// A whole number within ±2^53.
[[nodiscard]] Word integer(std::string name, Range range = kAny);
/// Numbers joined by commas without spaces, named after its components: `vector("X,Y,Z")` takes three,
/// `vector("X,Y,Z[,T]")` three or four.
[[nodiscard]] Word vector(std::string name, Range range = kAny);
/// Red, green and blue from 0 to 1: `1,0.5,0`.
[[nodiscard]] Word colour(std::string name = "R,G,B");
/// A length above 0 with its unit: `4 cm`, `40 mm`, `0.04 m`, or joined, `4cm`. Metres.
[[nodiscard]] Word length(std::string name);
/// A length for each of something: `length_per("WIDTH", "ray")` takes `20 cm/ray`, `0.2 m/ray`. Metres.
[[nodiscard]] Word length_per(std::string name, std::string unit);
/// A number above 0 and a unit word, singular or plural: `quantity("N", "sigma")` takes `3 sigmas`,
/// `quantity("P", "%")` takes `3 %`.
[[nodiscard]] Word quantity(std::string name, std::string unit);
/// A whole number from 1 and a unit word, singular or plural: `10 rays`, `1 ray`.
[[nodiscard]] Word count(std::string name, std::string unit);
/// An amount of memory: `4GB`, `512MiB`, `100000`. Bytes.
[[nodiscard]] Word size(std::string name);
/// Any text.
[[nodiscard]] Word text(std::string name);
/// One or more words of any kind: all that follow.
[[nodiscard]] Word texts(std::string name);
/// The same word, which may be left out.
[[nodiscard]] Word optional(Word word);

/// As the manual writes it: `CLOUD`, `top|left`, `WIDTH cm`, `N rays`, `CLOUDS...`, `[OVERLAP]`.
[[nodiscard]] std::string form(const Word& word);

/// What belongs there, in words, for an error: `a length WIDTH such as 4 cm`, `WIDTH, a number above 0`.
[[nodiscard]] std::string expectation(const Word& word);

/// The unit words a length, quantity or count accepts, the usual one first; empty for other words.
[[nodiscard]] std::vector<std::string> unit_words(const Word& word);

/// The same without the singular.
[[nodiscard]] std::vector<std::string> usual_units(const Word& word);

/// A literal or the choices; empty for other words.
[[nodiscard]] std::vector<std::string> spelled_words(const Word& word);

/// Both: every fixed spelling in this word.
[[nodiscard]] std::vector<std::string> fixed_words(const Word& word);

/// `a, b or c`. At least one word.
[[nodiscard]] std::string either(const std::vector<std::string>& words);

[[nodiscard]] bool is_file(const Word& word);

/// Whether it takes as many arguments as there are.
[[nodiscard]] bool is_list(const Word& word);

/// The plural of a unit word: rays, branches, `%`.
[[nodiscard]] std::string plural(const std::string& unit);

}  // namespace ray::cli
