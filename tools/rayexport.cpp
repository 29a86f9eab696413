#include "cli/cli.h"
#include "cloud_to_cloud.h"

#include <raycloud/core/error.h>
#include <raycloud/exec/stream.h>
#include <raycloud/filter/sensor_path.h>
#include <raycloud/io/point_file.h>
#include <raycloud/io/ray_cloud_file.h>
#include <raycloud/io/trajectory_file.h>

#include <cstdio>
#include <optional>

namespace {

using namespace ray::cli;

const Command kCommand{
    .name = "rayexport",
    .summary = "write the points and the trajectory of a ray cloud",
    .description =
        R"(Splits a ray cloud into what other programs read: its end points with all their columns, and the
path of the sensor. Either output may be `-` to leave it out. `rayimport` of the two files gives the
cloud back: end points and times exactly, to the resolution of the format, and starts to within the
sensor's deviation from a straight line between the trajectory's nodes.

LAS and LAZ are version 1.4, with offset and scale chosen from the bounds of the cloud; intensity 0
marks an unbounded ray.)",
    .usages = {{.words = {cloud(), output("POINTS", {".ply", ".las", ".laz", ".xyz", ".txt", ".csv"}),
                          output("TRAJECTORY", {".txt", ".ply", ".csv", ".tum"})},
                .help = "points and trajectory",
                .example = "rayexport cloud.ply points.laz trajectory.txt"}},
    .options = {{.name = "traj_delta",
                 .value = number("S", kPositive),
                 .help = "seconds between the nodes of the trajectory",
                 .fallback = "0.1"}},
    .writes = "the files named",
    .memory = "Less than 200 MB for any cloud, and 40 bytes for each node of the trajectory.",
    .see_also = {"rayimport"}};

void note_sampling_error(Session& session, ray::RaySource& source, const ray::Trajectory& trajectory) {
  if (trajectory.empty()) return;
  source.rewind();
  char text[96];
  std::snprintf(text, sizeof text,
                "ray starts are within %.3g m of the trajectory (--traj_delta sets its spacing)",
                sampling_error(session.context(), source, trajectory).value);
  session.note(text);
}

void run(const Match& match, Session& session) {
  const std::string& points = match.text("POINTS");
  const std::string& trajectory = match.text("TRAJECTORY");
  if (points == "-" && trajectory == "-") match.reject("TRAJECTORY", "at least one output must be a file");
  const auto source = ray::open_ray_cloud(match.text("CLOUD"));
  ray::CloudInfo info = source->info();
  info.history.push_back(session.history());

  std::unique_ptr<ray::RaySink> sink;
  if (points != "-") sink = ray::create_points(points, info);
  std::optional<ray::SensorPath> path;
  if (trajectory != "-") path.emplace(match.number("--traj_delta"));
  const ray::StreamCounts counts = ray::stream(
      session.context(), *source, sink.get(), [](ray::RayCloud&) { return ray::Nothing{}; },
      [&](ray::RayCloud& rays, ray::Nothing&) {
        if (path) path->add(rays);
      });

  std::vector<std::filesystem::path> files;
  if (path) {
    const ray::Trajectory nodes = path->trajectory();
    ray::write_trajectory(trajectory, nodes);
    files.emplace_back(trajectory);
    note_sampling_error(session, *source, nodes);
  }
  if (sink) {
    sink->finish();
    files.emplace(files.begin(), points);
  }
  ray::tools::note_dropped(session, counts.dropped);
  session.summary({.rays_in = counts.rays_in, .files = files});
}

}  // namespace

int main(int argc, char** argv) {
  return ray::cli::main(kCommand, run, argc, argv);
}
