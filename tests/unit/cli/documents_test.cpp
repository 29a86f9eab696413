// Help, manual, reference page and completion hold everything that is in the table, and are valid in their
// formats.

#include "cli/complete.h"
#include "cli/generate.h"
#include "cli/help.h"
#include "cli/layout.h"
#include "cli/shell_words.h"
#include "support/scratch.h"
#include "unit/cli/example_command.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace {
using namespace ray::cli;
using testing::HasSubstr;
using testing::Not;

/// Text without what a format adds, so that a form can be looked for.
std::string plain(std::string text) {
  const auto drop = [&](const std::string& what, const std::string& instead) {
    for (std::size_t at = text.find(what); at != std::string::npos;
         at = text.find(what, at + instead.size())) {
      text.replace(at, what.size(), instead);
    }
  };
  drop("\\-", "-");
  drop("\\fB", "");
  drop("\\fR", "");
  drop("\\|", "|");
  return text;
}

/// Line breaks and indents as single spaces.
std::string in_one_line(const std::string& text) {
  std::string line;
  for (const std::string& word : split_words(text))
    line += (line.empty() ? "" : " ") + word;
  return line;
}

TEST(documents, everything_of_the_table_is_in_every_document) {
  for (const std::string& document :
       {help(thin(), HelpDepth::all), man_page(thin()), markdown_page(thin())}) {
    const std::string text = in_one_line(plain(document));
    EXPECT_THAT(text, HasSubstr(thin().summary));
    EXPECT_THAT(text, HasSubstr(thin().writes));
    EXPECT_THAT(text, HasSubstr(thin().memory));
    for (const Usage& usage : thin().usages) {
      EXPECT_THAT(text, HasSubstr(form(thin(), usage)));
      EXPECT_THAT(text, HasSubstr(usage.example));
      EXPECT_THAT(text, HasSubstr(usage.help.substr(1)));  // the manual starts it with a capital
    }
    for (const Option& option : all_options(thin())) {
      EXPECT_THAT(text, HasSubstr(signature(option)));
      EXPECT_THAT(text, HasSubstr(option.help.substr(1)));
      EXPECT_THAT(text, HasSubstr(option.fallback));
    }
  }
}

TEST(documents, the_short_help_has_what_most_people_need) {
  const std::string text = help(thin(), HelpDepth::most_needed);
  for (const Option& option : all_options(thin())) {
    const auto expected = HasSubstr("--" + option.name + (option.value ? " " : "  "));
    if (option.advanced) {
      EXPECT_THAT(text, Not(expected));
    } else {
      EXPECT_THAT(text, expected);
    }
  }
}

TEST(documents, help_fits_eighty_columns) {
  const std::string text = help(thin(), HelpDepth::all) + wrapped("a " + std::string(200, 'x') + " b", 4);
  std::size_t begin = 0;
  while (begin < text.size()) {
    const std::size_t end = text.find('\n', begin);
    const std::string line = text.substr(begin, end - begin);
    EXPECT_TRUE(columns(line) <= 80 || line.find("xxx") != std::string::npos) << line;
    begin = end + 1;
  }
}

TEST(documents, words_and_their_meanings_stand_on_lines_of_their_own) {
  Command command = thin();
  command.description = "Words:\n\n  first   the one\n  second  the\n  third   `next`\n\nThe end.";
  EXPECT_THAT(help(command, HelpDepth::all),
              HasSubstr("Words:\n\n  first   the one\n  second  the\n  third   `next`\n\nThe end.\n"));
  EXPECT_THAT(markdown_page(command),
              HasSubstr("Words:\n\n- `first`: the one\n- `second`: the\n- `third`: `next`\n\nThe end.\n"));
  EXPECT_THAT(man_page(command), HasSubstr(".PP\nWords:\n.TP\n\\fBfirst\\fR\nthe one\n.TP\n"));
}

bool offers(const std::vector<std::string>& words, const std::string& candidate) {
  return ("\n" + complete(thin(), words)).find("\n" + candidate + "\t") != std::string::npos;
}

TEST(completion, offers_what_the_grammar_allows_next) {
  EXPECT_EQ(complete(thin(), std::vector<std::string>{""}), "\tlas laz ply\n");
  for (const char* unit : {"cm", "mm", "m", "rays", "ray", "cm/ray"})
    EXPECT_TRUE(offers({"a.ply", "4", ""}, unit)) << unit;
  EXPECT_FALSE(offers({"a.ply", "4", ""}, "points"));
  EXPECT_TRUE(offers({"a.ply", "4", "cm", "9", "p"}, "points"));
  EXPECT_FALSE(offers({"a.ply", "4", "cm", "9", "p"}, "cm"));
  EXPECT_FALSE(offers({"a.ply", "0.5", ""}, "rays"));
}

TEST(completion, offers_every_option_once) {
  for (const Option& option : all_options(thin())) {
    EXPECT_TRUE(offers({"a.ply", "--"}, "--" + option.name)) << option.name;
    EXPECT_TRUE(offers({"a.ply", "4", "cm", "--" + option.name.substr(0, 2)}, "--" + option.name))
        << option.name;
  }
  EXPECT_FALSE(offers({"a.ply", "--lit", "--"}, "--lit"));
  EXPECT_TRUE(offers({"a.ply", "4", "cm", "2", "points", ""}, "--lit"));
}

TEST(completion, offers_the_values_of_options) {
  EXPECT_EQ(complete(thin(), std::vector<std::string>{"a.ply", "--ground", ""}), "\tply\n");
  EXPECT_EQ(complete(thin(), std::vector<std::string>{"a.ply", "--resolution", ""}), "");
  EXPECT_TRUE(offers({"--resolution", "9", "a.ply", "4", ""}, "cm"));
}

TEST(completion, says_nothing_about_a_line_that_is_wrong_already) {
  EXPECT_FALSE(offers({"a.ply", "miles", ""}, "cm"));
  EXPECT_EQ(complete(thin(), {}), "\tlas laz ply\n");
}

bool installed(const std::string& program) {
  return std::system(("command -v " + program + " >/dev/null 2>&1").c_str()) == 0;
}

/// Writes the text and runs `program ... FILE`, which must succeed without a word.
void expect_silent(const std::string& text, const std::string& program, const std::string& arguments) {
  if (!installed(program)) GTEST_SKIP() << program << " is not installed";
  const ray::test::Scratch scratch;
  const std::string file = scratch.path("document").string();
  const std::string said = scratch.path("said").string();
  std::ofstream(file) << text;
  const std::string line = program + " " + arguments + " '" + file + "' 2>'" + said + "' >/dev/null";
  EXPECT_EQ(std::system(line.c_str()), 0);
  std::ifstream answer(said);
  EXPECT_EQ(std::string(std::istreambuf_iterator<char>(answer), {}), "");
}

TEST(documents, the_manual_is_valid_roff) {
  Command command = thin();
  command.description = ".starts with a point\n\n'and a quote\\ back`slash` ± 3° \xE2\x80\xA6 -dash- `-code`";
  expect_silent(man_page(command), "groff", "-man -Tutf8 -ww");
}
TEST(documents, the_bash_completion_is_valid) {
  expect_silent(bash_completion("raythin"), "bash", "-n");
}
TEST(documents, the_zsh_completion_is_valid) {
  expect_silent(zsh_completion("raythin"), "zsh", "-n");
}
TEST(documents, the_fish_completion_is_valid) {
  expect_silent(fish_completion("raythin"), "fish", "--no-execute");
}

}  // namespace
