#pragma once
/// Do the clocks of two files agree, and if not, what would make them: checked before anything is written.

#include <limits>
#include <optional>
#include <string>

namespace ray {

/// The closed interval from `first` to `last`, in s; empty until something is added.
struct TimeSpan {
  double first = std::numeric_limits<double>::infinity();
  double last = -std::numeric_limits<double>::infinity();
  [[nodiscard]] bool empty() const { return !(first <= last); }
  void add(double time) {
    first = time < first ? time : first;
    last = time > last ? time : last;
  }
};

/// What brings one clock to the other: new time = time · scale + offset.
struct ClockFix {
  bool of_trajectory = false;  ///< the trajectory's times are to be changed, else the points'
  double scale = 1.0;
  double offset = 0.0;  ///< s
  std::string meaning;  ///< "nanoseconds", "GPS week seconds" …: what the wrong times look like
};

/// True if the spans share a time, `margin` seconds (one node spacing) of difference allowed.
[[nodiscard]] bool overlap(const TimeSpan& points, const TimeSpan& trajectory, double margin);

/// The first of the usual suspects under which the spans overlap: ms, µs or ns on either side; GPS seconds,
/// GPS − 1e9, GPS week seconds and Unix time for each other (with the leap seconds of the date, 2006 to
/// today). Empty if none does.
[[nodiscard]] std::optional<ClockFix> find_clock_fix(const TimeSpan& points, const TimeSpan& trajectory,
                                                     double margin);

/// Throws Error(wrong_content) if the spans do not overlap, in one line that names the fix and its option
/// ("scan.ply: times look like nanoseconds: add --time_scale 1e-9") or, where there is none, both spans.
void check_clocks(const TimeSpan& points, const std::string& points_name, const TimeSpan& trajectory,
                  const std::string& trajectory_name, double margin);

}  // namespace ray
