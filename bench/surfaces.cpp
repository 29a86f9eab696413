// Surfaces: whole commands, speed and memory.
//   bench_surfaces BIN_FOLDER OPEN.ply OPEN_RAYS BUILDING.ply BUILDING_RAYS WORK_FOLDER
// Prints a Markdown table: the terrain of open ground, clouds split by meshes, open ground wrapped from below
// and above, and a building by a ball. Rays are counted as the clouds have them, unbounded ones too.

#include "table.h"

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <string>
#include <string_view>

namespace {

const std::string kGround = "ground.ply", kHull = "hull.ply";

std::string terrain_of(const bench::Paths& paths, const std::string& options) {
  return paths.command("rayextract -q terrain " + paths.big + options + " -o " + paths.file(kGround));
}

void terrain(const bench::Paths& paths) {
  constexpr double kLeastRate = 4e6, kMostRatio = 1.2;
  const bench::Subject alone{terrain_of(paths, ""), ""};
  const bench::Result result = bench::time_alone(alone, bench::kRuns);
  bench::row("rayextract terrain", result, paths.rays, "", "≥ 4 M rays/s",
             paths.rays / result.seconds >= kLeastRate);
  const bench::Result raster =
      bench::time_against({terrain_of(paths, " --raster 0.5"), ""}, alone, bench::kRuns);
  bench::row("rayextract terrain --raster 0.5", raster, paths.rays, "without", "< 1.2 ×",
             raster.ratio < kMostRatio);
  bench::row("rayextract terrain --raster 0.5 --canopy",
             bench::time_against({terrain_of(paths, " --raster 0.5 --canopy"), ""}, alone, bench::kRuns),
             paths.rays, "without", "", true);
}

/// As the header of a mesh file has it.
std::string faces_of(const std::string& file) {
  constexpr std::string_view kFaces = "element face ";
  std::ifstream stream(file);
  for (std::string line; std::getline(stream, line) && line != "end_header";)
    if (line.starts_with(kFaces)) return line.substr(kFaces.size());
  return "?";
}

void split(const bench::Paths& paths, const std::string& what, const std::string& mesh) {
  constexpr double kLeastRate = 2e6;
  const std::string call = "raysplit -q " + paths.big + " " + paths.file(mesh) + " distance 0.2";
  const bench::Result result = bench::time_alone({paths.command(call), ""}, bench::kRuns);
  bench::row(("raysplit by " + what + ", " + faces_of(paths.file(mesh)) + " triangles").c_str(), result,
             paths.rays, "", "≥ 2 M rays/s", paths.rays / result.seconds >= kLeastRate);
}

void sheet(const bench::Paths& paths, const std::string& words) {
  constexpr double kLeastRate = 3e6;
  const std::string call = "raywrap -q " + paths.big + " " + words + " -o " + paths.file("out.ply");
  const bench::Result result = bench::time_alone({paths.command(call), ""}, bench::kRuns);
  bench::row(("raywrap " + words).c_str(), result, paths.rays, "", "≥ 3 M rays/s",
             paths.rays / result.seconds >= kLeastRate);
}

void ball(const bench::Paths& paths, const std::string& words) {
  constexpr double kMostSeconds = 60.0, kMostMegabytes = 2000.0;
  const std::string call = "raywrap -q " + paths.big + " " + words + " --full -o " + paths.file("out.ply");
  const bench::Result result = bench::time_alone({paths.command(call), ""}, 3);
  bench::row(("raywrap " + words + " --full").c_str(), result, paths.rays, "", "< 60 s, < 2 GB",
             result.seconds < kMostSeconds && result.peak_megabytes < kMostMegabytes);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 7) {
    std::fprintf(
        stderr,
        "usage: bench_surfaces BIN_FOLDER OPEN.ply OPEN_RAYS BUILDING.ply BUILDING_RAYS WORK_FOLDER\n");
    return 2;
  }
  const bench::Paths open{argv[1], argv[2], argv[6], std::atof(argv[3])};
  const bench::Paths building{argv[1], argv[4], argv[6], std::atof(argv[5])};
  std::printf("\nSurfaces: open ground of %.0f rays, a building of %.0f\n\n", open.rays, building.rays);
  bench::heading();
  terrain(open);
  split(open, "its ground", kGround);
  bench::run(
      building.command("raywrap -q " + building.big + " inwards 0.4 --full -o " + building.file(kHull)));
  split(building, "its full wrap", kHull);
  for (const char* const words :
       {"upwards 0.01", "upwards 0.1", "upwards 1", "upwards 10", "upwards 1000", "downwards 1"})
    sheet(open, words);
  for (const char* const words : {"inwards 0.2", "inwards 1", "inwards 5", "inwards 1000", "outwards 5"})
    ball(building, words);
  bench::run("rm -f " + open.file("out.ply") + " " + open.file("*_inside.ply") + " " +
             open.file("*_outside.ply") + " " + open.file("ground*") + " " + open.file(kHull));
  return 0;
}
