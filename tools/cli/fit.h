#pragma once
/// Fitting the words of a command line to the usages of a command.

#include "cli/command.h"
#include "cli/value.h"

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace ray::cli {

/// What would have fitted at some place of the command line.
struct Expected {
  std::size_t usage = 0;       ///< index in Command::usages
  const Word* word = nullptr;  ///< nullptr: the end of the line
  bool unit = false;           ///< the unit of the word, after its number
};

/// The arguments one word of the usage took.
struct Assigned {
  const Word* word = nullptr;
  std::size_t first = 0;
  std::size_t used = 0;
  std::vector<double> numbers;
};

struct Fit {
  bool fits = false;
  std::size_t usage = 0;           ///< the one that fits, or the closest one
  std::vector<Assigned> assigned;  ///< in the order of the usage; only where it fits
  std::size_t wrong =
      0;  ///< where no usage fits: index of the first wrong word, words.size() if one is missing
  std::vector<Expected> expected;  ///< what would have fitted there
};

/// The usage that fits best (see `parse`). Where none fits, the place that is wrong is the one that gets
/// furthest, except that a word which is nearly a literal, or a wrong number before the right unit, tells
/// more than the place.
[[nodiscard]] Fit fit(const Command& command, std::span<const std::string> words);

/// What may follow `words`, whether they fit as they are or not yet. Empty if they are wrong already.
[[nodiscard]] std::vector<Expected> continuations(const Command& command, std::span<const std::string> words);

/// Every literal, choice and unit of the command.
[[nodiscard]] Reserved reserved_words(const Command& command);

}  // namespace ray::cli
