#include "moving_sensor.h"

#include <raycloud/io/trajectory_file.h>

namespace ray::tools {

std::vector<cli::Option> moving_sensor_options(const std::string& usage) {
  return {{.name = "traj_offset",
           .value = cli::vector("X,Y,Z"),
           .help = "position of the lidar in the frame of the trajectory, in metres; needs orientations",
           .usages = {usage}},
          {.name = "clamp",
           .help = "keep points outside the trajectory's time span, at its first or last position",
           .advanced = true,
           .usages = {usage}},
          {.name = "traj_format",
           .value = cli::text("COLUMNS"),
           .help = "columns of the trajectory, as in t,x,y,z,qw,qx,qy,qz (- skips one)",
           .advanced = true,
           .usages = {usage}},
          {.name = "traj_time_scale",
           .value = cli::number("FACTOR", cli::kPositive),
           .help = "what to multiply the times of the trajectory by",
           .fallback = "1",
           .advanced = true,
           .usages = {usage}},
          {.name = "traj_time_offset",
           .value = cli::number("S", cli::kAny),
           .help = "seconds to add to the times of the trajectory",
           .fallback = "0",
           .advanced = true,
           .usages = {usage}}};
}

MovingSensor read_moving_sensor(const cli::Match& match, cli::Session& session) {
  TrajectoryReadOptions options;
  if (match.has("--traj_format")) options.format = match.text("--traj_format");
  options.time_scale = match.number("--traj_time_scale");
  options.time_offset = match.number("--traj_time_offset");
  const std::string& name = match.text("TRAJECTORY");
  TrajectoryFile file = read_trajectory(name, options);
  for (const std::string& note : file.notes)
    session.note(name + ": " + note);

  MovingSensor sensor{.trajectory = std::move(file.trajectory), .clamp = match.has("--clamp")};
  if (match.has("--traj_offset")) sensor.lever_arm = match.vector("--traj_offset");
  return sensor;
}

}  // namespace ray::tools
