#pragma once
/// A command line that fits a command's table, with its values by name.

#include <raycloud/core/units.h>

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace ray::cli {

struct Command;

/// What was given for one word or option.
struct Value {
  std::vector<std::string> words;  ///< as typed
  std::vector<double> numbers;     ///< its numbers, lengths in metres, sizes in bytes
  std::size_t at = 0;              ///< index of its first argument
};

/// The result of `parse`. Words are named as in the table ("CLOUD", "WIDTH", a literal by itself: "box"),
/// options with their dashes ("--resolution"). Asking for a name that is not in the table, or for a value
/// that was not given and has no fallback, is a mistake of the programmer: std::logic_error.
class Match {
 public:
  /// Whether the word or option was given; a fallback does not count.
  [[nodiscard]] bool has(std::string_view name) const;
  /// Usage::name of the usage that matched.
  [[nodiscard]] const std::string& usage() const { return usage_; }
  /// Its index in Command::usages.
  [[nodiscard]] std::size_t usage_index() const { return usage_index_; }

  /// A file, choice or text.
  [[nodiscard]] const std::string& text(std::string_view name) const;
  /// The words of an `inputs` or `texts` word; of another, the one.
  [[nodiscard]] const std::vector<std::string>& files(std::string_view name) const;
  /// The first file to read on the command line; empty if there is none.
  [[nodiscard]] const std::string& first_input() const;
  [[nodiscard]] double number(std::string_view name) const;
  /// An integer, count or size.
  [[nodiscard]] std::int64_t integer(std::string_view name) const;
  [[nodiscard]] Metres length(std::string_view name) const;
  /// The first three components of a vector.
  [[nodiscard]] Eigen::Vector3d vector(std::string_view name) const;
  /// All components of a vector.
  [[nodiscard]] const std::vector<double>& components(std::string_view name) const;

  /// Throws the usage error (exit 2) that points at this word or option: `message` says what is wrong with
  /// its value and what would be right.
  [[noreturn]] void reject(std::string_view name, const std::string& message) const;

  /// The command's name, words and options for the header of what it writes: without the names of files and
  /// without
  /// --threads, --memory, --quiet, --view and --output, so none of these changes a byte. Options are in the
  /// order of the table.
  [[nodiscard]] const std::string& history() const { return history_; }

 private:
  friend class Parser;
  [[nodiscard]] const Value& value(std::string_view name) const;

  std::size_t usage_index_ = 0;
  std::string usage_;
  std::map<std::string, Value, std::less<>> given_;
  std::map<std::string, Value, std::less<>> fallbacks_;
  std::string history_;
  const Command* command_ = nullptr;
  std::vector<std::string> arguments_;
};

}  // namespace ray::cli
