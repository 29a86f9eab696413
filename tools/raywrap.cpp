#include "cli/cli.h"
#include "cloud_to_cloud.h"

#include <raycloud/core/error.h>
#include <raycloud/io/mesh_file.h>
#include <raycloud/io/ray_cloud_file.h>
#include <raycloud/mesh/full_wrap.h>
#include <raycloud/mesh/wrap.h>

#include <map>

namespace {

using namespace ray::cli;

const Command kCommand{
    .name = "raywrap",
    .summary = "wrap a ray cloud in a mesh",
    .description =
        R"(Wraps the end points of a cloud in a surface of triangles, as far as a probe of the given curvature gets
in between them: from below (`upwards`), which finds the ground under grass, trees and stones; from above
(`downwards`), which covers the canopy or what a drone might fly into; from all around (`inwards`), where a
curvature of 0 gives the convex hull and more clings ever more tightly; or from within (`outwards`), which
blows up a balloon in a room or a cave.

The curvature is that of the probe, in 1/m: 0.1 is a ball of 10 m radius at its tip. Upwards and downwards the
mesh is a disc with fronts upwards, and no end is on the wrong side of it. Inwards and outwards it is a sphere
around the middle of the ends, or of the sensor's path, and has no overhangs as seen from there. There are no
holes, and no edge is split. Unbounded rays end at nothing and are left out.

With --full a ball rolls over the ends in place of the quicker probe, which only comes straight from below or
above, or from the middle: it goes under overhangs and into hollows that are wider than it. Where two sides of
it would meet, around a pillar or behind a door, it stops, as the mesh stays a disc or a sphere.

`rayextract terrain` writes to the same name: give one of them another by --output to keep both.)",
    .usages = {{.words = {cloud(), choice("DIRECTION", {"upwards", "downwards", "inwards", "outwards"}),
                          number("CURVATURE", kNonNegative)},
                .help = "a mesh around the cloud from this side",
                .example = "raywrap cloud.ply upwards 0.1"}},
    .options = {output_option("CLOUD_mesh.ply"),
                {.name = "full", .help = "with overhangs: roll a ball of this curvature over the ends"},
                view_option()},
    .writes = "CLOUD_mesh.ply",
    .memory =
        "200 bytes for each end that the probe may touch: some percent of a cloud, and all of it for a large "
        "curvature. With --full, 50 bytes an end and 300 for each that the ball may touch.",
    .see_also = {"rayextract", "raysplit", "raytranslate"}};

ray::WrapDirection direction_of(const std::string& word) {
  static const std::map<std::string, ray::WrapDirection> kDirections{
      {"upwards", ray::WrapDirection::upwards},
      {"downwards", ray::WrapDirection::downwards},
      {"inwards", ray::WrapDirection::inwards},
      {"outwards", ray::WrapDirection::outwards}};
  return kDirections.at(word);
}

void run(const Match& match, Session& session) {
  const std::string& input = match.text("CLOUD");
  const auto output = main_output(match, input, "_mesh", ".ply");
  const auto source = ray::open_ray_cloud(input);
  const ray::WrapDirection direction = direction_of(match.text("DIRECTION"));
  const auto form = match.has("--full") ? ray::full_wrap : ray::wrap;
  const ray::Wrap wrap = ray::tools::naming(
      input, [&] { return form(session.context(), *source, direction, match.number("CURVATURE")); });
  ray::write_mesh(output, wrap.mesh);
  ray::tools::note_dropped(session, wrap.stream.dropped);
  const bool may_cut_off = !match.has("--full") && (direction == ray::WrapDirection::inwards ||
                                                    direction == ray::WrapDirection::outwards);
  session.note(std::to_string(wrap.mesh.vertices.size()) + " of " + std::to_string(wrap.bounded) +
               " ends are touched, " + (may_cut_off ? std::to_string(wrap.cut_off) + " cut off, " : "") +
               std::to_string(wrap.mesh.faces.size()) + " triangles");
  session.summary({.rays_in = wrap.stream.rays_in, .files = {output}});
}

}  // namespace

int main(int argc, char** argv) {
  return ray::cli::main(kCommand, run, argc, argv);
}
