#include <raycloud/core/error.h>
#include <raycloud/filter/time_base.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <vector>

namespace ray {
namespace {

constexpr double kGpsEpoch = 315964800.0;  // Unix time of 1980-01-06
constexpr double kAdjusted = 1e9;          // LAS global encoding bit 0: GPS seconds − 1e9
constexpr double kWeek = 604800.0;

struct LeapSecond {
  double unix_time;
  double gps_minus_utc;  // from then on
};

// International Earth Rotation Service, Bulletin C.
constexpr std::array kLeapSeconds{LeapSecond{1136073600.0, 14.0}, LeapSecond{1230768000.0, 15.0},
                                  LeapSecond{1341100800.0, 16.0}, LeapSecond{1435708800.0, 17.0},
                                  LeapSecond{1483228800.0, 18.0}};

double leap_seconds(double unix_time) {
  double leap = 13.0;
  for (const LeapSecond& step : kLeapSeconds)
    if (unix_time >= step.unix_time) leap = step.gps_minus_utc;
  return leap;
}

TimeSpan apply(const ClockFix& fix, const TimeSpan& span) {
  return {span.first * fix.scale + fix.offset, span.last * fix.scale + fix.offset};
}

// Unix − GPS seconds, of a date near `unix_time`.
double unix_minus_gps(double unix_time) {
  return kGpsEpoch - leap_seconds(unix_time);
}

// What would bring `times` to each absolute clock, `target` telling the date.
std::vector<ClockFix> absolute_fixes(const TimeSpan& times, const TimeSpan& target) {
  std::vector<ClockFix> fixes;
  const auto add = [&](double offset, const char* meaning) {
    fixes.push_back({.scale = 1.0, .offset = offset, .meaning = meaning});
  };
  add(kAdjusted, "GPS seconds minus 1e9, the other file's like GPS seconds");
  add(-kAdjusted, "GPS seconds, the other file's like GPS seconds minus 1e9");
  add(unix_minus_gps(target.first), "GPS seconds, the other file's like Unix time");
  add(-unix_minus_gps(times.first), "Unix time, the other file's like GPS seconds");
  add(kAdjusted + unix_minus_gps(target.first), "GPS seconds minus 1e9, the other file's like Unix time");
  add(-kAdjusted - unix_minus_gps(times.first), "Unix time, the other file's like GPS seconds minus 1e9");
  add(leap_seconds(times.first), "UTC, the other file's like GPS time (leap seconds)");
  add(-leap_seconds(times.first), "GPS time, the other file's like UTC (leap seconds)");
  return fixes;
}

// Seconds of the GPS week against a clock that counts on: the whole week of `target` is what is missing.
std::vector<ClockFix> week_fixes(const TimeSpan& times, const TimeSpan& target) {
  constexpr double kLatest = 4e9;  // s; no clock that counts on shows more this century
  if (times.first < 0.0 || times.last > 2.0 * kWeek || target.first <= kWeek || target.last > kLatest)
    return {};
  std::vector<ClockFix> fixes;
  const double to_unix = unix_minus_gps(target.first);
  const auto add = [&](double gps_minus_target, const char* meaning) {
    const double week = std::floor((target.first + gps_minus_target) / kWeek);
    for (const double w : {week, week - 1.0, week + 1.0})
      fixes.push_back({.scale = 1.0, .offset = w * kWeek - gps_minus_target, .meaning = meaning});
  };
  add(kAdjusted, "GPS week seconds, the other file's like GPS seconds minus 1e9");
  add(0.0, "GPS week seconds, the other file's like GPS seconds");
  add(-to_unix, "GPS week seconds, the other file's like Unix time");
  return fixes;
}

std::vector<ClockFix> unit_fixes() {
  return {{.scale = 1e-3, .meaning = "milliseconds"},
          {.scale = 1e-6, .meaning = "microseconds"},
          {.scale = 1e-9, .meaning = "nanoseconds"}};
}

// A unit is only believed if it leaves a recording of some length: else any clock fits any other.
bool is_long(const ClockFix& fix, const TimeSpan& span) {
  return span.first == span.last || (span.last - span.first) * fix.scale >= 0.01;
}

ClockFix on_trajectory(ClockFix fix) {
  fix.of_trajectory = true;
  return fix;
}

std::string shortest(double value) {
  char digits[32];
  return {digits, std::to_chars(digits, digits + sizeof digits, value).ptr};
}

std::string whole(double value) {
  char digits[400];
  return {digits, std::to_chars(digits, digits + sizeof digits, value, std::chars_format::fixed).ptr};
}

std::string span_text(const TimeSpan& span) {
  char digits[2][400];
  const auto text = [](char(&buffer)[400], double v) {
    return std::string(buffer, std::to_chars(buffer, buffer + 400, v, std::chars_format::fixed, 1).ptr);
  };
  return text(digits[0], span.first) + " to " + text(digits[1], span.last) + " s";
}

std::string options_of(const ClockFix& fix) {
  const std::string stem = fix.of_trajectory ? "--traj_time_" : "--time_";
  std::string text;
  if (fix.scale != 1.0) text += stem + "scale " + shortest(fix.scale);
  if (fix.offset != 0.0) text += (text.empty() ? "" : " ") + stem + "offset " + whole(fix.offset);
  return text;
}

}  // namespace

bool overlap(const TimeSpan& points, const TimeSpan& trajectory, double margin) {
  return points.first <= trajectory.last + margin && points.last >= trajectory.first - margin;
}

std::optional<ClockFix> find_clock_fix(const TimeSpan& points, const TimeSpan& trajectory, double margin) {
  for (const ClockFix& fix : unit_fixes()) {
    if (is_long(fix, points) && overlap(apply(fix, points), trajectory, margin)) return fix;
    if (is_long(fix, trajectory) && overlap(points, apply(fix, trajectory), margin * fix.scale))
      return on_trajectory(fix);
  }
  std::vector<ClockFix> fixes = absolute_fixes(points, trajectory);
  for (const ClockFix& fix : week_fixes(points, trajectory))
    fixes.push_back(fix);
  for (const ClockFix& fix : fixes)
    if (overlap(apply(fix, points), trajectory, margin)) return fix;
  for (const ClockFix& fix : week_fixes(trajectory, points))
    if (overlap(points, apply(fix, trajectory), margin)) return on_trajectory(fix);
  return std::nullopt;
}

void check_clocks(const TimeSpan& points, const std::string& points_name, const TimeSpan& trajectory,
                  const std::string& trajectory_name, double margin) {
  if (overlap(points, trajectory, margin)) return;
  if (const auto fix = find_clock_fix(points, trajectory, margin))
    throw Error(ErrorCode::wrong_content, (fix->of_trajectory ? trajectory_name : points_name) +
                                              ": times look like " + fix->meaning + ": add " +
                                              options_of(*fix));
  throw Error(ErrorCode::wrong_content, points_name + ": no time in common with " + trajectory_name +
                                            ": points " + span_text(points) + ", trajectory " +
                                            span_text(trajectory));
}

}  // namespace ray
