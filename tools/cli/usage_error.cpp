#include "cli/usage_error.h"

#include "cli/shell_words.h"

#include <algorithm>
#include <utility>

namespace ray::cli {
namespace {

constexpr std::size_t kBefore = 60;  // columns of the command line shown before the caret
constexpr std::size_t kAfter = 30;   // and after the word it points at

std::string draw(const std::string& command, std::span<const std::string> arguments, std::size_t at) {
  at = std::min(at, arguments.size());
  std::string before;
  std::size_t first = at;
  while (first > 0) {
    const std::string word = shell_quoted(arguments[first - 1]);
    if (columns(before) + columns(word) > kBefore) break;
    before = word + " " + before;
    --first;
  }
  before = "  " + command + " " + (first > 0 ? "... " : "") + before;
  const std::string wrong = at < arguments.size() ? shell_quoted(arguments[at]) : "";
  std::string after;
  for (std::size_t i = at + 1; i < arguments.size(); ++i) {
    const std::string word = shell_quoted(arguments[i]);
    const bool room = columns(after) + columns(word) <= kAfter;
    after += " " + (room ? word : "...");
    if (!room) break;
  }
  const std::size_t under = std::max<std::size_t>(columns(wrong), 1);
  return before + wrong + after + "\n" + std::string(columns(before), ' ') + "^" +
         std::string(under - 1, '~') + "\n";
}

}  // namespace

UsageError::UsageError(const std::string& message, const std::string& command,
                       std::span<const std::string> arguments, std::size_t at, std::string closest)
    : Error(ErrorCode::usage, message),
      picture_(draw(command, arguments, at)),
      closest_(std::move(closest)) {}

}  // namespace ray::cli
