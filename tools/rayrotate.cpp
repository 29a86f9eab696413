#include "cli/cli.h"
#include "move_in_place.h"

#include <numbers>

namespace {

using namespace ray::cli;

const Command kCommand{
    .name = "rayrotate",
    .summary = "rotate a ray cloud about the origin, in place",
    .description =
        R"(Turns starts and ends of all rays about the origin. The three numbers are a rotation vector: its
direction is the axis, its length the angle in degrees, counter-clockwise seen against the axis;
`0,0,90` turns the x axis onto the y axis. The file itself is changed: rotating by the opposite
vector undoes it. The new file replaces the old one only when it is complete and safely on the disk.

A file with coordinates in single precision becomes double where the new coordinates would lose more
than 5 micrometres.)",
    .usages = {{.words = {cloud(), vector("RX,RY,RZ")},
                .help = "by a rotation vector in degrees",
                .example = "rayrotate cloud.ply 0,0,90"}},
    .options = {view_option()},
    .writes = "CLOUD itself",
    .memory = "Less than 200 MB for any cloud.",
    .see_also = {"raytranslate"}};

void run(const Match& match, Session& session) {
  const Eigen::Vector3d rotation_rad = match.vector("RX,RY,RZ") * (std::numbers::pi / 180.0);
  ray::tools::move_in_place(session, match.text("CLOUD"),
                            {.pose = ray::rotation_pose(rotation_rad), .tolerance = ray::Metres{5e-6}});
}

}  // namespace

int main(int argc, char** argv) {
  return ray::cli::main(kCommand, run, argc, argv);
}
