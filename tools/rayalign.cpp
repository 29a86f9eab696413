#include "alignment_report.h"
#include "cli/cli.h"
#include "cloud_to_cloud.h"

#include <raycloud/align/axes.h>
#include <raycloud/align/clouds.h>
#include <raycloud/core/error.h>
#include <raycloud/filter/transform.h>
#include <raycloud/io/ray_cloud_file.h>
#include <raycloud/io/transform_file.h>

#include <system_error>

namespace {

using namespace ray::cli;
using ray::tools::Found;
using std::filesystem::path;

const Command kCommand{
    .name = "rayalign",
    .summary = "align a ray cloud to its own axes, or onto another",
    .description =
        R"(With one cloud: turns it about the vertical so that its strongest orthogonal walls are along x and y,
shifts the corner of the outside walls to the origin, so that the building lies where x and y are
positive, and the ground to height zero: the lowest large level surface that is seen from above. The
vertical is taken to be right, as it is for scanners with an inertial unit, unless `--level` is given.

With two clouds: moves the first one, rigidly, to where its surfaces lie on those of the second,
wherever it was and however it was turned about the vertical; with `--local`, nearby. Things may have
moved in between. Of many poses the one counts that agrees best with surfaces and with free space: what
one cloud has where the rays of the other went through counts against it.

With `--nonrigid` the cloud may be bent a little, too: a quadratic function of x and y for each
coordinate, as long maps need that have drifted. It is, only if that fits better than chance and nine
more numbers would. Each ray moves as a whole, its start with its end.

Where the answer is not certain (the clouds have too little in common, something speaks against every
pose, or another pose fits nearly as well) the command says so, writes nothing and exits with 1.

The matrix, the rotation vector and the translation are printed. The same transform, to the last bit,
can be written to a file and applied to any other cloud with `--apply`.)",
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
                 .help = "apply this transform instead of finding one",
                 .usages = {"axes"}},
                {.name = "level",
                 .help = "take out roll and pitch too, up to 15 degrees",
                 .usages = {"axes"}},
                {.name = "local", .help = "look only near where the cloud is", .usages = {"reference"}},
                {.name = "nonrigid",
                 .help = "bend the cloud, too, where it clearly fits better then",
                 .usages = {"reference"}}},
    .writes = "CLOUD_aligned.ply",
    .memory =
        "Some 10 to 60 bytes for each ray of both clouds, the less the denser they are, whatever --memory "
        "allows.",
    .see_also = {"raytranslate", "rayrotate", "raycombine", "raydiff"}};

Found axes_of(const Match& match, const Session& session) {
  const auto source = ray::open_ray_cloud(match.text("CLOUD"));
  return ray::tools::found(align_to_axes(session.context(), *source, {.level = match.has("--level")}));
}

Found onto_reference(const Match& match, const Session& session) {
  const auto source = ray::open_ray_cloud(match.text("CLOUD"));
  const auto reference = ray::open_ray_cloud(match.text("REFERENCE"));
  const ray::CloudAlignment alignment =
      align_clouds(session.context(), *source, *reference,
                   {.local = match.has("--local"), .nonrigid = match.has("--nonrigid")});
  if (!alignment.doubt.empty())
    throw ray::Error(ray::ErrorCode::no_data, match.text("CLOUD") + ": not aligned: " + alignment.doubt);
  return ray::tools::found(alignment, match.has("--nonrigid"));
}

Found found_by(const Match& match, const Session& session) {
  if (match.has("--apply"))
    return {ray::read_transform(match.text("--apply")), ray::read_bend(match.text("--apply")), {}, {}};
  return match.usage() == "axes" ? axes_of(match, session) : onto_reference(match, session);
}

/// The result never takes the place of the reference.
path output_of(const Match& match) {
  const path result = main_output(match, match.text("CLOUD"), "_aligned");
  if (match.usage() != "reference") return result;
  const path reference = match.text("REFERENCE");
  std::error_code error;
  if (std::filesystem::weakly_canonical(result) == std::filesystem::weakly_canonical(reference) ||
      std::filesystem::equivalent(result, reference, error))
    match.reject(match.has("--output") ? "--output" : "REFERENCE",
                 "the result would take the place of the reference: choose another name with --output");
  return result;
}

void run(const Match& match, Session& session) {
  if (match.has("--apply") && match.has("--level"))
    match.reject("--level", "with --apply nothing is looked for");
  const path output = output_of(match);
  const Found found = found_by(match, session);
  if (match.has("--output_transform"))
    write_transform(match.text("--output_transform"), found.pose, found.notes, found.bend);
  session.print(ray::tools::as_text(found));
  ray::tools::run_cloud_to_cloud(session, {.input = match.text("CLOUD"), .output = output},
                                 [&](ray::RaySource& source, ray::RaySink& sink) {
                                   return transform_cloud(session.context(), source, sink, found.pose,
                                                          found.bend);
                                 });
}

}  // namespace

int main(int argc, char** argv) {
  return ray::cli::main(kCommand, run, argc, argv);
}
