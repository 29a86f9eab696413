#include "cli/command.h"
#include "cli/parse.h"
#include "cli/shell_words.h"

#include <algorithm>
#include <exception>
#include <set>
#include <span>

namespace ray::cli {
namespace {

void check_example(const Command& command, std::size_t index, std::vector<std::string>& found) {
  const std::string& example = command.usages[index].example;
  const std::vector<std::string> words = split_words(example);
  if (words.empty() || words.front() != command.name) {
    found.push_back("the example \"" + example + "\" does not start with " + command.name);
    return;
  }
  try {
    const Match match = parse(command, std::span(words).subspan(1));
    if (match.usage_index() != index) found.push_back("the example \"" + example + "\" is another usage");
  } catch (const std::exception& error) {
    found.push_back("the example \"" + example + "\": " + error.what());
  }
}

void check_usage(const Command& command, std::size_t index, std::vector<std::string>& found) {
  const Usage& usage = command.usages[index];
  std::set<std::string> names;
  for (const Word& word : usage.words) {
    const bool value_twice = word.kind != Kind::literal && !names.insert(word.name).second;
    if (value_twice) found.push_back(form(command, usage) + " has two words " + word.name);
  }
  if (usage.help.empty()) found.push_back(form(command, usage) + " has no help");
  check_example(command, index, found);
}

void check_option(const Command& command, const Option& option, std::vector<std::string>& found) {
  if (option.help.empty()) found.push_back("--" + option.name + " has no help");
  if (option.value && is_list(*option.value)) found.push_back("--" + option.name + " takes a list");
  for (const std::string& name : option.usages) {
    const bool known = std::any_of(command.usages.begin(), command.usages.end(),
                                   [&](const Usage& usage) { return usage.name == name; });
    if (!known) found.push_back("--" + option.name + " is for the unknown usage \"" + name + "\"");
  }
}

}  // namespace

std::vector<std::string> mistakes(const Command& command) {
  std::vector<std::string> found;
  if (command.summary.empty()) found.emplace_back("there is no summary");
  if (command.description.empty()) found.emplace_back("there is no description");
  if (command.usages.empty()) found.emplace_back("there are no usages");
  for (std::size_t i = 0; i < command.usages.size(); ++i)
    check_usage(command, i, found);
  std::set<std::string> names;
  std::set<char> letters;
  for (const Option& option : all_options(command)) {
    check_option(command, option, found);
    if (!names.insert(option.name).second) found.push_back("two options are called --" + option.name);
    if (option.letter != 0 && !letters.insert(option.letter).second) {
      found.push_back(std::string("two options have the letter -") + option.letter);
    }
  }
  return found;
}

}  // namespace ray::cli
