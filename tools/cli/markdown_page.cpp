#include "cli/generate.h"
#include "cli/help.h"
#include "cli/layout.h"

#include <string>

namespace ray::cli {
namespace {

std::string prose(const std::string& text) {
  std::string out;
  for (const TextBlock& block : text_blocks(text)) {
    if (block.words.empty()) out += block.text + "\n";
    for (const auto& [word, meaning] : block.words)
      out += "- `" + word + "`: " + meaning + "\n";
    out += "\n";
  }
  return out;
}

/// A bar would end the cell of a table, in back-quotes too.
std::string cell(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '|') out += '\\';
    out += c;
  }
  return out;
}

std::string usages(const Command& command) {
  std::string out = "## Usage\n\n";
  for (const Usage& usage : command.usages) {
    out += "**`" + form(command, usage) + "`**: " + usage.help + "\n\n```sh\n" + usage.example + "\n```\n\n";
  }
  return out;
}

std::string options(const Command& command) {
  std::string out = "## Options\n\n| option | what it does |\n|---|---|\n";
  for (const Option& option : all_options(command)) {
    const std::string only = takers(command, option);
    out += "| `" + cell(signature(option)) + "` | " +
           cell(help_text(option) + (only.empty() ? "" : "; " + only)) + " |\n";
  }
  return out + "\n";
}

std::string links_to_others(const Command& command) {
  std::string out;
  for (const std::string& name : command.see_also) {
    out += (out.empty() ? "See also " : ", ") + ("[" + name + "](" + name + ".md)");
  }
  return out.empty() ? out : out + ".\n";
}

}  // namespace

std::string markdown_page(const Command& command) {
  std::string page = "# " + command.name + ": " + command.summary + "\n\n" + prose(command.description);
  page += usages(command) + prose(word_remarks(command));
  if (!command.writes.empty()) page += "Writes " + command.writes + ".\n\n";
  page += options(command);
  if (!command.memory.empty()) page += "## Memory\n\n" + prose(command.memory);
  page += links_to_others(command);
  while (page.ends_with("\n\n"))
    page.pop_back();
  return page;
}

}  // namespace ray::cli
