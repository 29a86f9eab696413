// What a command says about its work, and how it names its files.

#include "cli/session.h"

#include "cli/grouped.h"
#include "cli/output_name.h"
#include "cli/parse.h"
#include "cli/shell_words.h"
#include "cli/terminal_progress.h"
#include "support/scratch.h"
#include "unit/cli/example_command.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <string>
#include <thread>
#include <vector>

namespace {
using namespace ray::cli;
using testing::HasSubstr;
using testing::internal::CaptureStderr;
using testing::internal::GetCapturedStderr;

TEST(summary, says_what_applies) {
  EXPECT_EQ(summary_line({.rays_in = 1234567, .rays_out = 12345}, 0.26),
            "1,234,567 rays in, 12,345 out in 0.3 s");
  EXPECT_EQ(summary_line({.rays_in = 1, .files = {"gone/a.png"}}, 0), "1 ray in, wrote gone/a.png in 0.0 s");
  EXPECT_EQ(summary_line({.rays_out = 999}, 61), "999 rays out in 61.0 s");
  EXPECT_EQ(summary_line({.rays_in = 2, .files = {"a.las", "b.txt"}}, 0),
            "2 rays in, wrote a.las and b.txt in 0.0 s");
  EXPECT_EQ(summary_line({.files = {"1", "2", "3"}}, 0), "wrote 1, 2 and 3 in 0.0 s");
  EXPECT_EQ(summary_line({.files = {"1", "2", "3", "4", "5"}}, 0), "wrote 5 files from 1 to 5 in 0.0 s");
}

TEST(summary, has_the_size_of_files) {
  const ray::test::Scratch scratch;
  const auto file = scratch.path("a.ply");
  std::ofstream(file) << std::string(440000, 'x');
  EXPECT_THAT(summary_line({.files = {file}}, 0), HasSubstr("a.ply (0.44 MB) in"));
  EXPECT_EQ(file_size(1234), "1,234 bytes");
  EXPECT_EQ(file_size(576'000'000), "576.0 MB");
  EXPECT_EQ(file_size(57'600'000'000), "57.60 GB");
}

TEST(summary, groups_digits) {
  EXPECT_EQ(grouped(0), "0");
  EXPECT_EQ(grouped(999), "999");
  EXPECT_EQ(grouped(1000), "1,000");
  EXPECT_EQ(grouped(18446744073709551615u), "18,446,744,073,709,551,615");
}

TEST(output_name, keeps_folder_stem_and_extension) {
  EXPECT_EQ(output_name("a/b.ply", "_decimated"), "a/b_decimated.ply");
  EXPECT_EQ(output_name("b.c.laz", "_thin"), "b.c_thin.laz");
  EXPECT_EQ(output_name("/x/b.ply", "_top", ".png"), "/x/b_top.png");
  EXPECT_EQ(output_name("b", "_thin"), "b_thin");
}

TEST(output_name, gives_way_to_the_option) {
  const auto name = [](const std::string& line) {
    const Match match = parse(thin(), split_words(line));
    return main_output(match, match.text("CLOUD"), "_thin");
  };
  EXPECT_EQ(name("a/b.ply 4 cm"), "a/b_thin.ply");
  EXPECT_EQ(name("a/b.ply 4 cm -o c.laz"), "c.laz");
}

TEST(progress, line) {
  EXPECT_EQ(progress_line("reading", 250, 1000, 1.0), "reading  25 %  250 /s  3 s left");
  EXPECT_EQ(progress_line("reading", 2'000'000, 0, 0.5), "reading  2,000,000  4.0 M/s");
  EXPECT_EQ(progress_line("reading", 0, 1000, 1.0), "reading  0 %");
  EXPECT_EQ(progress_line("reading", 1100, 1000, 1.0), "reading  100 %  1 k/s  0 s left");
  EXPECT_EQ(progress_line("reading", 999, 1000, 0.0), "reading  99 %");
  EXPECT_THAT(progress_line("reading", 1, 1'000'000, 1.0), HasSubstr(" h left"));
}

TEST(progress, nothing_is_shown_where_there_is_no_terminal) {
  CaptureStderr();
  {
    TerminalProgress progress(TerminalProgress::Show::nothing);
    progress.begin("reading", 10);
    progress.advance(5);
    progress.clear();
    progress.end();
  }
  EXPECT_EQ(GetCapturedStderr(), "");
}

TEST(progress, the_line_is_rewritten_and_cleared_at_the_end) {
  CaptureStderr();
  {
    TerminalProgress progress(TerminalProgress::Show::line);
    progress.begin("reading", 10);
    std::vector<std::thread> threads;
    for (int i = 0; i < 5; ++i)
      threads.emplace_back([&] { progress.advance(1); });
    for (std::thread& thread : threads)
      thread.join();
    std::this_thread::sleep_for(std::chrono::milliseconds(350));
    progress.end();
    progress.begin("writing", 0);
    progress.end();
  }
  const std::string shown = GetCapturedStderr();
  EXPECT_THAT(shown, HasSubstr("\rreading  50 %"));
  EXPECT_EQ(shown.find('\n'), std::string::npos);
  ASSERT_FALSE(shown.empty());
  EXPECT_EQ(shown.back(), '\r');
  const std::size_t cleared = shown.rfind('\r', shown.size() - 2);
  EXPECT_EQ(shown.find_first_not_of(" \r", cleared), std::string::npos);
}

}  // namespace
