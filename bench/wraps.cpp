// Wraps: whole commands, speed and memory.
//   bench_wraps BIN_FOLDER OPEN.ply OPEN_RAYS BUILDING.ply BUILDING_RAYS WORK_FOLDER
// Prints a Markdown table: open ground wrapped from below and above, and a building by a ball. Rays are
// counted as the clouds have them, unbounded ones too.

#include "table.h"

#include <cstdio>
#include <cstdlib>
#include <string>

namespace {

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
    std::fprintf(stderr,
                 "usage: bench_wraps BIN_FOLDER OPEN.ply OPEN_RAYS BUILDING.ply BUILDING_RAYS WORK_FOLDER\n");
    return 2;
  }
  const bench::Paths open{argv[1], argv[2], argv[6], std::atof(argv[3])};
  const bench::Paths building{argv[1], argv[4], argv[6], std::atof(argv[5])};
  std::printf("\nWraps: open ground of %.0f rays, a building of %.0f\n\n", open.rays, building.rays);
  bench::heading();
  for (const char* const words : {"upwards 0.01", "upwards 0.1", "upwards 1", "upwards 10", "downwards 1"})
    sheet(open, words);
  for (const char* const words : {"inwards 0.2", "inwards 1", "inwards 5", "inwards 1000", "outwards 5"})
    ball(building, words);
  bench::run("rm -f " + open.file("out.ply"));
  return 0;
}
