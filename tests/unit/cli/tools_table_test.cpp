// Every usage of the design's table of commands can be written as a table of usages and is told from its
// siblings.

#include "cli/cli.h"
#include "cli/parse.h"
#include "cli/shell_words.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace {
using namespace ray::cli;

struct Line {
  std::vector<Word> words;
  std::string example;  ///< without the command's name
};

/// Each example must fit its own usage and no other one better.
void expect_told_apart(const std::vector<Line>& lines) {
  Command command{.name = "raytest", .summary = "s", .description = "d", .usages = {}};
  for (const Line& line : lines) {
    command.usages.push_back({.words = line.words, .help = "h", .example = "raytest " + line.example});
  }
  EXPECT_EQ(mistakes(command), std::vector<std::string>{});
}

const Word kHow = choice("HOW", {"min", "max", "oldest", "newest"});
const Word kMerge = choice("HOW", {"min", "max", "oldest", "newest", "order"});

TEST(tools_table, import_and_export) {
  expect_told_apart({{{input("POINTS"), input("TRAJECTORY")}, "a.laz b.txt"},
                     {{input("POINTS"), vector("X,Y,Z")}, "a.laz -1,2,3"},
                     {{input("POINTS"), literal("ray"), vector("X,Y,Z")}, "a.laz ray 0,0,-10"},
                     {{inputs("SCANS")}, "a.ptx b.ptx c.ptx"}});
  expect_told_apart({{{cloud(), output("POINTS"), output("TRAJ")}, "a.ply - b.txt"}});
}

TEST(tools_table, filters) {
  expect_told_apart({{{cloud(), length("WIDTH")}, "a.ply 4 cm"},
                     {{cloud(), count("N", "ray")}, "a.ply 10 rays"},
                     {{cloud(), length("WIDTH"), count("N", "point")}, "a.ply 20 cm 64 points"},
                     {{cloud(), length_per("WIDTH", "ray")}, "a.ply 20 cm/ray"},
                     {{cloud(), length_per("WIDTH", "m")}, "a.ply 3 cm/m"}});
  expect_told_apart({{{cloud("DECIMATED"), length("WIDTH"), cloud("FULL")}, "a.ply 10 cm b.ply"},
                     {{cloud("DECIMATED"), count("N", "ray"), cloud("FULL")}, "a.ply 10 rays b.ply"}});
  expect_told_apart({{{cloud(), length("DISTANCE")}, "a.ply 4 cm"},
                     {{cloud(), quantity("N", "sigma")}, "a.ply 3 sigmas"},
                     {{cloud(), literal("range"), length("DISTANCE")}, "a.ply range 4 cm"}});
  expect_told_apart({{{kHow, cloud(), count("N", "ray")}, "min a.ply 10 rays"}});
}

TEST(tools_table, combine) {
  expect_told_apart(
      {{{optional(literal("all")), clouds()}, "all a.ply b.ply c.ply d.ply"},
       {{kMerge, clouds(), count("N", "ray")}, "order a.ply b.ply c.ply d.ply 1 ray"},
       {{cloud("BASE"), kMerge, cloud("CLOUD1"), cloud("CLOUD2"), count("N", "ray")},
        "a.ply min b.ply c.ply 10 rays"},
       {{cloud("BASE"), literal("all"), cloud("CLOUD1"), cloud("CLOUD2")}, "a.ply all b.ply c.ply"}});
}

TEST(tools_table, split) {
  expect_told_apart(
      {{{cloud(), literal("plane"), vector("X,Y,Z")}, "a.ply plane 0,0,1"},
       {{cloud(), literal("box"), vector("X,Y,Z"), vector("RX,RY,RZ")}, "a.ply box 0,0,0 1,1,1"},
       {{cloud(), literal("capsule"), vector("AX,AY,AZ"), vector("BX,BY,BZ"), number("R", kPositive)},
        "a.ply capsule 0,0,0 0,0,9 2"},
       {{cloud(), literal("range"), number("R")}, "a.ply range 10"},
       {{cloud(), literal("raydir"), vector("X,Y,Z")}, "a.ply raydir 0,0,0.8"},
       {{cloud(), literal("time"), number("T")}, "a.ply time 1000"},
       {{cloud(), literal("time"), quantity("P", "%")}, "a.ply time 3 %"},
       {{cloud(), literal("alpha"), number("A", between(0, 1))}, "a.ply alpha 0"},
       {{cloud(), literal("colour"), colour()}, "a.ply colour 0.5,0,1"},
       {{cloud(), literal("colour")}, "a.ply colour"},
       {{cloud(), literal("single_colour"), colour()}, "a.ply single_colour 1,0,0"},
       {{cloud(), literal("seg_colour")}, "a.ply seg_colour"},
       {{cloud(), literal("gap"), number("G")}, "a.ply gap 0.1"},
       {{cloud(), literal("grid"), vector("WX,WY,WZ[,WT]"), optional(number("OVERLAP"))},
        "a.ply grid 10,10,0,60 1"},
       {{cloud(), input("MESH"), literal("distance"), number("D")}, "a.ply m.ply distance 0.2"}});
}

TEST(tools_table, moves_and_alignment) {
  expect_told_apart({{{cloud(), vector("X,Y,Z[,T]")}, "a.ply 0,0,1,60"},
                     {{cloud(), literal("add"), input("MESH")}, "a.ply add m.ply"},
                     {{cloud(), literal("subtract"), input("MESH")}, "a.ply subtract m.ply"}});
  expect_told_apart({{{cloud(), vector("RX,RY,RZ")}, "a.ply 0,0,-30"}});
  expect_told_apart({{{cloud()}, "a.ply"}, {{cloud(), cloud("REFERENCE")}, "a.ply b.ply"}});
}

TEST(tools_table, pictures) {
  expect_told_apart(
      {{{cloud(), choice("BY", {"time", "height", "shape", "normal", "alpha", "branches"})}, "a.ply alpha"},
       {{cloud(), literal("alpha"), number("A")}, "a.ply alpha 1"},
       {{cloud(), colour()}, "a.ply 1,1,1"},
       {{cloud(), literal("image"), input("IMAGE")}, "a.ply image b.png"}});
  expect_told_apart(
      {{{cloud(), choice("VIEW", {"top", "left", "right", "front", "back"}),
         choice("STYLE", {"ends", "mean", "sum", "starts", "rays", "height", "density", "density_rgb"})},
        "a.ply top rays"}});
  expect_told_apart(
      {{{cloud(), choice("SIDE", {"upwards", "downwards", "inwards", "outwards"}), number("CURVATURE")},
        "a.ply upwards -0.5"}});
}

TEST(tools_table, scenes_trees_and_reports) {
  expect_told_apart(
      {{{choice("SCENE", {"room", "building", "tree", "forest", "terrain", "field"}), integer("SEED")},
        "forest 3"},
       {{literal("forest"), input("TREES")}, "forest trees.txt"},
       {{literal("terrain"), input("MESH")}, "terrain mesh.ply"}});
  expect_told_apart({{{literal("terrain"), cloud()}, "terrain a.ply"},
                     {{literal("trunks"), cloud()}, "trunks a.ply"},
                     {{literal("forest"), cloud()}, "forest a.ply"},
                     {{literal("trees"), cloud(), input("MESH")}, "trees a.ply m.ply"},
                     {{literal("leaves"), cloud(), input("TREES")}, "leaves a.ply t.txt"}});
  expect_told_apart({{{cloud("CLOUD1"), cloud("CLOUD2")}, "a.ply b.ply"}});
}

/// What is found in a good table after one change.
std::vector<std::string> mistakes_after(void (*change)(Command&)) {
  Command command{
      .name = "raytest",
      .summary = "s",
      .description = "d",
      .usages = {{.words = {cloud(), number("N")}, .help = "h", .example = "raytest a.ply 3"}},
      .options = {{.name = "lit", .letter = 'l', .value = number("S"), .help = "h", .fallback = "1"}}};
  EXPECT_TRUE(mistakes(command).empty());
  change(command);
  return mistakes(command);
}

TEST(tools_table, mistakes_in_a_table_are_found) {
  EXPECT_FALSE(mistakes_after([](Command& c) { c.summary.clear(); }).empty());
  EXPECT_FALSE(mistakes_after([](Command& c) { c.usages.clear(); }).empty());
  EXPECT_FALSE(mistakes_after([](Command& c) { c.usages[0].example = "raytest a.ply x"; }).empty());
  EXPECT_FALSE(mistakes_after([](Command& c) { c.usages[0].example = "rayother a.ply 3"; }).empty());
  EXPECT_FALSE(mistakes_after([](Command& c) { c.usages.insert(c.usages.begin(), c.usages[0]); }).empty());
  EXPECT_FALSE(mistakes_after([](Command& c) { c.usages[0].words[0].name = "N"; }).empty());
  EXPECT_FALSE(mistakes_after([](Command& c) { c.options[0].name = "quiet"; }).empty());
  EXPECT_FALSE(mistakes_after([](Command& c) { c.options[0].letter = 'q'; }).empty());
  EXPECT_FALSE(mistakes_after([](Command& c) { c.options[0].fallback = "x"; }).empty());
  EXPECT_FALSE(mistakes_after([](Command& c) { c.options[0].usages = {"nowhere"}; }).empty());
}

}  // namespace
