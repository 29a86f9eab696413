#include "cli/cli.h"
#include "move_in_place.h"

namespace {

using namespace ray::cli;

const Command kCommand{
    .name = "raytranslate",
    .summary = "move a ray cloud, in place",
    .description =
        R"(Adds an offset in metres to the starts and ends of all rays and, with a fourth number, seconds to
their times. The file itself is changed: moving by the opposite offset undoes it. The new file
replaces the old one only when it is complete and safely on the disk.

A file with coordinates in single precision becomes double where the new coordinates would lose more
than 25 micrometres.)",
    .usages = {{.words = {cloud(), vector("X,Y,Z[,T]")},
                .help = "by metres along each axis, and seconds",
                .example = "raytranslate cloud.ply 0,0,-1.5"}},
    .options = {view_option()},
    .writes = "CLOUD itself",
    .memory = "Less than 200 MB for any cloud.",
    .see_also = {"rayrotate"}};

void run(const Match& match, Session& session) {
  const std::vector<double>& components = match.components("X,Y,Z[,T]");
  const ray::Seconds shift{components.size() > 3 ? components[3] : 0.0};
  ray::tools::move_in_place(session, match.text("CLOUD"),
                            {.pose = ray::translation_pose(match.vector("X,Y,Z[,T]")),
                             .time_shift = shift,
                             .tolerance = ray::Metres{25e-6}});
}

}  // namespace

int main(int argc, char** argv) {
  return ray::cli::main(kCommand, run, argc, argv);
}
