#pragma once
/// The word TRAJECTORY of a command line and the options that say how to read it.

#include "cli/cli.h"

#include <raycloud/core/trajectory.h>

#include <string>
#include <vector>

namespace ray::tools {

/// `--traj_format`, `--traj_time_scale` and `--traj_time_offset`, for the usage of that name.
[[nodiscard]] std::vector<cli::Option> trajectory_options(const std::string& usage);

/// Reads the file given as TRAJECTORY and notes what was decided about its columns.
[[nodiscard]] Trajectory read_trajectory_input(const cli::Match& match, cli::Session& session);

}  // namespace ray::tools
