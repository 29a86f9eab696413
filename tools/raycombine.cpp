#include "cli/cli.h"
#include "cloud_to_cloud.h"

#include <raycloud/core/error.h>
#include <raycloud/filter/combine.h>
#include <raycloud/io/ray_cloud_file.h>

#include <utility>

namespace {

using namespace ray::cli;

const Command kCommand{
    .name = "raycombine",
    .summary = "put ray clouds together",
    .description =
        R"(Writes one cloud with every ray of the clouds given, one cloud after the other, each ray as it was.
The clouds may have different columns: the result has the columns of all, and where a cloud lacks one it
is filled with 0, or NaN for real numbers. It is in double precision if one of the clouds is.

With `--join` the pieces of rays that `raysplit` cut become whole rays again: ends and all columns exactly,
starts to rounding. The column `clipped` goes away with the last piece.)",
    .usages = {{.name = "all",
                .words = {optional(literal("all")), clouds()},
                .help = "every ray of every cloud",
                .example = "raycombine cloud1.ply cloud2.ply -o both.ply"}},
    .options = {output_option("CLOUD1_combined.ply"),
                {.name = "join", .help = "make whole rays of the pieces that raysplit cut"},
                view_option()},
    .writes = "CLOUD1_combined.ply, after the name of the first cloud",
    .memory =
        "Less than 200 MB for any number of clouds of any size. `--join` takes 200 bytes for each piece "
        "besides.",
    .see_also = {"raysplit"}};

ray::CombinedSource open_all(const std::vector<std::string>& files) {
  std::vector<ray::CloudToCombine> clouds;
  for (const std::string& file : files)
    clouds.push_back({file, [file] { return ray::open_ray_cloud(file); }});
  return ray::CombinedSource(std::move(clouds));
}

std::string number_of(std::uint64_t count, const std::string& noun) {
  return std::to_string(count) + " " + noun + (count == 1 ? "" : "s");
}

void run(const Match& match, Session& session) {
  const std::vector<std::string>& files = match.files("CLOUDS");
  const std::filesystem::path output = main_output(match, files.front(), "_combined");
  ray::CombinedSource source = open_all(files);
  for (const std::string& warning : source.warnings())
    session.warn(warning);
  for (const std::string& note : source.notes())
    session.note(note);
  ray::CloudInfo info = source.info();
  info.history.push_back(session.history());

  std::shared_ptr<const ray::JoinPlan> plan;
  if (match.has("--join")) {
    plan = plan_join(session.context(), source);
    info.extras = join_columns(*plan, std::move(info.extras));
    source.rewind();
  }
  ray::JoinCounts counts;
  const auto write_once = [&] {
    const auto sink = ray::create_ray_cloud(output, info);
    if (plan) {
      counts = join_pieces(session.context(), source, *sink, *plan);
    } else {
      counts.stream = stream_each(session.context(), source, *sink, [](const ray::RayCloud&) {});
    }
    sink->finish();
  };
  try {
    write_once();
  } catch (const ray::PrecisionLoss&) {
    source.rewind();
    info.precision = ray::Precision::double_;
    write_once();
  }
  ray::tools::note_dropped(session, counts.stream.dropped);
  if (plan) {
    session.note(number_of(counts.joined, "ray") + " joined, " + number_of(counts.left, "piece") +
                 " without a neighbour left");
  }
  session.summary({.rays_in = counts.stream.rays_in, .rays_out = counts.stream.rays_out, .files = {output}});
}

}  // namespace

int main(int argc, char** argv) {
  return ray::cli::main(kCommand, run, argc, argv);
}
