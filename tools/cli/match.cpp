#include "cli/match.h"

#include "cli/command.h"
#include "cli/usage_error.h"

#include <stdexcept>

namespace ray::cli {
namespace {

[[noreturn]] void refuse(std::string_view name, const char* why) {
  throw std::logic_error("the command asks for \"" + std::string(name) + "\", which " + why);
}

template <class T>
const T& front_of(const std::vector<T>& values, std::string_view name, const char* kind) {
  if (values.empty()) refuse(name, kind);
  return values.front();
}

bool in_table(const Command& command, std::string_view name) {
  for (const Usage& usage : command.usages) {
    for (const Word& word : usage.words) {
      if (word.name == name) return true;
    }
  }
  for (const Option& option : all_options(command)) {
    if ("--" + option.name == name) return true;
  }
  return false;
}

}  // namespace

const Value& Match::value(std::string_view name) const {
  const auto given = given_.find(name);
  if (given != given_.end()) return given->second;
  const auto fallback = fallbacks_.find(name);
  if (fallback != fallbacks_.end()) return fallback->second;
  refuse(name, "was not given and has no fallback");
}

bool Match::has(std::string_view name) const {
  if (given_.contains(name)) return true;
  if (!fallbacks_.contains(name) && !in_table(*command_, name)) refuse(name, "is not in its table");
  return false;
}

const std::string& Match::text(std::string_view name) const {
  return front_of(value(name).words, name, "is a flag");
}

const std::vector<std::string>& Match::files(std::string_view name) const {
  return value(name).words;
}

const std::string& Match::first_input() const {
  static const std::string kNone;
  for (const Word& word : command_->usages[usage_index_].words) {
    const bool file = word.kind == Kind::input || word.kind == Kind::inputs;
    if (file && given_.contains(word.name)) return files(word.name).front();
  }
  return kNone;
}

double Match::number(std::string_view name) const {
  return front_of(value(name).numbers, name, "is not a number");
}

std::int64_t Match::integer(std::string_view name) const {
  return static_cast<std::int64_t>(number(name));
}

Metres Match::length(std::string_view name) const {
  return {number(name)};
}

Eigen::Vector3d Match::vector(std::string_view name) const {
  const std::vector<double>& numbers = components(name);
  if (numbers.size() < 3) refuse(name, "has not three components");
  return {numbers[0], numbers[1], numbers[2]};
}

const std::vector<double>& Match::components(std::string_view name) const {
  return value(name).numbers;
}

void Match::reject(std::string_view name, const std::string& message) const {
  throw UsageError(message, command_->name, arguments_, value(name).at,
                   form(*command_, command_->usages[usage_index_]));
}

}  // namespace ray::cli
