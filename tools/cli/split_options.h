#pragma once
/// Parting a command line into its words and its options.

#include "cli/command.h"

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace ray::cli {

/// One option as given.
struct GivenOption {
  std::size_t option = 0;            ///< index in the options
  std::size_t at = 0;                ///< index of the argument with its name
  std::size_t value_at = 0;          ///< index of the argument with its value; `at` for a flag
  std::string text = {};             ///< its value as typed
  std::vector<double> numbers = {};  ///< its value read
};

/// A mistake in an option.
struct OptionMistake {
  std::string message;
  std::size_t at = 0;
};

struct SplitLine {
  std::vector<std::string> words;     ///< everything that is not an option
  std::vector<std::size_t> words_at;  ///< their indices in the arguments
  std::vector<GivenOption> given;
  std::optional<std::size_t> awaits_value;  ///< the option that the arguments end with, lacking its value
  std::vector<OptionMistake> mistakes;      ///< in the order of the arguments; the rest is still split
};

/// Options are `--name`, `--name VALUE`, `--name=VALUE`, `-n` and `-n VALUE`, anywhere before `--`. A dash
/// and an underscore in a name are the same.
[[nodiscard]] SplitLine split_options(std::span<const Option> options,
                                      std::span<const std::string> arguments);

}  // namespace ray::cli
