#include "cli/cli.h"
#include "cli/commands.h"
#include "cli/layout.h"
#include "cli/suggest.h"
#include "git_driver.h"

#include <unistd.h>

#include <filesystem>
#include <string>
#include <system_error>
#include <vector>

namespace {
using namespace ray::cli;

const Command kCommand{
    .name = "raycloud",
    .summary = "run any of the ray cloud commands",
    .description =
        R"(`raycloud decimate` runs `raydecimate` with the words that follow, and so for every command.
Commands are looked for beside this program and then in `PATH`.

`raycloud git install` makes git merge `.ply` files with `raycombine BASE all CLOUD1 CLOUD2`: it sets the merge
driver `plymerge` in your configuration of git and the attribute `*.ply merge=plymerge`. Doing it again changes
nothing; `raycloud git uninstall` takes both out.

The options below may follow the words of every command.)",
    .usages = {{.name = "list", .words = {}, .help = "lists the commands", .example = "raycloud"},
               {.name = "help",
                .words = {literal("help"), text("COMMAND")},
                .help = "shows how to use a command",
                .example = "raycloud help decimate"},
               {.name = "git",
                .words = {literal("git"), choice("WHAT", {"install", "uninstall"})},
                .help = "makes git merge ray clouds, or no more",
                .example = "raycloud git install"},
               {.name = "run",
                .words = {text("COMMAND"), optional(inputs("WORD"))},
                .help = "runs a command",
                .example = "raycloud decimate cloud.ply 4 cm"}},
    .options = {{.name = "repository",
                 .help = "for the repository of this folder alone, not for all of this user",
                 .usages = {"git"}}},
    .see_also = {"rayimport", "rayinfo", "raycombine"}};

constexpr std::string_view kPrefix = "ray";

void set_up_git(const Match& match, Session& session) {
  using namespace ray::tools;
  const bool alone = match.has("--repository");
  const GitScope scope = alone ? GitScope::repository : GitScope::user;
  const bool install = match.text("WHAT") == "install";
  const std::filesystem::path file = install ? install_git_driver(scope) : uninstall_git_driver(scope);
  session.note(std::string("git ") +
               (install ? "merges .ply files with raycombine now" : "merges .ply files as before") +
               (alone ? " in this repository" : "") + " (attributes: " + file.string() + ")");
}

void run(const Match& match, Session& session) {
  if (match.usage() == "git") {
    set_up_git(match, session);
    return;
  }
  std::vector<std::string> names;
  std::vector<std::pair<std::string, std::string>> rows;
  for (const ListedCommand& listed : kCommands) {
    names.emplace_back(listed.name.substr(kPrefix.size()));
    rows.emplace_back("raycloud " + names.back(), listed.summary);
  }
  if (match.usage() != "list") {
    const std::string& typed = match.text("COMMAND");
    if (typed == "git") match.reject("COMMAND", "git wants to be told one thing: install or uninstall");
    match.reject("COMMAND", "there is no command " + typed + did_you_mean(typed, names));
  }
  session.print(two_columns(rows) +
                "\nraycloud help COMMAND shows how to use one; the commands are also there as " +
                "raydecimate and so on.\n");
}

/// `raydecimate` for `decimate` and for `raydecimate`.
std::string program_of(const std::string& command) {
  return command.starts_with(kPrefix) ? command : "ray" + command;
}

/// Becomes the program; returns only if there is none that can be run.
void become(const std::string& command, std::vector<std::string> words) {
  if (command.empty() || command.find('/') != std::string::npos || program_of(command) == kCommand.name)
    return;
  words.insert(words.begin(), program_of(command));
  std::vector<char*> arguments;
  for (std::string& word : words)
    arguments.push_back(word.data());
  arguments.push_back(nullptr);
  std::error_code error;
  const std::filesystem::path self = std::filesystem::read_symlink("/proc/self/exe", error);
  if (!error) ::execv((self.parent_path() / words.front()).c_str(), arguments.data());
  ::execvp(arguments.front(), arguments.data());
}

/// For the shell's completion of `raycloud COMM…`; the rest of the line is the command's own business.
int complete_command(const std::string& typed) {
  std::string lines;
  for (const ListedCommand& listed : kCommands) {
    const std::string_view name = listed.name.substr(kPrefix.size());
    if (name.starts_with(typed)) lines += std::string(name) + "\t" + std::string(listed.summary) + "\n";
  }
  return ::write(STDOUT_FILENO, lines.data(), lines.size()) == static_cast<ssize_t>(lines.size()) ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  const std::vector<std::string> words(argv + 1, argv + argc);
  if (words.empty()) return ray::cli::main(kCommand, run, argc, argv);
  const std::vector<std::string> rest(words.begin() + 1, words.end());
  if (words.size() == 1 && (words[0] == "help" || words[0] == "--help" || words[0] == "-h")) {
    return ray::cli::main(kCommand, run, 1, argv);
  }
  if (words[0] == "help") {
    std::vector<std::string> asked{"--help"};
    asked.insert(asked.end(), rest.begin() + 1, rest.end());
    become(rest[0], asked);
    return ray::cli::main(kCommand, run, 3, argv);
  }
  if (words.size() >= 3 && words[0] == "--generate" && words[1] == "complete") {
    if (words.size() == 3) return complete_command(words[2]);
    std::vector<std::string> asked{"--generate", "complete"};
    asked.insert(asked.end(), words.begin() + 3, words.end());
    become(words[2], asked);
    return 1;
  }
  if (words[0].starts_with('-') || words[0] == "git") return ray::cli::main(kCommand, run, argc, argv);
  become(words[0], rest);
  return ray::cli::main(kCommand, run, 2, argv);
}
