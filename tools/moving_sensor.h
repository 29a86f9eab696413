#pragma once
/// The word TRAJECTORY of a command line, the options that go with it, and the moving sensor they describe.

#include "cli/cli.h"

#include <raycloud/filter/sensor_origin.h>

#include <string>
#include <vector>

namespace ray::tools {

/// `--traj_offset`, `--clamp` and how to read the trajectory, for the usage of that name.
[[nodiscard]] std::vector<cli::Option> moving_sensor_options(const std::string& usage);

/// Reads the file given as TRAJECTORY and notes what was decided about its columns.
[[nodiscard]] MovingSensor read_moving_sensor(const cli::Match& match, cli::Session& session);

}  // namespace ray::tools
