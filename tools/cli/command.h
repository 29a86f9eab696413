#pragma once
/// The one table per command, from which come the parser, the help, the man page, the completions and the
/// reference page.

#include "cli/word.h"

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace ray::cli {

/// One way to write the command.
struct Usage {
  std::string name = {};    ///< for the program and for Option::usages, never shown; may be empty
  std::vector<Word> words;  ///< after the command's name
  std::string help;         ///< what it does, one line without a capital or full stop
  std::string example;      ///< a complete command line that works: "raydecimate cloud.ply 4 cm"
};

/// One option: a flag, or with a value that is a single word of the command line.
struct Option {
  std::string name;                ///< without the dashes
  char letter = 0;                 ///< `-o`; 0 for none
  std::optional<Word> value = {};  ///< absent for a flag
  std::string help;                ///< one line without a capital or full stop
  std::string fallback = {};  ///< the value when the option is not given; shown in the help. May be empty.
  bool advanced = false;      ///< only in `--help all` and the manual
  std::vector<std::string> usages = {};  ///< names of the usages that take it; empty: all
};

/// A command's manual. Text is plain with `code` in back-quotes and paragraphs parted by an empty line.
struct Command {
  std::string name;
  std::string summary;      ///< one line without a capital or full stop: "thin a ray cloud"
  std::string description;  ///< one or two paragraphs for the manual
  std::vector<Usage> usages;
  std::vector<Option> options = {};        ///< its own; those every command has are added
  std::string writes = {};                 ///< what it writes and where: "CLOUD_decimated.ply"
  std::string memory = {};                 ///< for the manual's section MEMORY
  std::vector<std::string> see_also = {};  ///< names of related commands
};

/// `--output FILE` (`-o`), for a command with one main output, whose usual name is `usual`
/// ("CLOUD_decimated.ply").
[[nodiscard]] Option output_option(const std::string& usual);

/// `--view` (`-v`), for a command whose result a viewer can open. Session::view or the first file of the
/// summary is opened when the command is done.
[[nodiscard]] Option view_option();

/// The command's own options and then those that every command has (--quiet, --threads, --memory, --help,
/// --version).
[[nodiscard]] std::vector<Option> all_options(const Command& command);

/// `raydecimate CLOUD WIDTH cm`.
[[nodiscard]] std::string form(const Command& command, const Usage& usage);

/// `--memory SIZE`.
[[nodiscard]] std::string form(const Option& option);

/// `-o, --output FILE`.
[[nodiscard]] std::string signature(const Option& option);

/// The option's help and its default.
[[nodiscard]] std::string help_text(const Option& option);

/// Whether the option changes what is computed and so belongs into the history: not --threads, --output and
/// the like.
[[nodiscard]] bool shapes_result(const Option& option);

/// What is wrong with the table itself, one line each: two options of one name, an option of an unknown
/// usage, a fallback or an example that does not parse, a missing summary. Empty for a good table.
[[nodiscard]] std::vector<std::string> mistakes(const Command& command);

}  // namespace ray::cli
