// One cloud onto another: whole commands, speed and memory.
//   bench_alignment BIN_FOLDER WORK_FOLDER
// Prints a Markdown table: two scans of one building and of one wood, by scanners of 32 and of 64 beams among
// other people and vehicles, one of them turned by 77 degrees and moved by 36 m; rays of both are counted.

#include "table.h"

#include <cmath>
#include <cstdio>
#include <string>

namespace {

void scans(const bench::Paths& paths, const std::string& kind, int millions) {
  const std::string create = "raycreate -q " + kind + " 1 --rays " + std::to_string(millions) + "000000 -o ";
  const std::string cloud = paths.file("scan.ply"), reference = paths.file("reference.ply");
  bench::run(paths.command(create + cloud + " --moving 4"));
  bench::run(paths.command(create + reference + " --moving 5 --beams 64"));
  bench::run(paths.command("rayrotate -q " + cloud + " 0,0,77"));
  bench::run(paths.command("raytranslate -q " + cloud + " 30,-20,2"));
}

void onto(const bench::Paths& paths, const std::string& kind, int millions, double most_seconds, int runs) {
  constexpr double kMostBytes = 60.0;  // a ray
  scans(paths, kind, millions);
  const double rays = 2e6 * millions;
  const std::string words = paths.file("scan.ply") + " " + paths.file("reference.ply");
  const bench::Result result = bench::time_alone(
      {paths.command("rayalign -q " + words + " -o " + paths.file("aligned.ply")), ""}, runs);
  const std::string what = "rayalign, " + kind + ", two of " + std::to_string(millions) + " M rays";
  const std::string bar = "< " + std::to_string(std::lround(most_seconds)) + " s, ≤ 60 bytes a ray";
  bench::row(what.c_str(), result, rays, "", bar.c_str(),
             result.seconds < most_seconds && 1e6 * result.peak_megabytes <= kMostBytes * rays);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fprintf(stderr, "usage: bench_alignment BIN_FOLDER WORK_FOLDER\n");
    return 2;
  }
  const bench::Paths paths{argv[1], "", argv[2]};
  std::printf("\nOne cloud onto another, from file to file\n\n");
  bench::heading();
  for (const char* const kind : {"building", "forest"}) {
    onto(paths, kind, 2, 3.0, bench::kRuns);
    onto(paths, kind, 16, 10.0, 3);
  }
  for (const char* const name : {"scan.ply", "reference.ply", "aligned.ply"})
    bench::run("rm -f " + paths.file(name));
  return 0;
}
