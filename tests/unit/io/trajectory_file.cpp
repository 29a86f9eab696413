#include "support/scratch.h"

#include <raycloud/core/error.h>
#include <raycloud/io/trajectory_file.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <fstream>

namespace ray {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;

std::string trajectory_error(const std::string& text, const TrajectoryReadOptions& options = {}) {
  try {
    static_cast<void>(parse_trajectory(text, "t.txt", options));
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

TEST(trajectory_file, the_same_path_in_every_spelling) {
  const std::vector<std::string> spellings{
      "%time x y z\n10 1 2 3\n11 4 5 6\n",
      "10,1,2,3\r\n11,4,5,6\r\n",
      "# comment\n\ntime;x;y;z\n10;1;2;3\n11;4;5;6",
      "x,y,z,t\n1,2,3,10\n4,5,6,11\n",
      "3 2 1 10\n1 5 6 11\n",
      "#timestamp [ns],p_RS_R_x [m],p_RS_R_y [m],p_RS_R_z [m]\n10000000000,1,2,3\n11000000000,4,5,6\n",
  };
  for (const std::string& text : spellings) {
    const TrajectoryFile file = parse_trajectory(text, "t.txt");
    EXPECT_EQ(file.trajectory.times, (std::vector<double>{10.0, 11.0})) << text;
    ASSERT_TRUE(file.trajectory.orientations.empty()) << text;
    const Eigen::Vector3d second = text[0] == '3' ? Eigen::Vector3d(1, 5, 6) : Eigen::Vector3d(4, 5, 6);
    EXPECT_EQ(file.trajectory.positions[1], second) << text;
    EXPECT_THAT(file.notes, Contains(HasSubstr("columns are "))) << text;
  }
}

TEST(trajectory_file, quaternions_in_either_order) {
  // Yaw of 0.2 and 0.4 rad.
  const std::string w_first = "0 1 2 3 0.99500417 0 0 0.09983342\n1 1 2 3 0.98006658 0 0 0.19866933\n";
  const std::string w_last = "0 1 2 3 0 0 0.09983342 0.99500417\n1 1 2 3 0 0 0.19866933 0.98006658\n";
  const std::string named =
      "t,x,y,z,qx,qy,qz,qw\n0,1,2,3,0,0,0.09983342,0.99500417\n1,1,2,3,0,0,0.19866933,0.98006658\n";
  const auto yaw = Eigen::Quaterniond(Eigen::AngleAxisd(0.4, Eigen::Vector3d::UnitZ()));
  for (const auto& file : {parse_trajectory(w_first, "a.txt"), parse_trajectory(w_last, "a.txt"),
                           parse_trajectory(w_last, "a.tum"), parse_trajectory(named, "a.csv"),
                           parse_trajectory(w_last, "a.txt", {.format = "t,x,y,z,qx,qy,qz,qw"})}) {
    ASSERT_EQ(file.trajectory.orientations.size(), 2u);
    EXPECT_LT(file.trajectory.orientations[1].angularDistance(yaw), 1e-6);
  }
  EXPECT_TRUE(parse_trajectory("0 1 2 3 0.1 0.2 0.3 0.4\n1 1 2 3 4 5 6 7\n", "a.txt")
                  .trajectory.orientations.empty());
}

TEST(trajectory_file, a_given_format_and_clock_are_obeyed) {
  const auto path = parse_trajectory("1 10 2 3 500\n", "t.txt",
                                     {.format = "-,x,y,z,t", .time_scale = 0.001, .time_offset = 2.0})
                        .trajectory;
  EXPECT_EQ(path.times[0], 2.5);
  EXPECT_EQ(path.positions[0], Eigen::Vector3d(10, 2, 3));
  EXPECT_THAT(trajectory_error("1 2 3 4\n", {.format = "x,y"}), HasSubstr("is not like t,x,y,z"));
  EXPECT_THAT(trajectory_error("1 2 3 4\n", {.format = "t,x,y,z,qw,qx,qy,qz"}), HasSubstr("has 4 columns"));
}

TEST(trajectory_file, what_can_be_put_right_is_put_right_and_told) {
  const TrajectoryFile file = parse_trajectory(
      "%time x y z\n3 30 0 0\n1 10 0 0\nnan 1 1 1\n2 20 0 0\n1 99 0 0\n4 inf 0 0\n", "t.txt");
  EXPECT_EQ(file.trajectory.times, (std::vector<double>{1, 2, 3}));
  EXPECT_EQ(file.trajectory.positions[0].x(), 10.0);
  EXPECT_THAT(file.notes, Contains(HasSubstr("2 nodes left out")));
  EXPECT_THAT(file.notes, Contains(HasSubstr("sorted")));
  EXPECT_THAT(file.notes, Contains(HasSubstr("1 node merged")));
  EXPECT_THAT(parse_trajectory("5 1 2 3\n", "t.txt").notes, Contains(HasSubstr("one node")));
}

TEST(trajectory_file, errors_name_the_line) {
  EXPECT_THAT(trajectory_error(""), HasSubstr("t.txt: has no trajectory nodes"));
  EXPECT_THAT(trajectory_error("%time x y z\n"), HasSubstr("no trajectory nodes"));
  EXPECT_THAT(trajectory_error("nan nan nan nan\n"), HasSubstr("no trajectory nodes"));
  EXPECT_THAT(trajectory_error("1 2 3\n"), HasSubstr("line 1 has 3 numbers"));
  EXPECT_THAT(trajectory_error("%time x y z\n1 2 3 4\n2 3 4\n"), HasSubstr("line 3 has 3 of 4"));
  EXPECT_THAT(trajectory_error("1 2 3 4\n2 3 4 x\n"), HasSubstr("line 2 has 'x'"));
  EXPECT_THAT(trajectory_error("\x89PNG\r\n\x1a\n"), HasSubstr("line 1 has"));
  const test::Scratch scratch;
  EXPECT_THROW(static_cast<void>(read_trajectory(scratch.path("none.txt"))), Error);
  EXPECT_THROW(static_cast<void>(read_trajectory(scratch.folder())), Error);
}

TEST(trajectory_file, only_known_extensions_are_written) {
  const test::Scratch scratch;
  EXPECT_THROW(write_trajectory(scratch.path("a.doc"), {{0.0}, {{0, 0, 0}}, {}}), Error);
  EXPECT_TRUE(std::filesystem::is_empty(scratch.folder()));
}

RC_GTEST_PROP(trajectory_file, every_written_form_reads_back_to_the_same_bits, ()) {
  Trajectory path;
  const bool turns = *rc::gen::arbitrary<bool>();
  double time = 1.6e9 + *rc::gen::inRange(0, 1000) / 7.0;
  for (auto left = *rc::gen::inRange(1, 30); left > 0; --left) {
    path.times.push_back(time);
    path.positions.emplace_back(500000 + *rc::gen::inRange(0, 99) / 3.0, *rc::gen::inRange(-99, 99) / 7.0,
                                0.1);
    if (turns)
      path.orientations.emplace_back(
          Eigen::AngleAxisd(*rc::gen::inRange(-300, 300) / 200.0, Eigen::Vector3d::UnitZ()));
    time += *rc::gen::inRange(1, 100) / 300.0;
  }
  const test::Scratch scratch;
  for (const std::string name : {"p.txt", "p.csv", "p.tum", "p.ply"}) {
    write_trajectory(scratch.path(name), path);
    const Trajectory back = read_trajectory(scratch.path(name)).trajectory;
    RC_ASSERT(back.times == path.times);
    RC_ASSERT(back.positions == path.positions);
    if (name == "p.ply") continue;
    if (!turns) RC_ASSERT(back.orientations.empty() || name == "p.tum");
    for (std::size_t i = 0; i < path.orientations.size(); ++i)
      RC_ASSERT(back.orientations[i].angularDistance(path.orientations[i]) < 1e-7);
  }
}

TEST(trajectory_file, points_without_times_are_no_trajectory) {
  const test::Scratch scratch;
  std::ofstream(scratch.path("p.ply"))
      << "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\n"
         "property float z\nend_header\n1 2 3\n";
  EXPECT_THROW(static_cast<void>(read_trajectory(scratch.path("p.ply"))), Error);
}

}  // namespace
}  // namespace ray
