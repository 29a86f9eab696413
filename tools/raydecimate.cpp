#include "cli/cli.h"
#include "cloud_to_cloud.h"

#include <raycloud/filter/decimate.h>

namespace {

using namespace ray::cli;

const Command kCommand{
    .name = "raydecimate",
    .summary = "thin a ray cloud",
    .description =
        R"(Keeps fewer rays, each of them exactly as it was, with all its columns. In the first form the rays
are those that come first in the file in each cube of a grid with the given width, so that what was
seen often and what was seen rarely become equally dense. The grid is fixed in space: cubes start at
multiples of the width. The end of an unbounded ray counts as any other.

In the second form every Nth ray stays, starting with the first.)",
    .usages = {{.name = "width",
                .words = {cloud(), length("WIDTH")},
                .help = "the first ray that ends in each cube of this width",
                .example = "raydecimate cloud.ply 4 cm"},
               {.name = "every",
                .words = {cloud(), count("N", "ray")},
                .help = "every Nth ray",
                .example = "raydecimate cloud.ply 10 rays"}},
    .options = {output_option("CLOUD_decimated.ply"), view_option()},
    .writes = "CLOUD_decimated.ply",
    .memory = "With a width, at most 18 bytes for each ray that is kept; less than 200 MB besides.",
    .see_also = {"rayinfo", "rayrender"}};

void run(const Match& match, Session& session) {
  const std::string& input = match.text("CLOUD");
  ray::tools::run_cloud_to_cloud(
      session, {.input = input, .output = main_output(match, input, "_decimated")},
      [&](ray::RaySource& source, ray::RaySink& sink) {
        return match.usage() == "width"
                   ? decimate_voxels(session.context(), source, sink, match.length("WIDTH"))
                   : decimate_every(session.context(), source, sink,
                                    static_cast<std::uint64_t>(match.integer("N")));
      });
}

}  // namespace

int main(int argc, char** argv) {
  return ray::cli::main(kCommand, run, argc, argv);
}
