#include "cli/command.h"

#include "cli/parse.h"
#include "cli/shell_words.h"

#include <raycloud/core/error.h>

#include <set>
#include <utility>

namespace ray::cli {

Option output_option(const std::string& usual) {
  return {.name = "output",
          .letter = 'o',
          .value = output("FILE", {".ply", ".laz"}),
          .help = "write here instead of " + usual};
}

Option view_option() {
  return {
      .name = "view", .letter = 'v', .help = "open the result in $RAYCLOUD_VIEWER, CloudCompare or MeshLab"};
}

std::vector<Option> all_options(const Command& command) {
  std::vector<Option> options = command.options;
  options.push_back({.name = "quiet", .letter = 'q', .help = "no progress, notes or summary"});
  options.push_back({.name = "threads",
                     .value = integer("N", between(1, 4096)),
                     .help = "most threads to use (default: all cores)",
                     .advanced = true});
  options.push_back({.name = "memory",
                     .value = size("SIZE"),
                     .help = "most memory to use, as 4GB or 512MiB (default: half of the machine's)",
                     .advanced = true});
  options.push_back({.name = "version", .help = "name and version", .advanced = true});
  options.push_back({.name = "help", .letter = 'h', .help = "this help; --help all shows every option"});
  return options;
}

bool shapes_result(const Option& option) {
  static const std::set<std::string> kRunOnly{"output", "view",    "quiet", "threads",
                                              "memory", "version", "help",  "output_transform"};
  return !kRunOnly.contains(option.name);
}

std::string form(const Command& command, const Usage& usage) {
  std::string text = command.name;
  for (const Word& word : usage.words)
    text += " " + form(word);
  return text;
}

std::string form(const Option& option) {
  return "--" + option.name + (option.value ? " " + form(*option.value) : "");
}

std::string signature(const Option& option) {
  return (option.letter != 0 ? std::string{'-', option.letter, ',', ' '} : "") + form(option);
}

std::string help_text(const Option& option) {
  return option.help + (option.fallback.empty() ? "" : " (default: " + option.fallback + ")");
}

}  // namespace ray::cli
