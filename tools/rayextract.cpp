#include "cli/cli.h"
#include "cloud_to_cloud.h"

#include <raycloud/core/error.h>
#include <raycloud/io/mesh_file.h>
#include <raycloud/io/raster_file.h>
#include <raycloud/io/ray_cloud_file.h>
#include <raycloud/mesh/height_raster.h>
#include <raycloud/mesh/terrain.h>

#include <cstdio>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace {

using namespace ray::cli;

const Command kCommand{
    .name = "rayextract",
    .summary = "find the ground in a ray cloud",
    .description =
        R"(Finds the ground under what grows and stands on it and writes it as a mesh of triangles with fronts
upwards. What stands on it is taken off, be it a stone, a tree or a house: what is steeper than the gradient, and what
is narrower than 60 m with steps around it. False returns below the ground, which have no others beside
them or seem to have come through it, do not pull it down, and noise does not lower it: it passes where most ends lie. Where no ground was
seen the mesh spans the gap.

With --raster the heights are written as a GeoTIFF too, in the coordinate system of the cloud where that is
known: the ground (DTM), and with --canopy the highest ends (DSM) and what lies between them (CHM).)",
    .usages = {{.words = {literal("terrain"), cloud()},
                .help = "the ground as a mesh",
                .example = "rayextract terrain cloud.ply"}},
    .options =
        {{.name = "gradient",
          .value = number("G", kPositive),
          .help = "the steepest that ground is: 1 is 45 degrees",
          .fallback = "1"},
         {.name = "tolerance",
          .value = length("WIDTH"),
          .help = "the mesh may leave out what changes its height by less",
          .fallback = "2cm",
          .advanced = true},
         {.name = "raster",
          .value = number("METRES", kPositive),
          .help = "write CLOUD_dtm.tif too, heights of the ground in cells of this width"},
         {.name = "canopy",
          .help = "with --raster: CLOUD_dsm.tif and CLOUD_chm.tif, the highest ends and how high they stand"},
         output_option("CLOUD_mesh.ply"),
         view_option()},
    .writes = "CLOUD_mesh.ply, CLOUD_dtm.tif, CLOUD_dsm.tif and CLOUD_chm.tif",
    .memory =
        "100 bytes for each cell of the map, which is about two spacings of the ends wide, and 300 more for each that "
        "has ends: less than 2 GB for any cloud.",
    .see_also = {"raywrap", "raytranslate", "raysplit"}};

using NamedRaster = std::pair<std::filesystem::path, ray::Raster>;

/// What --raster and --canopy ask for.
std::vector<NamedRaster> rasters_of(const Match& match, const ray::Mesh& ground, ray::RaySource& source,
                                    const ray::Context& context) {
  std::vector<NamedRaster> rasters;
  if (!match.has("--raster")) return rasters;
  const std::string& named_after = match.text(match.has("--output") ? "--output" : "CLOUD");
  const auto add = [&](const char* suffix, ray::Raster raster) {
    rasters.emplace_back(output_name(named_after, suffix, ".tif"), std::move(raster));
  };
  add("_dtm", height_raster(ground, match.number("--raster"), ray::kMostRasterCells));
  if (!match.has("--canopy")) return rasters;
  source.rewind();
  add("_dsm", surface_raster(context, source, rasters.front().second));
  add("_chm", canopy_raster(rasters[1].second, rasters[0].second));
  return rasters;
}

void run(const Match& match, Session& session) {
  const std::string& input = match.text("CLOUD");
  const auto output = main_output(match, input, "_mesh", ".ply");
  if (match.has("--canopy") && !match.has("--raster"))
    match.reject("--canopy", "it is a raster too: give --raster its width");
  const auto source = ray::open_ray_cloud(input);
  const ray::TerrainOptions options{.gradient = match.number("--gradient"),
                                    .tolerance = match.length("--tolerance").value};
  const ray::Terrain terrain =
      ray::tools::naming(input, [&] { return ray::extract_terrain(session.context(), *source, options); });
  const auto rasters =
      ray::tools::naming(input, [&] { return rasters_of(match, terrain.mesh, *source, session.context()); });
  ray::write_mesh(output, terrain.mesh);
  std::vector<std::filesystem::path> files{output};
  for (const auto& [name, raster] : rasters) {
    ray::write_raster(name, raster, source->info().crs);
    files.push_back(name);
  }
  ray::tools::note_dropped(session, terrain.stream.dropped);
  char line[160];
  std::snprintf(line, sizeof line, "ground in %llu cells of %.3g m, %zu triangles",
                static_cast<unsigned long long>(terrain.heights), terrain.cell, terrain.mesh.faces.size());
  session.note(line);
  session.summary({.rays_in = terrain.stream.rays_in, .files = files});
}

}  // namespace

int main(int argc, char** argv) {
  return ray::cli::main(kCommand, run, argc, argv);
}
