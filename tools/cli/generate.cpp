#include "cli/generate.h"

#include "cli/complete.h"
#include "cli/usage_error.h"

#include <stdexcept>

namespace ray::cli {

std::string generate(const Command& command, std::span<const std::string> arguments) {
  const std::string what = arguments.size() > 1 ? arguments[1] : "";
  if (what == "complete") return complete(command, arguments.subspan(2));
  const std::vector<std::string> wrong = mistakes(command);
  if (!wrong.empty()) throw std::logic_error("the table of " + command.name + ": " + wrong.front());
  if (what == "man") return man_page(command);
  if (what == "markdown") return markdown_page(command);
  if (what == "bash") return bash_completion(command.name);
  if (what == "zsh") return zsh_completion(command.name);
  if (what == "fish") return fish_completion(command.name);
  if (what == "summary") return command.name + "\t" + command.summary + "\n";
  throw UsageError("--generate takes man, markdown, bash, zsh, fish, summary or complete", command.name,
                   arguments, 1);
}

}  // namespace ray::cli
