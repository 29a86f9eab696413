#pragma once
/// Whole commands timed from outside: wall-clock seconds and peak memory as the operating system accounts
/// them.

#include <functional>
#include <string>
#include <vector>

namespace bench {

struct Run {
  double seconds = 0.0;
  double processor_seconds = 0.0;  ///< of all cores together, for itself and for the system
  double peak_megabytes = 0.0;     ///< largest resident size of the process, 10^6 bytes
};

/// Runs a shell command once, its output thrown away. Ends the program with a message if the command fails.
Run run(const std::string& command);

/// A command to time; `prepare` (a shell command, not timed) puts the files back before each run.
struct Subject {
  std::string command;
  std::string prepare;
};

struct Result {
  double seconds = 0.0;         ///< median
  double peak_megabytes = 0.0;  ///< maximum
  double base_seconds = 0.0;    ///< median of the baseline, 0 without one
  double ratio = 0.0;           ///< median of the paired ratios time / baseline time
  double ratio_min = 0.0;
  double ratio_max = 0.0;
};

/// One warm-up, then `runs` timed runs.
Result time_alone(const Subject& subject, int runs);

/// One warm-up of each, then `runs` pairs in turn, so that a drift of the machine's speed meets both.
Result time_against(const Subject& subject, const Subject& baseline, int runs);

}  // namespace bench
