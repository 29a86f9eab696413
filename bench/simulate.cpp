// Simulated scans, written to disk.
//   bench_simulate BIN_FOLDER WORK_FOLDER
// Prints a Markdown table: the time of each world at ten million rays, the building of the scene included,
// and the memory at a tenth and at all of the rays.

#include "table.h"

#include <cstdio>
#include <string>

namespace {

constexpr double kRays = 10e6;

void world(const bench::Paths& paths, const std::string& name, double bar) {
  const std::string output = paths.file("scan.ply");
  const auto subject = [&](double rays) {
    return bench::Subject{paths.command("raycreate -q " + name + " 1 --rays " +
                                        std::to_string(static_cast<long>(rays)) + " -o " + output),
                          "rm -f " + output};
  };
  const bench::Result few = bench::time_alone(subject(kRays / 10), 1);
  const bench::Result many = bench::time_alone(subject(kRays), bench::kRuns);
  const double rate = kRays / many.seconds / 1e6;
  const std::string promise =
      bar > 0.0 ? "≥ " + std::to_string(static_cast<int>(bar)) + " M rays/s, memory as for 1 M rays"
                : "memory as for 1 M rays";
  const bool same_memory = many.peak_megabytes < 1.1 * few.peak_megabytes + 10.0;
  bench::row(("raycreate " + name).c_str(), many, kRays, "", promise.c_str(), rate >= bar && same_memory);
  bench::run("rm -f " + output);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fprintf(stderr, "usage: bench_simulate BIN_FOLDER WORK_FOLDER\n");
    return 2;
  }
  const bench::Paths paths{argv[1], "", argv[2], kRays};
  std::printf("\n%.0f simulated rays\n\n", kRays);
  bench::heading();
  world(paths, "building", 3.0);
  for (const char* name : {"room", "forest", "terrain", "field"})
    world(paths, name, 0.0);
  return 0;
}
