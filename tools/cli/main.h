#pragma once
/// What every command's `main` is: parse, run, report; the only try/catch of the project.

#include "cli/command.h"
#include "cli/match.h"
#include "cli/session.h"

namespace ray::cli {

/// The command itself: opens its files, makes one call of the library, reports. Throws what goes wrong.
using Run = void (*)(const Match& match, Session& session);

/// Answers --help, --version and --generate, or parses and runs. Returns the exit status: 0 done; 1 a
/// failure, told in one line on standard error (an unwritable standard output is one); 2 a wrong command
/// line, told with a caret, the closest usage and the help; 130 interrupted by Ctrl-C or SIGTERM (a second
/// one kills).
[[nodiscard]] int main(const Command& command, Run run, int argc, char** argv);

}  // namespace ray::cli
