#include "cli/main.h"

#include "cli/generate.h"
#include "cli/help.h"
#include "cli/interrupt.h"
#include "cli/parse.h"
#include "cli/usage_error.h"

#include <raycloud/core/error.h>

#ifdef __GLIBC__
#include <malloc.h>
#endif

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <exception>
#include <new>
#include <string>
#include <string_view>
#include <vector>

namespace ray::cli {
namespace {

enum Exit { kDone = 0, kFailed = 1, kWrongUsage = 2, kInterrupted = 130 };

void say(std::FILE* stream, std::string_view text) {
  std::fwrite(text.data(), 1, text.size(), stream);
}

int failed(const Command& command, const std::string& why) {
  say(stderr, command.name + ": " + why + "\n");
  return kFailed;
}

/// A result that did not reach standard output is a failure, whatever the command thinks.
int flushed(const Command& command) {
  errno = 0;
  const bool good = std::fflush(stdout) == 0 && std::ferror(stdout) == 0;
  if (good) return kDone;
  const std::string reason = errno != 0 ? std::string(": ") + std::strerror(errno) : "";
  return failed(command, "cannot write to standard output" + reason);
}

int wrong_usage(const Command& command, const Error& error) {
  std::string text = command.name + ": " + error.what() + "\n";
  if (const auto* wrong = dynamic_cast<const UsageError*>(&error)) {
    text += wrong->picture();
    if (!wrong->closest().empty()) text += "Closest usage: " + wrong->closest() + "\n";
  }
  say(stderr, text + "\n" + help(command, HelpDepth::most_needed));
  return kWrongUsage;
}

int answered(const Command& command, const std::string& text) {
  say(stdout, text);
  return flushed(command);
}

/// Algorithms know no file names; what they have to say about the cloud gets its name here. What comes from a
/// file
/// ("scan.ply: …") has one already.
Error about_input(const Error& error, const Match& match) {
  const std::string what = error.what();
  const std::string& input = match.first_input();
  const bool about_data = error.code() == ErrorCode::no_data || error.code() == ErrorCode::out_of_range;
  if (!about_data || input.empty() || what.find(": ") != std::string::npos) return error;
  return {error.code(), input + ": " + what};
}

int run_command(const Command& command, Run run, const std::vector<std::string>& arguments) {
  const Match match = parse(command, arguments);
  catch_interrupts();
  Session session(command, match);
  try {
    run(match, session);
  } catch (const UsageError&) {
    throw;  // as it is: a copy as Error would lose the caret
  } catch (const Error& error) {
    throw about_input(error, match);
  }
  session.finish();
  return flushed(command);
}

/// Buffers and growing tables are freed and allocated again all the time. Handing them back to the system
/// each time would cost a command up to a fifth of its time, in page faults and in telling all cores.
void keep_freed_memory() {
#ifdef __GLIBC__
  mallopt(M_MMAP_THRESHOLD, 1 << 20);
  mallopt(M_TRIM_THRESHOLD, 1 << 30);
  mallopt(M_TOP_PAD, 64 << 20);
#endif
}

int dispatch(const Command& command, Run run, const std::vector<std::string>& arguments) {
  if (!arguments.empty() && arguments[0] == "--generate")
    return answered(command, generate(command, arguments));
  for (std::size_t i = 0; i < arguments.size() && arguments[i] != "--"; ++i) {
    const std::string& word = arguments[i];
    const bool all = word == "--help=all" || (i + 1 < arguments.size() && arguments[i + 1] == "all");
    if (word == "-h" || word == "--help" || word == "--help=all") {
      return answered(command, help(command, all ? HelpDepth::all : HelpDepth::most_needed));
    }
    if (word == "--version") return answered(command, command.name + " " RAYCLOUD_VERSION "\n");
  }
  return run_command(command, run, arguments);
}

}  // namespace

int main(const Command& command, Run run, int argc, char** argv) {
  keep_freed_memory();
  try {
    return dispatch(command, run, {argv + (argc > 0 ? 1 : 0), argv + argc});
  } catch (const Error& error) {
    if (error.code() == ErrorCode::usage) return wrong_usage(command, error);
    if (error.code() != ErrorCode::cancelled) return failed(command, error.what());
    failed(command, "interrupted; nothing was changed");
    return kInterrupted;
  } catch (const std::bad_alloc&) {
    return failed(command, "out of memory: close other programs, or give it a smaller piece of the cloud");
  } catch (const std::exception& error) {
    return failed(command, std::string("internal error: ") + error.what());
  }
}

}  // namespace ray::cli
