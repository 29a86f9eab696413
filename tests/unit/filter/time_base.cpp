#include <raycloud/core/error.h>
#include <raycloud/filter/time_base.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace ray {
namespace {

using ::testing::HasSubstr;

std::string verdict(const TimeSpan& points, const TimeSpan& trajectory) {
  try {
    check_clocks(points, "scan.ply", trajectory, "path.txt", 0.1);
  } catch (const Error& error) {
    return error.what();
  }
  return "agree";
}

// 2020-01-01 00:00:00 UTC on each clock; 18 leap seconds by then.
constexpr double kUnix = 1577836800.0;
constexpr double kGps = kUnix - 315964800.0 + 18.0;
constexpr double kAdjusted = kGps - 1e9;
constexpr double kWeekSeconds = 3.0 * 86400.0 + 18.0;  // a Wednesday

TimeSpan minute(double begin) {
  return {begin, begin + 60.0};
}

TEST(time_base, overlap_allows_a_margin) {
  EXPECT_EQ(verdict({0, 1}, {0.5, 2}), "agree");
  EXPECT_EQ(verdict({0, 1}, {1.05, 2}), "agree");
  EXPECT_NE(verdict({0, 1}, {1.2, 2}), "agree");
}

TEST(time_base, units_are_recognised) {
  EXPECT_EQ(verdict({10e9, 20e9}, {9, 21}), "scan.ply: times look like nanoseconds: add --time_scale 1e-09");
  EXPECT_THAT(verdict({10e6, 20e6}, {9, 21}), HasSubstr("microseconds: add --time_scale 1e-06"));
  EXPECT_THAT(verdict({10e3, 20e3}, {9, 21}), HasSubstr("milliseconds: add --time_scale 0.001"));
  EXPECT_EQ(verdict({10, 20}, {9e9, 21e9}),
            "path.txt: times look like nanoseconds: add --traj_time_scale 1e-09");
}

TEST(time_base, each_clock_is_recognised_against_each_other) {
  EXPECT_THAT(verdict(minute(kAdjusted), minute(kGps)), HasSubstr("--time_offset 1000000000"));
  EXPECT_THAT(verdict(minute(kGps), minute(kAdjusted)), HasSubstr("--time_offset -1000000000"));
  EXPECT_THAT(verdict(minute(kGps), minute(kUnix)), HasSubstr("--time_offset 315964782"));
  EXPECT_THAT(verdict(minute(kUnix), minute(kGps)), HasSubstr("--time_offset -315964782"));
  EXPECT_THAT(verdict(minute(kAdjusted), minute(kUnix)), HasSubstr("--time_offset 1315964782"));
  EXPECT_THAT(verdict(minute(kWeekSeconds), minute(kUnix)), HasSubstr("GPS week seconds"));
  for (const double clock : {kUnix, kGps, kAdjusted}) {
    const auto fix = find_clock_fix(minute(kWeekSeconds), minute(clock), 0.1);
    ASSERT_TRUE(fix);
    EXPECT_EQ(kWeekSeconds + fix->offset, clock);
    const auto reverse = find_clock_fix(minute(clock), minute(kWeekSeconds), 0.1);
    ASSERT_TRUE(reverse && reverse->of_trajectory);
    EXPECT_EQ(kWeekSeconds + reverse->offset, clock);
  }
}

TEST(time_base, a_unit_that_leaves_no_recording_is_not_believed) {
  EXPECT_THAT(verdict({0, 3000}, minute(kUnix)), HasSubstr("no time in common"));
  EXPECT_THAT(verdict(minute(kUnix), {0, 3000}), HasSubstr("no time in common"));
}

TEST(time_base, leap_seconds_alone_are_recognised) {
  EXPECT_THAT(verdict({kUnix, kUnix + 5}, {kUnix + 15, kUnix + 24}), HasSubstr("leap seconds"));
}

TEST(time_base, where_nothing_fits_both_spans_are_told) {
  EXPECT_EQ(verdict({991.6, 991.9}, {5.0, 6.0}),
            "scan.ply: no time in common with path.txt: points 991.6 to 991.9 s, trajectory 5.0 to 6.0 s");
}

}  // namespace
}  // namespace ray
