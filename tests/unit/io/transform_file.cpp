/// Transforms as files: what is written reads back to the last bit, and nothing else is taken for one.

#include "support/scratch.h"

#include <raycloud/core/error.h>
#include <raycloud/io/transform_file.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <numbers>

namespace ray {
namespace {

RC_GTEST_PROP(TransformFile, ReadsBackToTheLastBit, ()) {
  const auto number = [](double most) {
    return *rc::gen::map(rc::gen::inRange(-1'000'000, 1'000'001), [most](int i) { return i * 1e-6 * most; });
  };
  Pose pose = rotation_pose({number(1.7), number(1.7), number(1.7)});
  pose.translation = {number(1e7), number(5e6), number(1e3)};
  const test::Scratch scratch;
  write_transform(scratch.path("t.yaml"), pose, {{"overlap", "0.5"}});
  const Pose back = read_transform(scratch.path("t.yaml"));
  RC_ASSERT(back.rotation == pose.rotation);
  RC_ASSERT(back.translation == pose.translation);
}

RC_GTEST_PROP(TransformFile, BendsReadBackToTheLastBit, ()) {
  Bend bend;
  for (double& value : bend.shifts.reshaped())
    value = *rc::gen::inRange(-1'000'000, 1'000'001) * 1e-11;
  bend.centre = {*rc::gen::inRange(-1'000'000, 1'000'001) * 0.37, 5e6};
  const test::Scratch scratch;
  const Pose pose = translation_pose({1.0, 2.0, 3.0});
  write_transform(scratch.path("t.yaml"), pose, {{"covariance", "\n  - [1, 2]"}}, bend);
  const Bend back = read_bend(scratch.path("t.yaml"));
  RC_ASSERT(back.shifts == bend.shifts);
  RC_ASSERT(bend.is_none() || back.centre == bend.centre);
  RC_ASSERT(read_transform(scratch.path("t.yaml")).translation == pose.translation);
}

TEST(TransformFile, RefusesWhatIsNoBend) {
  EXPECT_TRUE(parse_bend("1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n", "t").is_none());
  EXPECT_TRUE(parse_bend("matrix: [1, 0, 0, 4, 0, 1, 0, 5, 0, 0, 1, 6, 0, 0, 0, 1]\n", "t").is_none());
  const char* const rows = "bend:\n  - [0, 0, 0]\n  - [1e-5, 0, 0]\n  - [0, 0, 0]\n";
  EXPECT_EQ(parse_bend(std::string("bend_centre: [1, 2]\n") + rows, "t").shifts(1, 0), 1e-5);
  for (const std::string& text : {std::string(rows), std::string("bend_centre: [1, 2]\n"),
                                  "bend_centre: [1, nan]\n" + std::string(rows),
                                  std::string("bend_centre: [1, 2]\nbend:\n  - [0, 0, 0]\n"),
                                  std::string("bend_centre: [1, 2]\nbend:\n  - [0, 0, x]\n")})
    EXPECT_THROW(static_cast<void>(parse_bend(text, "t")), Error) << text;
}

TEST(TransformFile, TakesSixteenNumbersAlone) {
  const Pose pose = parse_transform("# from elsewhere\n0 -1 0 1.5\n1 0 0 2\n0 0 1 3\n0 0 0 1\n", "t");
  EXPECT_EQ(pose.translation, Eigen::Vector3d(1.5, 2, 3));
  EXPECT_EQ(pose.rotation, rotation_pose({0, 0, std::numbers::pi / 2}).rotation);
}

TEST(TransformFile, TakesAListInOneLineAndNamesBefore) {
  const Pose pose =
      parse_transform("name: x\nmatrix: [1, 0, 0, 4, 0, 1, 0, 5, 0, 0, 1, 6, 0, 0, 0, 1]\n", "t");
  EXPECT_EQ(pose.translation, Eigen::Vector3d(4, 5, 6));
}

TEST(TransformFile, RefusesWhatIsNone) {
  const auto refused = [](const char* text) {
    try {
      static_cast<void>(parse_transform(text, "t.yaml"));
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::file_format);
      EXPECT_THAT(error.what(), testing::StartsWith("t.yaml: "));
      return true;
    }
    return false;
  };
  EXPECT_TRUE(refused(""));
  EXPECT_TRUE(refused("ply\nformat ascii 1.0\n"));
  EXPECT_TRUE(refused("rotation: [0, 0, 1]\n"));
  EXPECT_TRUE(refused("1 0 0 0\n0 1 0 0\n0 0 1 0\n"));
  EXPECT_TRUE(refused("2 0 0 0\n0 2 0 0\n0 0 2 0\n0 0 0 1\n"));
  EXPECT_TRUE(refused("-1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n"));
  EXPECT_TRUE(refused("1 0 0 nan\n0 1 0 0\n0 0 1 0\n0 0 0 1\n"));
  EXPECT_TRUE(refused("1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 1 1\n"));
  EXPECT_TRUE(refused("matrix:\n  - [1, 0, 0, x]\n"));
}

}  // namespace
}  // namespace ray
