// How the cost of commands that look at what is near each ray grows with the cloud.
//   bench_growth BIN_FOLDER SCAN.ply WORK_FOLDER MOST_MILLIONS
// Prints a Markdown table: seconds for clouds of a million rays and four times as many, again and again, and
// the exponent from the first to the last.

#include "table.h"

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

int main(int argc, char** argv) {
  if (argc != 5) {
    std::fprintf(stderr, "usage: bench_growth BIN_FOLDER SCAN.ply WORK_FOLDER MOST_MILLIONS\n");
    return 2;
  }
  const bench::Paths paths{argv[1], argv[2], argv[3]};
  const long most = std::atol(argv[4]);
  const std::vector<std::string> commands{"raydenoise 4 cm", "raydenoise 3 sigmas", "raysmooth",
                                          "raycolour normal", "raycolour shape"};
  std::vector<long> sizes;
  for (long millions = 1; millions <= most; millions *= 4)
    sizes.push_back(millions);
  std::vector<std::vector<double>> seconds(commands.size());
  for (const long millions : sizes) {
    const std::string cloud = paths.file("growing.ply"), out = paths.file("out.ply");
    bench::run(paths.bin + "/tile_cloud " + paths.big + " " + std::to_string(millions) + "000000 " + cloud +
               " 120");
    for (std::size_t i = 0; i < commands.size(); ++i) {
      const std::string& words = commands[i];
      const std::size_t name = std::min(words.find(' '), words.size());
      const std::string call = words.substr(0, name) + " -q " + cloud + words.substr(name) + " -o " + out;
      seconds[i].push_back(bench::time_alone({paths.command(call), ""}, 1).seconds);
    }
    bench::run("rm -f " + cloud + " " + out);
  }
  std::printf("\n| command |");
  for (const long millions : sizes)
    std::printf(" %ld M |", millions);
  std::printf(" grows as | bar | |\n|---|");
  for (std::size_t i = 0; i < sizes.size(); ++i)
    std::printf("---|");
  std::printf("---|---|---|\n");
  for (std::size_t i = 0; i < commands.size(); ++i) {
    std::printf("| %s |", commands[i].c_str());
    for (const double time : seconds[i])
      std::printf(" %.2f s |", time);
    const double exponent = std::log(seconds[i].back() / seconds[i].front()) /
                            std::log(static_cast<double>(sizes.back()) / static_cast<double>(sizes.front()));
    std::printf(" n^%.2f | ≤ n^1.1 | %s |\n", exponent, exponent <= 1.1 ? "met" : "MISSED");
  }
  return 0;
}
