// Each kind of word: what it takes, what it makes of it, what it refuses.

#include "cli/cli.h"
#include "cli/parse.h"

#include <raycloud/core/error.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <optional>
#include <string>
#include <vector>

namespace {
using namespace ray::cli;
using testing::ElementsAre;
using testing::HasSubstr;

Command with(Word word) {
  return {.name = "raytest",
          .summary = "s",
          .description = "d",
          .usages = {{.words = {std::move(word)}, .help = "", .example = ""}}};
}

using Words = std::vector<std::string>;

/// The numbers a line gives for the word named N, or nothing if it is refused.
std::optional<std::vector<double>> numbers(const Word& word, const Words& line) {
  const Command command = with(word);
  try {
    return parse(command, line).components("N");
  } catch (const ray::Error& error) {
    EXPECT_EQ(error.code(), ray::ErrorCode::usage);
    return std::nullopt;
  }
}

bool takes(const Word& word, const Words& line) {
  return numbers(word, line).has_value();
}

double one(const Word& word, const Words& line) {
  const auto found = numbers(word, line);
  return found && found->size() == 1 ? found->front() : -12345.0;
}

TEST(words, number) {
  EXPECT_EQ(one(number("N"), {"-5"}), -5.0);
  EXPECT_EQ(one(number("N"), {"-.5"}), -0.5);
  EXPECT_EQ(one(number("N"), {"+2.5e3"}), 2500.0);
  for (const char* bad :
       {"", "x", "1x", "1,2", "inf", "-inf", "nan", "1e999", "0x10", "--5", "+-5", " 1", "1 "}) {
    EXPECT_FALSE(takes(number("N"), {bad})) << bad;
  }
}

TEST(words, ranges) {
  EXPECT_TRUE(takes(number("N", kNonNegative), {"0"}));
  EXPECT_FALSE(takes(number("N", kNonNegative), {"-1e-9"}));
  EXPECT_FALSE(takes(number("N", kPositive), {"0"}));
  EXPECT_TRUE(takes(number("N", kPositive), {"1e-300"}));
  EXPECT_TRUE(takes(number("N", between(0, 1)), {"1"}));
  EXPECT_FALSE(takes(number("N", between(0, 1)), {"1.0001"}));
}

TEST(words, integer) {
  EXPECT_EQ(one(integer("N"), {"-3"}), -3.0);
  EXPECT_EQ(one(integer("N"), {"9007199254740992"}), 9007199254740992.0);
  for (const char* bad : {"1.5", "9007199254740994", "1e300", "three", ""}) {
    EXPECT_FALSE(takes(integer("N"), {bad})) << bad;
  }
}

RC_GTEST_PROP(words, every_integer_comes_back, ()) {
  const auto value = *rc::gen::inRange<std::int64_t>(-(std::int64_t{1} << 53), std::int64_t{1} << 53);
  const Command command = with(integer("N"));
  RC_ASSERT(parse(command, Words{std::to_string(value)}).integer("N") == value);
}

TEST(words, vector) {
  Word three = vector("X,Y,Z");
  three.name = "N";
  EXPECT_THAT(*numbers(three, {"-1,2.5,3e1"}), ElementsAre(-1.0, 2.5, 30.0));
  for (const char* bad :
       {"1,2", "1,2,3,4", "1,2,", ",1,2", "1,,2", "1, 2, 3", "1;2;3", "a,b,c", "1,2,3x", "1,2,nan"}) {
    EXPECT_FALSE(takes(three, {bad})) << bad;
  }
  EXPECT_FALSE(takes(three, {"1,", "2,", "3"}));
  Word four = vector("X,Y,Z[,T]");
  four.name = "N";
  EXPECT_THAT(*numbers(four, {"1,2,3"}), ElementsAre(1.0, 2.0, 3.0));
  EXPECT_THAT(*numbers(four, {"1,2,3,4"}), ElementsAre(1.0, 2.0, 3.0, 4.0));
  EXPECT_FALSE(takes(four, {"1,2"}));
  EXPECT_FALSE(takes(four, {"1,2,3,4,5"}));
  Word tint = colour("R,G,B");
  tint.name = "N";
  EXPECT_TRUE(takes(tint, {"0,0.5,1"}));
  EXPECT_FALSE(takes(tint, {"0,0.5,255"}));
}

TEST(words, a_length_is_the_same_in_every_unit) {
  for (const Words& line : {Words{"4", "cm"}, Words{"40", "mm"}, Words{"0.04", "m"}, Words{"4cm"},
                            Words{"40mm"}, Words{"0.04m"}}) {
    EXPECT_EQ(one(length("N"), line), 0.04) << line.front();
  }
  for (const Words& line :
       {Words{"4"}, Words{"4", "km"}, Words{"4", "CM"}, Words{"0", "cm"}, Words{"-4", "cm"}, Words{"cm"},
        Words{"cm", "4"}, Words{"4cmx"}, Words{"4", "cm", "x"}, Words{"4", "cm/ray"}, Words{"4", ""},
        Words{"nan", "cm"}}) {
    EXPECT_FALSE(takes(length("N"), line)) << testing::PrintToString(line);
  }
}

TEST(words, a_length_per_something) {
  EXPECT_EQ(one(length_per("N", "ray"), {"20", "cm/ray"}), 0.2);
  EXPECT_EQ(one(length_per("N", "m"), {"30", "mm/m"}), 0.03);
  EXPECT_EQ(one(length_per("N", "m"), {"3cm/m"}), 0.03);
  EXPECT_FALSE(takes(length_per("N", "ray"), {"20", "cm"}));
  EXPECT_FALSE(takes(length_per("N", "ray"), {"20", "cm/m"}));
}

TEST(words, counts_are_singular_or_plural) {
  EXPECT_EQ(one(count("N", "ray"), {"10", "rays"}), 10.0);
  EXPECT_EQ(one(count("N", "ray"), {"1", "ray"}), 1.0);
  EXPECT_EQ(one(count("N", "branch"), {"3", "branches"}), 3.0);
  for (const Words& line : {Words{"0", "rays"}, Words{"-1", "rays"}, Words{"2.5", "rays"}, Words{"10"},
                            Words{"10", "rayss"}, Words{"10", "points"}}) {
    EXPECT_FALSE(takes(count("N", "ray"), line)) << testing::PrintToString(line);
  }
  EXPECT_EQ(one(quantity("N", "sigma"), {"2.5", "sigmas"}), 2.5);
  EXPECT_EQ(one(quantity("N", "%"), {"3", "%"}), 3.0);
  EXPECT_EQ(one(quantity("N", "%"), {"3%"}), 3.0);
  EXPECT_FALSE(takes(quantity("N", "sigma"), {"0", "sigmas"}));
}

TEST(words, memory_sizes) {
  EXPECT_EQ(one(size("N"), {"4GB"}), 4e9);
  EXPECT_EQ(one(size("N"), {"4gb"}), 4e9);
  EXPECT_EQ(one(size("N"), {"1.5KiB"}), 1536.0);
  EXPECT_EQ(one(size("N"), {"2TB"}), 2e12);
  EXPECT_EQ(one(size("N"), {"512MiB"}), 512.0 * 1024 * 1024);
  EXPECT_EQ(one(size("N"), {"100000"}), 1e5);
  for (const char* bad : {"0", "-1GB", "4XB", "GB", "0.1", "4G B", "1e30GB", "4iB", ""}) {
    EXPECT_FALSE(takes(size("N"), {bad})) << bad;
  }
}

TEST(words, files_are_any_name_but_the_words_of_the_command_and_vectors) {
  const Command command{.name = "raytest",
                        .summary = "s",
                        .description = "d",
                        .usages = {{.words = {input("A"), literal("box")}, .help = "", .example = ""},
                                   {.words = {input("A"), count("N", "ray")}, .help = "", .example = ""}}};
  for (const char* good : {"a.ply", "./box", "b ox.las", "-", "12", "3d.ply", "1,a.ply", "été.ply"}) {
    EXPECT_EQ(parse(command, Words{good, "box"}).text("A"), good);
  }
  for (const char* bad : {"box", "ray", "rays", "1,2,3", "-1,2", ""}) {
    EXPECT_THROW(static_cast<void>(parse(command, Words{bad, "box"})), ray::Error) << bad;
  }
}

TEST(words, lists_leave_words_for_the_rest) {
  const Command command{.name = "raytest",
                        .summary = "s",
                        .description = "d",
                        .usages = {{.words = {inputs("FILES"), output("LAST"), optional(count("N", "ray"))},
                                    .help = "",
                                    .example = ""}}};
  const Match plain = parse(command, Words{"a", "b", "c"});
  EXPECT_THAT(plain.files("FILES"), ElementsAre("a", "b"));
  EXPECT_EQ(plain.text("LAST"), "c");
  EXPECT_FALSE(plain.has("N"));
  const Match counted = parse(command, Words{"a", "b", "10", "rays"});
  EXPECT_THAT(counted.files("FILES"), ElementsAre("a"));
  EXPECT_EQ(counted.integer("N"), 10);
  EXPECT_THROW(static_cast<void>(parse(command, Words{"a"})), ray::Error);
}

TEST(words, forms_are_those_of_the_manual) {
  EXPECT_EQ(form(length("WIDTH")), "WIDTH cm");
  EXPECT_EQ(form(length_per("WIDTH", "ray")), "WIDTH cm/ray");
  EXPECT_EQ(form(count("N", "ray")), "N rays");
  EXPECT_EQ(form(choice("VIEW", {"top", "left"})), "top|left");
  EXPECT_EQ(form(optional(clouds())), "[CLOUDS...]");
  EXPECT_EQ(form(vector("X,Y,Z[,T]")), "X,Y,Z[,T]");
}

}  // namespace
