#include "cli/cli.h"
#include "moving_sensor.h"

#include <raycloud/filter/import_rays.h>
#include <raycloud/io/point_file.h>
#include <raycloud/io/ray_cloud_file.h>

namespace {

using namespace ray::cli;

Command with_moving_sensor_options(Command command) {
  for (Option& option : ray::tools::moving_sensor_options("trajectory"))
    command.options.push_back(std::move(option));
  return command;
}

const Command kCommand = with_moving_sensor_options(
    {.name = "rayimport",
     .summary = "make a ray cloud from points and what is known of the sensor",
     .description =
         R"(Gives every point the line from the sensor to it. The sensor's position comes from a trajectory (by
the time of the point, linear between the trajectory's nodes, never beyond its ends), is one fixed
position, or lies at a fixed vector from each point, as a stand-in for aerial clouds without a
trajectory. Points that carry their sensor position need nothing else.

Points: .ply, .las, .laz, .xyz, .txt, .csv. Trajectories: text (`time x y z`, quaternions allowed),
.tum, .csv, .ply, .las; columns are found by content, and what was decided is printed. Intensity 0
means that nothing was hit within range. All other columns of the points are kept. At the end the
sensor positions are audited, and what looks wrong is told with the option that mends it.)",
     .usages = {{.name = "trajectory",
                 .words = {input("POINTS", {".ply", ".las", ".laz", ".xyz", ".txt", ".csv", ".asc", ".pts"}),
                           input("TRAJECTORY", {".txt", ".ply", ".csv", ".tum", ".las", ".laz"})},
                 .help = "a sensor that moved",
                 .example = "rayimport scan.laz trajectory.txt"},
                {.name = "fixed",
                 .words = {input("POINTS"), vector("X,Y,Z")},
                 .help = "a sensor that stood at one place",
                 .example = "rayimport scan.ply 0,0,1.8"},
                {.name = "constant",
                 .words = {input("POINTS"), literal("ray"), vector("X,Y,Z")},
                 .help = "one vector from the sensor to every point",
                 .example = "rayimport aerial.laz ray 0,0,-100"},
                {.name = "own",
                 .words = {input("POINTS")},
                 .help = "points that carry their sensor position",
                 .example = "rayimport rays.csv"}},
     .options = {output_option("POINTS.ply, or POINTS_raycloud.ply if that is the input"),
                 {.name = "max_intensity",
                  .value = number("N", kNonNegative),
                  .help = "intensity that becomes 255; 0: all rays hit something. Default: from the file"},
                 {.name = "time_offset",
                  .value = number("S", kAny),
                  .help = "seconds to add to the times of the points",
                  .fallback = "0"},
                 {.name = "time_scale",
                  .value = number("FACTOR", kPositive),
                  .help = "what to multiply the times of the points by, before the offset",
                  .fallback = "1"},
                 {.name = "remove_start_pos", .help = "move the cloud so that the sensor starts at 0,0,0"},
                 view_option()},
     .writes = "POINTS.ply, or POINTS_raycloud.ply if POINTS is a .ply",
     .memory = "Less than 200 MB for any number of points, and the trajectory.",
     .see_also = {"rayexport", "rayinfo"}});

ray::SensorOrigin sensor_origin(const Match& match, Session& session) {
  if (match.usage() == "trajectory") return ray::tools::read_moving_sensor(match, session);
  if (match.usage() == "fixed") return ray::FixedSensor{match.vector("X,Y,Z")};
  if (match.usage() == "constant") return ray::ConstantRay{match.vector("X,Y,Z")};
  return ray::OwnOrigins{};
}

std::filesystem::path ray_cloud_name(const Match& match, const std::string& points) {
  const bool from_ply = std::filesystem::path(points).extension() == ".ply";
  return main_output(match, points, from_ply ? "_raycloud" : "", ".ply");
}

void run(const Match& match, Session& session) {
  const std::string& points_name = match.text("POINTS");
  const auto output = ray_cloud_name(match, points_name);
  ray::ImportOptions options;
  options.origin = sensor_origin(match, session);
  options.time_scale = match.number("--time_scale");
  options.time_offset = match.number("--time_offset");
  if (match.has("--max_intensity")) options.max_intensity = match.number("--max_intensity");
  options.remove_start_position = match.has("--remove_start_pos");
  options.points_name = points_name;
  if (match.usage() == "trajectory") options.trajectory_name = match.text("TRAJECTORY");
  options.history = session.history();

  const auto points = ray::open_points(points_name);
  const ray::ImportReport report =
      import_rays(session.context(), *points, options,
                  [&](const ray::CloudInfo& info) { return ray::create_ray_cloud(output, info); });

  for (const std::string& note : report.notes)
    session.note(note);
  for (const std::string& finding : report.audit.findings)
    session.warn(finding);
  session.summary({.rays_in = report.rays_in, .rays_out = report.rays_out, .files = {output}});
}

}  // namespace

int main(int argc, char** argv) {
  return ray::cli::main(kCommand, run, argc, argv);
}
