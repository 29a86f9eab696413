#include "cli/parse.h"
#include "cli/suggest.h"
#include "cli/usage_error.h"
#include "pipe_steps.h"
#include "steps/steps.h"

#include <algorithm>
#include <array>
#include <optional>

namespace ray::tools {
namespace {

using cli::UsageError;

/// Where a step's words name the cloud if it were a command.
constexpr const char* kCloud = "CLOUD";

std::string name_in_pipe(const Step& step) {
  return step.command.name.substr(3);  // without "ray"
}

/// "decimate" and "raydecimate" alike.
const Step& step_named(const std::string& name) {
  std::vector<std::string> known;
  for (const Step* step : all_steps()) {
    known.push_back(name_in_pipe(*step));
    if (name == known.back() || name == step->command.name) return *step;
  }
  std::string list;
  for (const std::string& one : known)
    list += (list.empty() ? "" : ", ") + one;
  throw Error(ErrorCode::usage, (name.empty() ? std::string("a step has no words")
                                              : "there is no step " + name + cli::did_you_mean(name, known)) +
                                    " (steps are " + list + ")");
}

/// The words with the cloud where the command wants it, which for some is not the first place.
cli::Match parse_step(const Step& step, std::vector<std::string> words) {
  std::optional<UsageError> first;
  for (std::size_t at = 0; at <= words.size(); ++at) {
    std::vector<std::string> arguments = words;
    arguments.insert(arguments.begin() + static_cast<std::ptrdiff_t>(at), kCloud);
    try {
      cli::Match match = cli::parse(step.command, arguments);
      if (match.first_input() == kCloud) return match;
    } catch (const UsageError& error) {
      if (!first) first = error;
    }
  }
  throw *first;
}

/// Takes the word that chooses an output from the end.
std::size_t take_output(const Step& step, std::vector<std::string>& words) {
  for (std::size_t i = 0; i < step.outputs.size() && !words.empty(); ++i) {
    if (step.outputs[i].word.empty() || words.back() != step.outputs[i].word) continue;
    words.pop_back();
    return i;
  }
  return 0;
}

}  // namespace

std::vector<PipeStep> parse_pipe(std::span<const std::string> words) {
  std::vector<PipeStep> steps;
  auto begin = words.begin();
  while (true) {
    const auto end = std::find(begin, words.end(), ":");
    const std::string name = begin == end ? "" : *begin;
    const Step& step = step_named(name);
    std::vector<std::string> rest(begin + 1, end);
    const std::size_t output = take_output(step, rest);
    steps.push_back({.step = &step, .match = parse_step(step, rest), .output = output});
    if (end == words.end()) return steps;
    begin = end + 1;
  }
}

}  // namespace ray::tools
