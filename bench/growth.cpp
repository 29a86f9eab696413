// How the cost of commands that look at what is near each ray grows with the cloud.
//   bench_growth BIN_FOLDER SCAN.ply WORK_FOLDER MOST_MILLIONS
// Prints a Markdown table: seconds for clouds of a million rays and four times as many, again and again, and
// the exponent from the first to the last. `cp` of the same bytes shows how the machine itself grows.

#include "table.h"

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

namespace {

/// Seconds: the median of three runs where they are short.
double seconds_of(const bench::Subject& subject, long millions) {
  return bench::time_alone(subject, millions <= 4 ? 3 : 1).seconds;
}

}  // namespace

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
  std::vector<double> copying;
  for (const long millions : sizes) {
    const std::string cloud = paths.file("growing.ply"), out = paths.file("out.ply");
    bench::run(paths.bin + "/tile_cloud " + paths.big + " " + std::to_string(millions) + "000000 " + cloud +
               " 120");
    copying.push_back(seconds_of({"cp " + cloud + " " + out, "rm -f " + out}, millions));
    for (std::size_t i = 0; i < commands.size(); ++i) {
      const std::string& words = commands[i];
      const std::size_t name = std::min(words.find(' '), words.size());
      const std::string call = words.substr(0, name) + " -q " + cloud + words.substr(name) + " -o " + out;
      seconds[i].push_back(seconds_of({paths.command(call), ""}, millions));
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
  const auto print = [&](const std::string& name, const std::vector<double>& times, bool has_bar) {
    std::printf("| %s |", name.c_str());
    for (const double time : times)
      std::printf(" %.2f s |", time);
    const double exponent = std::log(times.back() / times.front()) /
                            std::log(static_cast<double>(sizes.back()) / static_cast<double>(sizes.front()));
    const char* const verdict = exponent <= 1.1 ? "≤ n^1.1 | met" : "≤ n^1.1 | MISSED";
    std::printf(" n^%.2f | %s |\n", exponent, has_bar ? verdict : " | ");
  };
  print("cp of the cloud", copying, false);
  for (std::size_t i = 0; i < commands.size(); ++i)
    print(commands[i], seconds[i], true);
  return 0;
}
