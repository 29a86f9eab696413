#pragma once
/// A command that streams one cloud into one or more others, apart from its files: it runs by itself between
/// two files, and in `raycloud pipe` between two other steps.

#include "cli/cli.h"

#include <raycloud/core/ray_stream.h>
#include <raycloud/exec/stream.h>

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace ray::tools {

/// Gives the sink for one output. `info` is the source's, changed by what the step changes of it (its
/// columns); the history is added for it. Called once for each output, before the first ray.
using SinkMaker = std::function<RaySink&(std::size_t output, const CloudInfo& info)>;

struct StepReport {
  StreamCounts counts;
  std::vector<std::uint64_t> rays_out;  ///< of each output
  std::vector<std::string> notes;       ///< lines for the user
};

struct StepOutput {
  std::string word;    ///< chooses it in a pipe, after the step's own words; empty for the only one
  std::string suffix;  ///< of its file: "_inside"; empty: the file takes the place of the cloud itself
};

/// Finishes no sink. Where a sink throws PrecisionLoss, it runs again with that sink in double precision.
using StepRun = StepReport (*)(const cli::Match&, const Context&, RaySource&, const SinkMaker&);

struct Step {
  const cli::Command& command;  ///< its first file is the cloud
  std::vector<StepOutput> outputs;
  StepRun run;
  /// Whether the cloud would stay what it is; absent: never.
  bool (*does_nothing)(const cli::Match&) = nullptr;
  /// Whether each ray is treated by itself, so that the step may be run on any piece of the cloud alone;
  /// absent: never.
  bool (*by_ray)(const cli::Match&) = nullptr;
  /// Whether starts, ends and times of the rays that go on stay what they are; absent: they do not.
  bool (*keeps_places)(const cli::Match&) = nullptr;
  bool tells_count = false;  ///< whether its sink is told the number of rays of the source (RaySink::amend)
};

/// Remembers which of the outputs of a step need double precision, from one run of the step to the next.
class OutputPrecision {
 public:
  explicit OutputPrecision(std::size_t outputs) : lost_(outputs) {}
  /// The info of output number `output`, widened if need be.
  [[nodiscard]] CloudInfo widened(std::size_t output, CloudInfo info) const;
  void lost(std::size_t output) { lost_[output] = true; }
  /// The sink, which from now on tells where it threw PrecisionLoss.
  [[nodiscard]] std::unique_ptr<RaySink> watch(std::size_t output, std::unique_ptr<RaySink> sink);

 private:
  std::vector<std::atomic<bool>> lost_;
};

/// The report of a step with one output.
[[nodiscard]] StepReport report_of(const StreamCounts& counts);

/// The step as a command between files.
void run_step(const Step& step, const cli::Match& match, cli::Session& session);

/// Its `main`.
template <const Step& kStep>
int step_main(int argc, char** argv) {
  return cli::main(
      kStep.command, [](const cli::Match& match, cli::Session& session) { run_step(kStep, match, session); },
      argc, argv);
}

}  // namespace ray::tools
