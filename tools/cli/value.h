#pragma once
/// Reading one word of a usage from the arguments.

#include "cli/word.h"

#include <cstddef>
#include <set>
#include <span>
#include <string>
#include <vector>

namespace ray::cli {

/// Every literal, choice and unit of a command: not taken for the name of a file.
using Reserved = std::set<std::string, std::less<>>;

/// How specific the reading of one argument is. Where two usages fit, the higher one wins.
enum class Rank { text, file, number, fixed };

struct Reading {
  std::size_t used = 0;         ///< arguments taken; 0: it does not fit
  std::vector<double> numbers;  ///< in metres, bytes or the word's unit
  std::vector<Rank> ranks;      ///< of each argument taken, or of those that fit before the wrong one
  std::size_t wrong = 0;        ///< the argument that does not fit, counted from the word's first
  bool sure = false;            ///< it does not fit, but this word was meant: its unit is there
};

/// Reads `word` from the front of `arguments`. An `inputs` word reads one file.
[[nodiscard]] Reading read(const Word& word, std::span<const std::string> arguments,
                           const Reserved& reserved);

/// Whether an argument that begins with a dash is a value after all: `-`, `-5`, `-.5`, `-1,2,3`.
[[nodiscard]] bool is_negative_value(const std::string& argument);

}  // namespace ray::cli
