#pragma once
/// What `raycloud pipe` is asked to do, and doing it.

#include "step.h"

#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace ray::tools {

/// One step of a pipe, with the words that belong to it.
struct PipeStep {
  const Step* step = nullptr;
  cli::Match match;
  std::size_t output = 0;  ///< which of its outputs goes on
};

/// `decimate 4 cm : split range 30 outside` in steps. Throws UsageError that shows the step in question.
[[nodiscard]] std::vector<PipeStep> parse_pipe(std::span<const std::string> words);

struct PipeReport {
  std::vector<StepReport> steps;
};

/// Runs all steps at once: those that must see the rays in order each on a thread of its own, the others as
/// part of reading or writing. The result has the bytes that the commands would have given one after the
/// other. Where a step must read its input twice, the steps before it write a file beside the output first,
/// which is gone at the end.
[[nodiscard]] PipeReport run_pipe(const Context& context, const std::filesystem::path& input,
                                  std::span<const PipeStep> steps, const std::filesystem::path& output);

}  // namespace ray::tools
