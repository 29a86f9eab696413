// Exit codes and what is said where, of whole runs.

#include "support/scratch.h"
#include "unit/cli/example_command.h"

#include <raycloud/core/error.h>
#include <raycloud/exec/progress.h>

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <new>
#include <stdexcept>
#include <string>
#include <vector>

namespace {
using namespace ray::cli;
using testing::HasSubstr;
using testing::StartsWith;
using testing::internal::CaptureStderr;
using testing::internal::CaptureStdout;
using testing::internal::GetCapturedStderr;
using testing::internal::GetCapturedStdout;

struct Outcome {
  int status;
  std::string out;
  std::string err;
};

Outcome run_with(Run run, std::vector<std::string> words) {
  words.insert(words.begin(), "raythin");
  std::vector<char*> argv;
  for (std::string& word : words)
    argv.push_back(word.data());
  argv.push_back(nullptr);
  CaptureStdout();
  CaptureStderr();
  const int status = ray::cli::main(thin(), run, static_cast<int>(words.size()), argv.data());
  std::string out = GetCapturedStdout();
  return {status, out, GetCapturedStderr()};
}

void does_nothing(const Match&, Session&) {}
const std::vector<std::string> kGood{"a.ply", "4", "cm"};

template <class Exception>
Outcome thrown(Exception exception) {
  static Exception kept = exception;
  kept = exception;
  return run_with([](const Match&, Session&) { throw kept; }, kGood);
}

TEST(main, success_is_silent_and_zero) {
  const Outcome outcome = run_with(does_nothing, kGood);
  EXPECT_EQ(outcome.status, 0);
  EXPECT_EQ(outcome.out + outcome.err, "");
}

TEST(main, a_failure_is_one_line_on_standard_error) {
  for (const ray::ErrorCode code :
       {ray::ErrorCode::file_not_found, ray::ErrorCode::file_access, ray::ErrorCode::file_format,
        ray::ErrorCode::wrong_content, ray::ErrorCode::out_of_range, ray::ErrorCode::no_data}) {
    const Outcome outcome = thrown(ray::Error(code, "a.ply: is cut short"));
    EXPECT_EQ(outcome.status, 1);
    EXPECT_EQ(outcome.out, "");
    EXPECT_EQ(outcome.err, "raythin: a.ply: is cut short\n");
  }
}

TEST(main, other_exceptions) {
  const Outcome cancelled = thrown(ray::Error(ray::ErrorCode::cancelled, "interrupted"));
  EXPECT_EQ(cancelled.status, 130);
  EXPECT_EQ(cancelled.err, "raythin: interrupted; nothing was changed\n");
  const Outcome memory = thrown(std::bad_alloc());
  EXPECT_EQ(memory.status, 1);
  EXPECT_THAT(memory.err, HasSubstr("memory"));
  const Outcome unknown = thrown(std::runtime_error("oh"));
  EXPECT_EQ(unknown.status, 1);
  EXPECT_EQ(unknown.err, "raythin: internal error: oh\n");
  const Outcome usage = thrown(ray::Error(ray::ErrorCode::usage, "both cannot be"));
  EXPECT_EQ(usage.status, 2);
  EXPECT_THAT(usage.err, StartsWith("raythin: both cannot be\n"));
}

TEST(main, a_wrong_command_line) {
  for (const std::vector<std::string>& words :
       std::vector<std::vector<std::string>>{{}, {"a.ply", "4", "miles"}, {"--frob"}}) {
    const Outcome outcome = run_with(does_nothing, words);
    EXPECT_EQ(outcome.status, 2);
    EXPECT_EQ(outcome.out, "");
    EXPECT_THAT(outcome.err, StartsWith("raythin: "));
    EXPECT_THAT(outcome.err, HasSubstr("^"));
    EXPECT_THAT(outcome.err, HasSubstr("\nClosest usage: raythin CLOUD"));
    EXPECT_THAT(outcome.err, HasSubstr("\nOptions:\n"));
  }
}

TEST(main, help_and_version_go_to_standard_output) {
  for (const std::vector<std::string>& words : std::vector<std::vector<std::string>>{
           {"--help"}, {"-h"}, {"a.ply", "--wrong", "--help"}, {"--help", "all"}, {"--help=all"}}) {
    const Outcome outcome = run_with(does_nothing, words);
    EXPECT_EQ(outcome.status, 0);
    EXPECT_EQ(outcome.err, "");
    EXPECT_THAT(outcome.out, HasSubstr("Usage:"));
    const bool all = words.back() == "all" || words.back() == "--help=all";
    EXPECT_EQ(outcome.out.find("--threads") != std::string::npos, all);
  }
  EXPECT_EQ(run_with(does_nothing, {"--version"}).out, "raythin 0.1.0\n");
  EXPECT_EQ(run_with(does_nothing, {"--", "--help"}).status, 2);
}

TEST(main, generates_from_the_table) {
  for (const char* what : {"man", "markdown", "bash", "zsh", "fish", "summary"}) {
    const Outcome outcome = run_with(does_nothing, {"--generate", what});
    EXPECT_EQ(outcome.status, 0) << what;
    EXPECT_THAT(outcome.out, HasSubstr("raythin")) << what;
  }
  EXPECT_EQ(run_with(does_nothing, {"--generate", "tea"}).status, 2);
  EXPECT_EQ(run_with(does_nothing, {"--generate"}).status, 2);
  EXPECT_THAT(run_with(does_nothing, {"--generate", "complete", "a.ply", "4", "m"}).out, HasSubstr("mm\t"));
}

TEST(main, quiet_silences_notes_and_the_summary_but_not_results_and_warnings) {
  const ray::cli::Run talks = [](const Match&, Session& session) {
    session.note("a note");
    session.warn("a warning");
    session.print("a result\n");
    session.summary({.rays_in = 1000, .rays_out = 1});
  };
  const Outcome loud = run_with(talks, kGood);
  EXPECT_THAT(loud.out, StartsWith("raythin: a note\na result\nraythin: 1,000 rays in, 1 out in "));
  EXPECT_EQ(loud.err, "raythin: a warning\n");
  const Outcome quiet = run_with(talks, {"a.ply", "4", "cm", "-q"});
  EXPECT_EQ(quiet.out, "a result\n");
  EXPECT_EQ(quiet.err, "raythin: a warning\n");
}

TEST(main, the_session_carries_what_was_asked) {
  const Outcome outcome = run_with(
      [](const Match&, Session& session) {
        if (session.context().threads != 3 || session.context().memory != 4'000'000'000u)
          throw std::runtime_error("no");
        if (session.context().progress == nullptr || session.context().progress->cancelled())
          throw std::runtime_error("no");
        session.print(session.history());
      },
      {"a.ply", "4", "cm", "--threads", "3", "--memory", "4GB"});
  EXPECT_EQ(outcome.status, 0);
  EXPECT_EQ(outcome.out, "raythin 4 cm");
}

TEST(main, ctrl_c_is_seen_by_the_progress) {
  for (const int signal : {SIGINT, SIGTERM}) {
    static int raised;
    raised = signal;
    const Outcome outcome = run_with(
        [](const Match&, Session& session) {
          std::raise(raised);
          if (session.context().progress->cancelled())
            throw ray::Error(ray::ErrorCode::cancelled, "interrupted");
        },
        kGood);
    EXPECT_EQ(outcome.status, 130);
  }
  EXPECT_EQ(run_with(does_nothing, kGood).status, 0);
}

void interrupted_twice() {
  std::string words[] = {"raythin", "a.ply", "4", "cm"};
  char* argv[] = {words[0].data(), words[1].data(), words[2].data(), words[3].data(), nullptr};
  const auto run = [](const Match&, Session&) {
    std::raise(SIGINT);
    std::raise(SIGINT);
  };
  std::exit(ray::cli::main(thin(), run, 4, argv));
}

TEST(main, a_second_ctrl_c_kills) {
  EXPECT_EXIT(interrupted_twice(), testing::KilledBySignal(SIGINT), "");
}

/// Runs with standard output going to `descriptor`, in a child of its own; the exit status.
[[noreturn]] void run_into(int descriptor, const char* word) {
  ::dup2(descriptor, STDOUT_FILENO);
  std::string program = "raythin", first = word;
  char* argv[] = {program.data(), first.data(), nullptr};
  std::exit(ray::cli::main(thin(), does_nothing, 2, argv));
}

TEST(main, an_unwritable_standard_output_is_a_failure) {
  const int full = ::open("/dev/full", O_WRONLY);
  if (full < 0) GTEST_SKIP() << "no /dev/full here";
  for (const char* word : {"--help", "--version"}) {
    EXPECT_EXIT(run_into(full, word), testing::ExitedWithCode(1), "raythin: cannot write to standard output");
  }
  ::close(full);
}

[[noreturn]] void print_into_closed_pipe() {
  int ends[2] = {};
  if (::pipe(ends) != 0) std::exit(99);
  ::close(ends[0]);
  ::dup2(ends[1], STDOUT_FILENO);
  std::string words[] = {"raythin", "a.ply", "4", "cm"};
  char* argv[] = {words[0].data(), words[1].data(), words[2].data(), words[3].data(), nullptr};
  std::exit(ray::cli::main(
      thin(), [](const Match&, Session& session) { session.print("a result\n"); }, 4, argv));
}

TEST(main, a_closed_pipe_is_a_failure) {
  EXPECT_EXIT(print_into_closed_pipe(), testing::ExitedWithCode(1),
              "raythin: cannot write to standard output");
}

TEST(main, view_opens_the_first_file_in_the_viewer) {
  const ray::test::Scratch scratch;
  const std::string script = scratch.path("viewer").string();
  const std::string seen = scratch.path("seen").string();
  std::ofstream(script) << "#!/bin/sh\necho \"$@\" > '" << seen << ".new' && mv '" << seen << ".new' '"
                        << seen << "'\n";
  std::filesystem::permissions(script, std::filesystem::perms::owner_all);
  const ray::cli::Run writes = [](const Match&, Session& session) {
    session.summary({.files = {"first file.ply", "second.ply"}});
  };
  ::setenv("RAYCLOUD_VIEWER", (script + " --flag").c_str(), 1);
  EXPECT_EQ(run_with(writes, {"a.ply", "4", "cm", "--view"}).status, 0);
  for (int i = 0; i < 500 && !std::filesystem::exists(seen); ++i)
    ::usleep(10'000);
  std::string line;
  std::getline(std::ifstream(seen), line);
  EXPECT_EQ(line, "--flag first file.ply");
  ::setenv("RAYCLOUD_VIEWER", "/nowhere/at/all", 1);
  const Outcome none = run_with(writes, {"a.ply", "4", "cm", "-v"});
  ::unsetenv("RAYCLOUD_VIEWER");
  EXPECT_EQ(none.status, 0);
  EXPECT_THAT(none.err, HasSubstr("RAYCLOUD_VIEWER"));
}

}  // namespace
