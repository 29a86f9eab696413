#pragma once
/// The error for a command line that does not fit, which can show where.

#include <raycloud/core/error.h>

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace ray::cli {

/// `what()` is the message in one line; `picture()` repeats the command line with a caret under the wrong
/// word.
class UsageError : public Error {
 public:
  /// `at` is the index of the wrong argument; arguments.size() points behind the last one.
  UsageError(const std::string& message, const std::string& command, std::span<const std::string> arguments,
             std::size_t at, std::string closest = {});
  /// Two lines with a final newline. A long command line is shortened around the caret.
  [[nodiscard]] const std::string& picture() const { return picture_; }
  /// The usage that was meant, as far as one can tell: "raydecimate CLOUD WIDTH cm". May be empty.
  [[nodiscard]] const std::string& closest() const { return closest_; }

 private:
  std::string picture_;
  std::string closest_;
};

}  // namespace ray::cli
