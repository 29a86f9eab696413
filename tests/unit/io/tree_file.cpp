// Tree files: what was written is read, fields nobody knows included; what is damaged is refused by line.
#include "ply_fixture.h"
#include "support/scratch.h"

#include <raycloud/io/tree_file.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

namespace ray {
namespace {

using namespace test;
using ::testing::ElementsAre;
using ::testing::StartsWith;

Forest trees_of(const std::string& text) {
  Scratch scratch;
  write_file(scratch.path("trees.txt"), text);
  return read_trees(scratch.path("trees.txt"));
}

std::string message(const std::string& text) {
  Scratch scratch;
  const auto path = scratch.path("trees.txt");
  write_file(path, text);
  const auto error = error_of([&] { (void)read_trees(path); });
  if (!error) return "no error";
  EXPECT_EQ(error->code(), ErrorCode::file_format);
  const std::string what = error->what();
  EXPECT_THAT(what, StartsWith(path.string() + ": "));
  EXPECT_EQ(what.find('\n'), what.npos);
  return what.substr(path.string().size() + 2);
}

TEST(TreeFile, AsOtherProgramsWriteIt) {
  const Forest forest = trees_of(
      "# tree structure file:\r\n"
      "height,crown_radius, x,y,z,radius,parent_id,section_id\r\n"
      "12.5,3, 1,2,0,0.2,-1,0, 1,2,3,0.15,0,1, 1.5,2,5,1e-1,1,2, \r\n"
      "\n# in between\n"
      " 7,1, -1,-2,0.25,0.1,-1,0\n");
  EXPECT_THAT(forest.comments, ElementsAre("tree structure file:", "in between"));
  EXPECT_THAT(forest.tree_attributes, ElementsAre("height", "crown_radius"));
  EXPECT_THAT(forest.segment_attributes, ElementsAre("section_id"));
  ASSERT_EQ(forest.trees.size(), 2u);
  const Tree& tree = forest.trees[0];
  EXPECT_THAT(tree.attributes, ElementsAre(12.5, 3.0));
  ASSERT_EQ(tree.segments.size(), 3u);
  EXPECT_EQ(tree.segments[0].parent, TreeSegment::kNoParent);
  EXPECT_EQ(tree.segments[2].parent, 1u);
  EXPECT_EQ(tree.segments[2].position, Eigen::Vector3d(1.5, 2, 5));
  EXPECT_EQ(tree.segments[2].radius, 0.1);
  EXPECT_THAT(tree.segments[2].attributes, ElementsAre(2.0));
  EXPECT_EQ(forest.trees[1].segments.size(), 1u);
}

TEST(TreeFile, TrunksHaveNoParents) {
  const Forest forest = trees_of("x,y,z,radius\n1,2,3,0.5\n4,5,6,0.25\n");
  ASSERT_EQ(forest.trees.size(), 2u);
  EXPECT_EQ(forest.trees[1].segments.at(0).radius, 0.25);
  EXPECT_TRUE(forest.tree_attributes.empty());
  EXPECT_TRUE(trees_of("x,y,z,radius\n").trees.empty());
}

bool same(const Forest& a, const Forest& b) {
  const auto same_segment = [](const TreeSegment& s, const TreeSegment& t) {
    return s.position == t.position && s.radius == t.radius && s.parent == t.parent &&
           s.attributes == t.attributes;
  };
  const auto same_tree = [&](const Tree& s, const Tree& t) {
    return s.attributes == t.attributes && std::equal(s.segments.begin(), s.segments.end(),
                                                      t.segments.begin(), t.segments.end(), same_segment);
  };
  return a.comments == b.comments && a.tree_attributes == b.tree_attributes &&
         a.segment_attributes == b.segment_attributes &&
         std::equal(a.trees.begin(), a.trees.end(), b.trees.begin(), b.trees.end(), same_tree);
}

std::vector<double> arbitrary_numbers(std::size_t count) {
  return *rc::gen::container<std::vector<double>>(count, rc::gen::arbitrary<double>());
}

RC_GTEST_PROP(TreeFile, ReadsBackEveryBit, ()) {
  Forest forest;
  forest.comments = {"trees", "of #1, a test"};
  const auto own = *rc::gen::inRange<std::size_t>(0, 3);
  const auto more = *rc::gen::inRange<std::size_t>(0, 3);
  for (std::size_t i = 0; i < own; ++i)
    forest.tree_attributes.push_back("own" + std::to_string(i));
  for (std::size_t i = 0; i < more; ++i)
    forest.segment_attributes.push_back("more" + std::to_string(i));
  const auto trees = *rc::gen::inRange(0, 8);
  for (int t = 0; t < trees; ++t) {
    Tree tree;
    tree.attributes = arbitrary_numbers(own);
    const auto segments = *rc::gen::inRange<std::size_t>(1, 20);
    for (std::size_t s = 0; s < segments; ++s) {
      TreeSegment segment;
      const auto place = arbitrary_numbers(3);
      segment.position = {place[0], place[1], place[2]};
      segment.radius = std::abs(*rc::gen::arbitrary<double>());
      if (s > 0) segment.parent = *rc::gen::inRange<std::size_t>(0, s);
      segment.attributes = arbitrary_numbers(more);
      tree.segments.push_back(segment);
    }
    forest.trees.push_back(tree);
  }
  Scratch scratch;
  write_trees(scratch.path("a.txt"), forest);
  const Forest back = read_trees(scratch.path("a.txt"));
  RC_ASSERT(same(back, forest));
  write_trees(scratch.path("b.txt"), back);
  RC_ASSERT(read_file(scratch.path("a.txt")) == read_file(scratch.path("b.txt")));
}

TEST(TreeFile, DamageIsToldByLine) {
  const std::string heading = "height, x,y,z,radius,parent_id\n";
  EXPECT_EQ(message(""), "empty file");
  EXPECT_EQ(message("# only\n"), "has no heading such as x,y,z,radius");
  EXPECT_EQ(message("1,2,3,4\n"), "line 1 is not a heading such as x,y,z,radius,parent_id");
  EXPECT_EQ(message("x,y,z,radius,,b\n"), "line 1 has a field without a name");
  EXPECT_EQ(message(heading + "5, 1,2,3,0.5,-1, 1,2,4\n"),
            "line 2 has 9 fields, but a tree needs 1 and then 5 a segment: is it cut?");
  EXPECT_EQ(message(heading + "5\n"),
            "line 2 has 1 fields, but a tree needs 1 and then 5 a segment: is it cut?");
  EXPECT_EQ(message(heading + "5, 1,2,oak,0.5,-1\n"), "line 2 has 'oak' where a number should be");
  EXPECT_EQ(message(heading + "5, 1,,3,0.5,-1\n"), "line 2 has '' where a number should be");
  EXPECT_EQ(message(heading + "5, 1,2,nan,0.5,-1\n"), "line 2 has a position that is not finite (segment 1)");
  EXPECT_EQ(message(heading + "5, 1,2,3,-0.5,-1\n"),
            "line 2 has a radius that is negative or not finite (segment 1)");
  EXPECT_EQ(
      message(heading + "5, 1,2,3,0.5,0\n"),
      "line 2 has the parent_id 0, but the first segment has -1 and others one before their own (segment 1)");
  EXPECT_EQ(
      message(heading + "5, 1,2,3,0.5,-1, 1,2,4,0.5,1\n"),
      "line 2 has the parent_id 1, but the first segment has -1 and others one before their own (segment 2)");
  EXPECT_EQ(
      message(heading + "5, 1,2,3,0.5,-1, 1,2,4,0.5,0.5\n"),
      "line 2 has the parent_id 0.5, but the first segment has -1 and others one before their own (segment 2)");
  EXPECT_EQ(message("x,y,z,radius\n1,2,3,4,5,6,7,8\n"),
            "line 2 has several segments, but the heading has no parent_id");
}

}  // namespace
}  // namespace ray
