// From a command line to a usage, its options and their values; and what is said when it does not fit.

#include "cli/parse.h"

#include "cli/shell_words.h"
#include "cli/usage_error.h"
#include "unit/cli/example_command.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <stdexcept>
#include <string>
#include <vector>

namespace {
using namespace ray::cli;
using testing::HasSubstr;
using testing::Not;

Match thinned(const std::string& line) {
  return parse(thin(), split_words(line));
}

/// What is said about a line that must not fit.
UsageError refused(const Command& command, const std::vector<std::string>& words) {
  try {
    static_cast<void>(parse(command, words));
  } catch (const UsageError& error) {
    return error;
  }
  ADD_FAILURE() << "fits: " << testing::PrintToString(words);
  return {"", "", {}, 0};
}

UsageError refused(const std::string& line) {
  return refused(thin(), split_words(line));
}

/// The word of the command line that the caret is under.
std::string pointed_at(const UsageError& error) {
  std::string picture = error.picture();
  std::erase_if(picture,
                [](char c) { return (static_cast<unsigned char>(c) & 0xC0u) == 0x80u; });  // é is one column
  const std::size_t second = picture.find('\n') + 1;
  const std::size_t caret = picture.find('^', second) - second;
  const std::size_t end = picture.find('\n', second) - second;
  return picture.substr(0, second - 1).substr(std::min(caret, second - 1), end - caret);
}

TEST(parse, the_usage_that_fits) {
  EXPECT_EQ(thinned("a.ply 4 cm").usage(), "width");
  EXPECT_EQ(thinned("a.ply 10 rays").usage(), "every");
  EXPECT_EQ(thinned("a.ply 20 cm/ray").usage(), "per");
  const Match points = thinned("a.ply 20 cm 64 points");
  EXPECT_EQ(points.usage(), "points");
  EXPECT_EQ(points.length("WIDTH"), ray::Metres{0.2});
  EXPECT_EQ(points.integer("N"), 64);
  EXPECT_EQ(points.text("CLOUD"), "a.ply");
}

TEST(parse, options_stand_anywhere) {
  for (const char* line :
       {"a.ply 4 cm -r 9 -q --output b.ply", "--output=b.ply a.ply -q 4 -r 9 cm",
        "-r 9 -o b.ply -q a.ply 4cm", "--resolution=9 a.ply 4 --quiet cm --output b.ply"}) {
    const Match match = thinned(line);
    EXPECT_EQ(match.text("--output"), "b.ply") << line;
    EXPECT_EQ(match.integer("--resolution"), 9) << line;
    EXPECT_TRUE(match.has("--quiet")) << line;
    EXPECT_FALSE(match.has("--lit")) << line;
  }
}

TEST(parse, fallbacks_count_as_values_but_not_as_given) {
  const Match match = thinned("a.ply 4 cm");
  EXPECT_EQ(match.integer("--resolution"), 512);
  EXPECT_FALSE(match.has("--resolution"));
}

TEST(parse, negative_values_are_not_options) {
  EXPECT_EQ(thinned("a.ply 4 cm --shift -1,2,3").vector("--shift"), Eigen::Vector3d(-1, 2, 3));
  EXPECT_EQ(thinned("a.ply 4 cm --time_offset -.5").number("--time_offset"), -0.5);
  EXPECT_EQ(thinned("a.ply 4 cm --time_offset=-5").number("--time_offset"), -5.0);
  EXPECT_EQ(thinned("- 4 cm").text("CLOUD"), "-");
}

TEST(parse, two_dashes_end_the_options) {
  EXPECT_EQ(thinned("-q -- --odd.ply 4 cm").text("CLOUD"), "--odd.ply");
  EXPECT_FALSE(thinned("-- -q 4 cm").has("--quiet"));
}

TEST(parse, dashes_and_underscores_in_names_are_the_same) {
  EXPECT_EQ(thinned("a.ply 4 cm --time-offset 5").number("--time_offset"), 5.0);
}

TEST(parse, a_vector_is_not_a_file) {
  const Command import{
      .name = "rayget",
      .summary = "s",
      .description = "d",
      .usages = {{.name = "path", .words = {input("POINTS"), input("TRAJECTORY")}, .help = "", .example = ""},
                 {.name = "fixed", .words = {input("POINTS"), vector("X,Y,Z")}, .help = "", .example = ""},
                 {.name = "ray",
                  .words = {input("POINTS"), literal("ray"), vector("X,Y,Z")},
                  .help = "",
                  .example = ""},
                 {.name = "scans", .words = {inputs("SCANS")}, .help = "", .example = ""}}};
  const auto usage = [&](const std::string& line) { return parse(import, split_words(line)).usage(); };
  EXPECT_EQ(usage("a.las b.txt"), "path");
  EXPECT_EQ(usage("a.las 1,2,3"), "fixed");
  EXPECT_EQ(usage("a.las -1,2,-3"), "fixed");
  EXPECT_EQ(usage("a.las ray 0,0,-1"), "ray");
  EXPECT_EQ(usage("a.las b.las c.las"), "scans");
  EXPECT_EQ(usage("a.las"), "scans");
  EXPECT_EQ(usage("a.las ./ray"), "path");
  EXPECT_EQ(pointed_at(refused(import, {"a.las", "1,2"})), "1,2");
  EXPECT_EQ(pointed_at(refused(import, {"a.las", "ray"})), "");
}

TEST(parse, the_caret_is_under_the_wrong_word) {
  EXPECT_EQ(pointed_at(refused("a.ply 4 miles")), "miles");
  EXPECT_EQ(pointed_at(refused("a.ply four cm")), "four");
  EXPECT_EQ(pointed_at(refused("a.ply -q 4 --lit miles")), "miles");
  EXPECT_EQ(pointed_at(refused("a.ply 4 cm more")), "more");
  EXPECT_EQ(pointed_at(refused("a.ply 0 rays")), "0");
  EXPECT_EQ(pointed_at(refused("a.ply 2.5 rays")), "2.5");
  EXPECT_EQ(pointed_at(refused("a.ply -4 cm")), "-4");
  EXPECT_EQ(pointed_at(refused("a.ply 4 cm --resolution x")), "x");
  EXPECT_EQ(pointed_at(refused("a.ply 4 cm --resolution=x")), "--resolution=x");
  EXPECT_EQ(pointed_at(refused("a.ply 4 cm --frobnicate")), "--frobnicate");
  EXPECT_EQ(pointed_at(refused("a.ply --lit 4 --lit cm")), "--lit");
  EXPECT_EQ(pointed_at(refused(thin(), {"été.ply", "4", "my miles"})), "'my miles'");
}

TEST(parse, a_missing_word_has_the_caret_behind_the_line) {
  for (const char* line : {"", "a.ply", "a.ply 4", "a.ply 4 cm --output", "-q"}) {
    const UsageError error = refused(line);
    EXPECT_EQ(pointed_at(error), "") << line;
    EXPECT_THAT(error.picture(), HasSubstr("^\n")) << line;
  }
}

TEST(parse, the_message_says_what_belongs_there) {
  EXPECT_THAT(refused("a.ply 4 miles").what(), HasSubstr("cm, mm, m, rays, cm/ray"));
  EXPECT_THAT(refused("a.ply 4 cm more").what(), HasSubstr("nothing more"));
  EXPECT_THAT(refused("a.ply 2.5 rays").what(), HasSubstr("whole number"));
  EXPECT_THAT(refused("a.ply 4 cm --output").what(), HasSubstr("needs a value"));
  EXPECT_THAT(refused("a.ply 4 cm --output -q").what(), HasSubstr("needs a value"));
  EXPECT_THAT(refused("a.ply 4 cm --lit=yes").what(), HasSubstr("takes no value"));
  EXPECT_THAT(refused("a.ply 4 cm -q --quiet").what(), HasSubstr("twice"));
  EXPECT_THAT(refused("a.ply 10 rays --ground g.ply").what(), HasSubstr("does not go with"));
  EXPECT_THAT(refused("a.ply 4 cm --threads 0").what(), HasSubstr("from 1"));
  EXPECT_EQ(std::string(refused("a.ply 4 miles").what()).find('\n'), std::string::npos);
}

TEST(parse, slips_of_the_keyboard_are_recognised) {
  EXPECT_THAT(refused("a.ply 10 rasy").what(), HasSubstr("did you mean rays?"));
  EXPECT_THAT(refused("a.ply 10 pionts").what(), Not(HasSubstr("did you mean")));
  EXPECT_THAT(refused("a.ply 20 cm 10 pionts").what(), HasSubstr("did you mean points?"));
  EXPECT_THAT(refused("a.ply 4 cm --thread 3").what(), HasSubstr("did you mean --threads?"));
  EXPECT_THAT(refused("a.ply 4 cm --xyzzy").what(), Not(HasSubstr("did you mean")));
}

TEST(parse, a_slip_tells_more_than_a_file_name_that_fits_anything) {
  const Command split{
      .name = "raycut",
      .summary = "s",
      .description = "d",
      .usages = {
          {.words = {cloud(), literal("plane"), vector("X,Y,Z")}, .help = "", .example = ""},
          {.words = {cloud(), input("MESH"), literal("distance"), number("D")}, .help = "", .example = ""}}};
  const UsageError error = refused(split, {"a.ply", "plain", "1,2,3"});
  EXPECT_EQ(pointed_at(error), "plain");
  EXPECT_THAT(error.what(), HasSubstr("did you mean plane?"));
  EXPECT_EQ(error.closest(), "raycut CLOUD plane X,Y,Z");
}

TEST(parse, the_closest_usage) {
  EXPECT_EQ(refused("a.ply 2.5 rays").closest(), "raythin CLOUD N rays");
  EXPECT_EQ(refused("a.ply 20 cm 64 pionts").closest(), "raythin CLOUD WIDTH cm N points");
  EXPECT_EQ(refused("a.ply 20 cm 64").closest(), "raythin CLOUD WIDTH cm N points");
  EXPECT_EQ(refused("a.ply 20 cm/rax").closest(), "raythin CLOUD WIDTH cm/ray");
  EXPECT_EQ(refused("a.ply 10 rays --xyzzy").closest(), "raythin CLOUD N rays");
  EXPECT_EQ(refused("a.ply 10 rays --xyzzy 4").closest(), "raythin CLOUD N rays");
}

TEST(parse, a_long_line_is_shown_around_the_caret) {
  std::vector<std::string> words(500, "some_long_file_name.ply");
  words[250] = "4\ncm";
  const UsageError error("no", "raythin", words, 250);
  EXPECT_EQ(pointed_at(error), "'4?cm'");
  EXPECT_LT(error.picture().size(), 250u);
}

TEST(parse, a_command_can_reject_a_value) {
  const Match match = thinned("a.ply -r 9 4 cm");
  try {
    match.reject("--resolution", "must be even");
  } catch (const UsageError& error) {
    EXPECT_EQ(pointed_at(error), "9");
    EXPECT_STREQ(error.what(), "must be even");
  }
}

TEST(parse, asking_for_what_is_not_there_is_a_mistake_of_the_program) {
  const Match match = thinned("a.ply 4 cm");
  EXPECT_THROW(static_cast<void>(match.has("--colour")), std::logic_error);
  EXPECT_THROW(static_cast<void>(match.text("--output")), std::logic_error);
  EXPECT_THROW(static_cast<void>(match.number("CLOUD")), std::logic_error);
  EXPECT_THROW(static_cast<void>(match.vector("WIDTH")), std::logic_error);
}

TEST(history, leaves_out_files_and_what_does_not_shape_the_result) {
  EXPECT_EQ(thinned("a.ply 4 cm").history(), "raythin 4 cm");
  EXPECT_EQ(thinned("some/where/a.ply 4 cm -q -v -o b.ply --threads 3 --memory=1GB").history(),
            "raythin 4 cm");
  EXPECT_EQ(thinned("--lit -r 9 a.ply 4 cm --ground=g.ply").history(),
            "raythin 4 cm --resolution 9 --ground --lit");
}

TEST(history, does_not_depend_on_the_order_of_options) {
  EXPECT_EQ(thinned("--lit --shift 1,2,3 a.ply 10 rays").history(),
            thinned("a.ply 10 --shift=1,2,3 rays --lit").history());
}

RC_GTEST_PROP(history, is_one_line_of_printable_text, (const std::string& value)) {
  const Command command{.name = "raynote",
                        .summary = "s",
                        .description = "d",
                        .usages = {{.words = {text("T")}, .help = "", .example = ""}}};
  const std::string line = parse(command, std::vector<std::string>{"--", value}).history();
  RC_ASSERT(std::none_of(line.begin(), line.end(), [](char c) { return c >= 0 && c < 32; }));
}

std::string any_word() {
  return *rc::gen::oneOf(
      rc::gen::elementOf(std::vector<std::string>{
          "a.ply", "4",         "cm",           "4cm",     "rays",     "10",     "64",      "points",
          "-q",    "--output",  "--output=",    "--",      "-",        "-1,2,3", "--shift", "cm/ray",
          "-r",    "--threads", "--memory=1GB", "--help",  "all",      "",       "=",       "--=",
          "1e999", "-r=",       "--ground",     "--lit=1", "\xff\xfe", "\n"}),
      rc::gen::arbitrary<std::string>());
}

RC_GTEST_PROP(parse, throws_nothing_but_usage_errors_whatever_is_typed, ()) {
  const auto words = *rc::gen::container<std::vector<std::string>>(rc::gen::exec(any_word));
  try {
    const Match match = parse(thin(), words);
    RC_ASSERT(match.usage_index() < thin().usages.size());
    RC_ASSERT(!match.text("CLOUD").empty());
  } catch (const ray::Error& error) {
    RC_ASSERT(error.code() == ray::ErrorCode::usage);
    const std::string what = error.what();
    RC_ASSERT(what.find('\n') == std::string::npos);
  }
}

TEST(parse, thousands_of_files_are_no_problem) {
  const Command combine{
      .name = "rayadd",
      .summary = "s",
      .description = "d",
      .usages = {
          {.words = {choice("HOW", {"min", "max"}), clouds(), count("N", "ray")}, .help = "", .example = ""},
          {.words = {clouds()}, .help = "", .example = ""}}};
  std::vector<std::string> words(20000, "cloud.ply");
  EXPECT_EQ(parse(combine, words).files("CLOUDS").size(), 20000u);
  words.front() = "min";
  EXPECT_EQ(pointed_at(refused(combine, words)), "");
  words.insert(words.end(), {"10", "rays"});
  EXPECT_EQ(parse(combine, words).files("CLOUDS").size(), 19999u);
}

}  // namespace
