// How the cost of commands that look at what is near each ray grows with the cloud.
//   bench_growth BIN_FOLDER SCAN.ply WORK_FOLDER MOST_MILLIONS [COMMAND]
// Prints a Markdown table: seconds for clouds of a million rays and four times as many, again and again, by
// the clock and of both cores together, and the exponent from the first to the last. That is of the processor
// time, which other work on the machine changes less.

#include "table.h"

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

namespace {

struct Growing {
  std::string name;
  std::string words;  ///< CLOUD, and FIRST and SECOND, the halves of it by time, stand for files
  double most_exponent;
};

const std::vector<Growing> kCommands{
    {"raydenoise 4 cm", "raydenoise -q CLOUD 4 cm", 1.1},
    {"raydenoise 3 sigmas", "raydenoise -q CLOUD 3 sigmas", 1.1},
    {"raysmooth", "raysmooth -q CLOUD", 1.1},
    {"raycolour normal", "raycolour -q CLOUD normal", 1.1},
    {"raycolour shape", "raycolour -q CLOUD shape", 1.1},
    {"raytransients min 10 rays", "raytransients -q min CLOUD 10 rays", 1.15},
    {"raycombine min 10 rays, of two halves", "raycombine -q min FIRST SECOND 10 rays", 1.15}};

std::string with_file(std::string words, const std::string& name, const std::string& file) {
  const std::size_t at = words.find(name);
  return at == std::string::npos ? words : words.replace(at, name.size(), file);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 5 && argc != 6) {
    std::fprintf(stderr, "usage: bench_growth BIN_FOLDER SCAN.ply WORK_FOLDER MOST_MILLIONS [COMMAND]\n");
    return 2;
  }
  const bench::Paths paths{argv[1], argv[2], argv[3]};
  const long most = std::atol(argv[4]);
  std::vector<Growing> commands = kCommands;
  if (argc == 6) std::erase_if(commands, [&](const Growing& one) { return one.words.find(argv[5]) != 0; });
  std::vector<long> sizes;
  for (long millions = 1; millions <= most; millions *= 4)
    sizes.push_back(millions);
  std::vector<std::vector<bench::Run>> runs(commands.size());
  const std::string cloud = paths.file("growing.ply"), out = paths.file("growing_out.ply");
  const std::string first = paths.file("growing_inside.ply"), second = paths.file("growing_outside.ply");
  for (const long millions : sizes) {
    bench::run(paths.bin + "/tile_cloud " + paths.big + " " + std::to_string(millions) + "000000 " + cloud +
               " 120");
    bench::run(paths.command("raysplit -q " + cloud + " time 50 %"));
    for (std::size_t i = 0; i < commands.size(); ++i) {
      const std::string words = with_file(
          with_file(with_file(commands[i].words, "CLOUD", cloud), "FIRST", first), "SECOND", second);
      const std::string call = paths.command(words + " -o " + out);
      bench::run(call);
      runs[i].push_back(bench::run(call));
    }
    bench::run("rm -f " + paths.file("growing*.ply"));
  }
  std::printf("\n| command |");
  for (const long millions : sizes)
    std::printf(" %ld M |", millions);
  std::printf(" grows as | bar | |\n|---|");
  for (std::size_t i = 0; i < sizes.size(); ++i)
    std::printf("---|");
  std::printf("---|---|---|\n");
  for (std::size_t i = 0; i < commands.size(); ++i) {
    std::printf("| %s |", commands[i].name.c_str());
    for (const bench::Run& one : runs[i])
      std::printf(" %.2f s (%.2f s), %.0f MB |", one.seconds, one.processor_seconds, one.peak_megabytes);
    const double exponent = std::log(runs[i].back().processor_seconds / runs[i].front().processor_seconds) /
                            std::log(static_cast<double>(sizes.back()) / static_cast<double>(sizes.front()));
    const double bar = commands[i].most_exponent;
    std::printf(" n^%.2f | ≤ n^%.2f | %s |\n", exponent, bar, exponent <= bar ? "met" : "MISSED");
  }
  return 0;
}
