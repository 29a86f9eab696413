#include "alignment_report.h"
#include "cli/cli.h"
#include "cloud_to_cloud.h"

#include <raycloud/align/axes.h>
#include <raycloud/align/clouds.h>
#include <raycloud/core/error.h>
#include <raycloud/filter/transform.h>
#include <raycloud/io/ray_cloud_file.h>
#include <raycloud/io/transform_file.h>

namespace {

using namespace ray::cli;

const Command kCommand{
    .name = "rayalign",
    .summary = "align a ray cloud to its own axes",
    .description =
        R"(Turns a cloud about the vertical so that its strongest orthogonal walls are along x and y, shifts the
corner of the outside walls to the origin, so that the building lies where x and y are positive, and
the ground to height zero: the lowest large level surface that is seen from above. The vertical is taken to
be right, as it is for scanners with an inertial unit, unless `--level` is given.

The matrix, the rotation vector and the translation are printed; the same transform, to the last bit, can be
written to a file and applied to any other cloud. Where the answer would not be certain, the command
says why, writes nothing and exits with 1.)",
    .usages = {{.name = "axes",
                .words = {cloud()},
                .help = "walls to the axes, their corner to the origin, ground to height zero",
                .example = "rayalign building.ply"},
               {.name = "reference",
                .words = {cloud(), cloud("REFERENCE")},
                .help = "onto another cloud, wherever it lies",
                .example = "rayalign tuesday.ply monday.ply"}},
    .options = {output_option("CLOUD_aligned.ply"),
                view_option(),
                {.name = "output_transform",
                 .value = output("FILE", {".yaml"}),
                 .help = "write the transform, as YAML"},
                {.name = "apply",
                 .value = input("FILE", {".yaml"}),
                 .help = "apply this transform instead of finding one"},
                {.name = "local", .help = "look only near where the clouds are", .usages = {"reference"}},
                {.name = "level",
                 .help = "take out roll and pitch too, up to 15 degrees",
                 .usages = {"axes"}}},
    .writes = "CLOUD_aligned.ply",
    .memory = "About 15 bytes a ray where there are many on each surface, 60 where they are sparse.",
    .see_also = {"raytranslate", "rayrotate", "raycombine", "raydiff"}};

struct Found {
  ray::Pose pose;
  std::string report;
  ray::TransformNotes notes;
};

Found axes_of(const Match& match, const Session& session) {
  const auto source = ray::open_ray_cloud(match.text("CLOUD"));
  const ray::AxesAlignment alignment =
      align_to_axes(session.context(), *source, {.level = match.has("--level")});
  return {alignment.pose, ray::tools::as_text(alignment), {}};
}

Found reference_of(const Match& match, const Session& session) {
  const auto source = ray::open_ray_cloud(match.text("CLOUD"));
  const auto reference = ray::open_ray_cloud(match.text("REFERENCE"));
  const ray::CloudAlignment alignment =
      align_clouds(session.context(), *source, *reference, {.local = match.has("--local")});
  if (!alignment.doubt.empty())
    throw ray::Error(ray::ErrorCode::no_data,
                     match.text("CLOUD") + ": not aligned, since " + alignment.doubt);
  return {alignment.pose, ray::tools::as_text(alignment), {}};
}

Found found_by(const Match& match, const Session& session) {
  if (match.has("--apply")) return {ray::read_transform(match.text("--apply")), {}, {}};
  return match.usage() == "axes" ? axes_of(match, session) : reference_of(match, session);
}

void run(const Match& match, Session& session) {
  if (match.has("--apply") && match.has("--level"))
    match.reject("--level", "with --apply nothing is looked for");
  const Found found = found_by(match, session);
  if (match.has("--output_transform"))
    write_transform(match.text("--output_transform"), found.pose, found.notes);
  session.print(ray::tools::as_text(found.pose) + found.report);
  ray::tools::run_cloud_to_cloud(
      session, {.input = match.text("CLOUD"), .output = main_output(match, match.text("CLOUD"), "_aligned")},
      [&](ray::RaySource& source, ray::RaySink& sink) {
        return transform_cloud(session.context(), source, sink, found.pose);
      });
}

}  // namespace

int main(int argc, char** argv) {
  return ray::cli::main(kCommand, run, argc, argv);
}
