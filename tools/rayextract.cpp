#include "cli/cli.h"
#include "cloud_to_cloud.h"

#include <raycloud/core/error.h>
#include <raycloud/io/mesh_file.h>
#include <raycloud/io/ray_cloud_file.h>
#include <raycloud/mesh/terrain.h>

#include <cstdio>

namespace {

using namespace ray::cli;

const Command kCommand{
    .name = "rayextract",
    .summary = "find the ground in a ray cloud",
    .description =
        R"(Finds the ground under what grows and stands on it and writes it as a mesh of triangles with fronts
upwards. The ground is nowhere steeper than the gradient: what is connected to it by steeper steps only is
taken off, be it a stone, a tree or a house. False returns below the ground, which have no others beside
them, do not pull it down, and noise does not lower it: it passes where most ends lie. Where no ground was
seen the mesh spans the gap.)",
    .usages = {{.words = {literal("terrain"), cloud()},
                .help = "the ground as a mesh",
                .example = "rayextract terrain cloud.ply"}},
    .options = {{.name = "gradient",
                 .value = number("G", kPositive),
                 .help = "the steepest that ground is: 1 is 45 degrees",
                 .fallback = "1"},
                {.name = "tolerance",
                 .value = length("WIDTH"),
                 .help = "the mesh may leave out what changes its height by less",
                 .fallback = "2cm",
                 .advanced = true},
                output_option("CLOUD_mesh.ply"),
                view_option()},
    .writes = "CLOUD_mesh.ply",
    .memory =
        "450 bytes for each cell of the map, which is about two spacings of the ends wide: less than 2 GB "
        "for any cloud.",
    .see_also = {"raywrap", "raytranslate", "raysplit"}};

void run(const Match& match, Session& session) {
  const std::string& input = match.text("CLOUD");
  const auto output = main_output(match, input, "_mesh", ".ply");
  const auto source = ray::open_ray_cloud(input);
  const ray::TerrainOptions options{.gradient = match.number("--gradient"),
                                    .tolerance = match.length("--tolerance").value};
  const ray::Terrain terrain =
      ray::tools::naming(input, [&] { return ray::extract_terrain(session.context(), *source, options); });
  ray::write_mesh(output, terrain.mesh);
  ray::tools::note_dropped(session, terrain.stream.dropped);
  char line[160];
  std::snprintf(line, sizeof line, "ground in %llu cells of %.3g m, %zu triangles",
                static_cast<unsigned long long>(terrain.heights), terrain.cell, terrain.mesh.faces.size());
  session.note(line);
  session.summary({.rays_in = terrain.stream.rays_in, .files = {output}});
}

}  // namespace

int main(int argc, char** argv) {
  return ray::cli::main(kCommand, run, argc, argv);
}
