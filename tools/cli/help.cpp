#include "cli/help.h"

#include "cli/layout.h"

#include <algorithm>
#include <utility>

namespace ray::cli {
namespace {

bool any_word(const Command& command, Kind kind) {
  return std::any_of(command.usages.begin(), command.usages.end(), [kind](const Usage& usage) {
    return std::any_of(usage.words.begin(), usage.words.end(),
                       [kind](const Word& word) { return word.kind == kind; });
  });
}

std::string usage_lines(const Command& command) {
  std::string text;
  for (const Usage& usage : command.usages) {
    text +=
        "  " + form(command, usage) + "\n" + wrapped(usage.help, 6) + "      e.g. " + usage.example + "\n";
  }
  return text;
}

std::string option_lines(const Command& command, HelpDepth depth) {
  std::vector<std::pair<std::string, std::string>> rows;
  for (const Option& option : all_options(command)) {
    if (option.advanced && depth != HelpDepth::all) continue;
    const std::string only = depth == HelpDepth::all ? takers(command, option) : "";
    const std::string margin = option.letter == 0 ? "    " : "";
    rows.emplace_back(margin + signature(option), help_text(option) + (only.empty() ? "" : "; " + only));
  }
  return two_columns(rows);
}

}  // namespace

std::string word_remarks(const Command& command) {
  std::string text;
  if (any_word(command, Kind::length)) text += "Lengths take `mm`, `cm` or `m`. ";
  if (any_word(command, Kind::vector)) text += "Numbers joined by commas are written without spaces. ";
  if (!text.empty()) text.pop_back();
  return text;
}

std::string takers(const Command& command, const Option& option) {
  std::string text;
  for (const Usage& usage : command.usages) {
    const bool takes =
        std::find(option.usages.begin(), option.usages.end(), usage.name) != option.usages.end();
    if (takes) text += (text.empty() ? "only with `" : " or `") + form(command, usage) + "`";
  }
  return text;
}

std::string help(const Command& command, HelpDepth depth) {
  std::string text = command.name + ": " + command.summary + "\n\nUsage:\n" + usage_lines(command);
  if (depth == HelpDepth::all) {
    text += "\n" + wrapped(command.description, 0);
    const std::string remarks = word_remarks(command);
    if (!remarks.empty()) text += "\n" + wrapped(remarks, 0);
  }
  if (!command.writes.empty()) text += "\n" + wrapped("Writes " + command.writes + ".", 0);
  if (depth == HelpDepth::all && !command.memory.empty())
    text += "\n" + wrapped("Memory: " + command.memory, 0);
  return text + "\nOptions:\n" + option_lines(command, depth);
}

}  // namespace ray::cli
