#include "cli/parse.h"

#include "cli/fit.h"
#include "cli/shell_words.h"
#include "cli/split_options.h"
#include "cli/suggest.h"
#include "cli/usage_error.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace ray::cli {
namespace {

void add_once(std::vector<std::string>& parts, const std::string& part) {
  if (std::find(parts.begin(), parts.end(), part) == parts.end()) parts.push_back(part);
}

/// "cm, mm, m or rays", "a file to read (CLOUD), or nothing more".
std::string phrase(const std::vector<Expected>& expected) {
  std::vector<std::string> fixed;
  std::vector<std::string> parts;
  bool end = false;
  for (const Expected& one : expected) {
    if (one.word == nullptr) {
      end = true;
    } else if (one.unit) {
      for (const std::string& unit : usual_units(*one.word))
        add_once(fixed, unit);
    } else if (const std::vector<std::string> words = spelled_words(*one.word); !words.empty()) {
      for (const std::string& word : words)
        add_once(fixed, word);
    } else {
      add_once(parts, expectation(*one.word));
    }
  }
  if (!fixed.empty()) parts.insert(parts.begin(), either(fixed));
  if (end) parts.emplace_back("nothing more");
  std::string text;
  for (std::size_t i = 0; i < parts.size(); ++i)
    text += (i > 0 ? ", or " : "") + parts[i];
  return text;
}

std::string explanation(const Fit& fit, const std::vector<std::string>& words) {
  if (fit.wrong >= words.size()) return "something is missing: expected " + phrase(fit.expected);
  const std::string& typed = words[fit.wrong];
  std::vector<std::string> fixed;
  for (const Expected& one : fit.expected) {
    if (one.word == nullptr) continue;
    const std::vector<std::string> more = one.unit ? unit_words(*one.word) : spelled_words(*one.word);
    fixed.insert(fixed.end(), more.begin(), more.end());
  }
  const bool only_end = fit.expected.size() == 1 && fit.expected.front().word == nullptr;
  if (only_end) return shell_quoted(typed) + " is one word too many";
  return "expected " + phrase(fit.expected) + ", not " + shell_quoted(typed) + did_you_mean(typed, fixed);
}

}  // namespace

/// Builds a Match.
class Parser {
 public:
  Parser(const Command& command, std::span<const std::string> arguments)
      : command_(command),
        arguments_(arguments),
        options_(all_options(command)),
        line_(split_options(options_, arguments)),
        fit_(fit(command, line_.words)) {}

  Match match() {
    const Usage& usage = command_.usages[fit_.usage];
    closest_ = form(command_, usage);
    if (!line_.mistakes.empty()) fail_at_option(line_.mistakes.front());
    if (!fit_.fits) {
      const bool missing = fit_.wrong >= line_.words.size();
      fail(explanation(fit_, line_.words), missing ? arguments_.size() : line_.words_at[fit_.wrong]);
    }
    match_.usage_index_ = fit_.usage;
    match_.usage_ = usage.name;
    match_.command_ = &command_;
    match_.arguments_.assign(arguments_.begin(), arguments_.end());
    match_.history_ = command_.name;
    take_words();
    take_options(usage);
    return std::move(match_);
  }

 private:
  void take_words() {
    for (Assigned& assigned : fit_.assigned) {
      const auto first = line_.words.begin() + static_cast<std::ptrdiff_t>(assigned.first);
      Value value{.words = {first, first + static_cast<std::ptrdiff_t>(assigned.used)},
                  .numbers = std::move(assigned.numbers),
                  .at = line_.words_at[assigned.first]};
      if (!is_file(*assigned.word)) {
        for (const std::string& word : value.words)
          match_.history_ += " " + shell_quoted(word);
      }
      match_.given_.emplace(assigned.word->name, std::move(value));
    }
  }

  void take_options(const Usage& usage) {
    for (std::size_t i = 0; i < options_.size(); ++i) {
      const Option& option = options_[i];
      const auto given = std::find_if(line_.given.begin(), line_.given.end(),
                                      [&](const GivenOption& one) { return one.option == i; });
      if (given != line_.given.end()) {
        take_option(usage, option, *given);
      } else if (!option.fallback.empty()) {
        take_fallback(option);
      }
    }
  }

  void take_option(const Usage& usage, const Option& option, GivenOption& given) {
    const std::vector<std::string>& takers = option.usages;
    if (!takers.empty() && std::find(takers.begin(), takers.end(), usage.name) == takers.end()) {
      fail("--" + option.name + " does not go with this usage", given.at);
    }
    Value value{.words = {}, .numbers = std::move(given.numbers), .at = given.value_at};
    if (option.value) value.words.push_back(given.text);
    if (shapes_result(option)) {
      match_.history_ += " --" + option.name;
      if (option.value && !is_file(*option.value)) match_.history_ += " " + shell_quoted(given.text);
    }
    match_.given_.emplace("--" + option.name, std::move(value));
  }

  void take_fallback(const Option& option) {
    if (!option.value) throw std::logic_error("the flag --" + option.name + " cannot have a fallback");
    Reading reading = read(*option.value, std::span(&option.fallback, 1), {});
    if (reading.used != 1)
      throw std::logic_error("the fallback of --" + option.name + " is not a value it takes");
    match_.fallbacks_.emplace("--" + option.name,
                              Value{.words = {option.fallback}, .numbers = std::move(reading.numbers)});
  }

  /// What follows a misspelt option was perhaps its value, so it is left out where the words do not fit with
  /// it.
  [[noreturn]] void fail_at_option(const OptionMistake& mistake) {
    const auto next = std::find(line_.words_at.begin(), line_.words_at.end(), mistake.at + 1);
    if (!fit_.fits && next != line_.words_at.end()) {
      line_.words.erase(line_.words.begin() + (next - line_.words_at.begin()));
      closest_ = form(command_, command_.usages[fit(command_, line_.words).usage]);
    }
    fail(mistake.message, mistake.at);
  }

  [[noreturn]] void fail(const std::string& message, std::size_t at) const {
    throw UsageError(message, command_.name, arguments_, at, closest_);
  }

  const Command& command_;
  std::span<const std::string> arguments_;
  std::vector<Option> options_;
  SplitLine line_;
  Fit fit_;
  std::string closest_;
  Match match_;
};

Match parse(const Command& command, std::span<const std::string> arguments) {
  return Parser(command, arguments).match();
}

}  // namespace ray::cli
