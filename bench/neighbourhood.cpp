// Commands that look at what is near each ray, on a cloud: speed, memory, and what going in blocks costs.
//   bench_neighbourhood BIN_FOLDER CLOUD.ply WORK_FOLDER RAYS
// Prints a Markdown table. Rays are counted as the cloud has them, unbounded ones too.

#include "table.h"

#include <cstdio>
#include <cstdlib>
#include <string>

namespace {

struct Bar {
  double rate;           ///< M rays/s
  double per_ray;        ///< bytes
  double besides = 0.0;  ///< MB that do not count, whatever the number of rays
};

/// Prints its row.
bench::Subject whole_cloud(const bench::Paths& paths, const std::string& words, const std::string& call,
                           const Bar& bar) {
  const bench::Subject whole{paths.command(call), ""};
  const bench::Result alone = bench::time_alone(whole, 3);
  char promise[64];
  std::snprintf(promise, sizeof promise, "≥ %.1f M rays/s, ≤ %.0f B/ray", bar.rate, bar.per_ray);
  const double rate = paths.rays / alone.seconds / 1e6;
  const double per_ray = (alone.peak_megabytes - bar.besides) * 1e6 / paths.rays;
  bench::row((words + " (" + std::to_string(static_cast<int>(per_ray)) + " B/ray)").c_str(), alone,
             paths.rays, "", promise, rate >= bar.rate && per_ray <= bar.per_ray);
  return whole;
}

void command(const bench::Paths& paths, const std::string& words, const Bar& bar) {
  const std::string name = words.substr(0, words.find(' '));
  const std::string rest = words.substr(words.find(' '));
  const std::string call = name + " -q " + paths.big + rest + " -o " + paths.file("out.ply");
  const bench::Subject whole = whole_cloud(paths, words, call, bar);
  // Twenty blocks without what is around them.
  const auto memory = static_cast<long>(bar.per_ray * paths.rays / 10e6);
  const bench::Subject blocks{paths.command(call + " --memory " + std::to_string(memory) + "MB"), ""};
  const bench::Result against = bench::time_against(blocks, whole, 3);
  bench::row((words + ", in blocks").c_str(), against, paths.rays, "in one", "≤ 1.4 ×", against.ratio <= 1.4);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 5) {
    std::fprintf(stderr, "usage: bench_neighbourhood BIN_FOLDER CLOUD.ply WORK_FOLDER RAYS\n");
    return 2;
  }
  const bench::Paths paths{argv[1], argv[2], argv[3], std::atof(argv[4])};
  std::printf("\n%s, %.0f rays\n\n", paths.big.substr(paths.big.rfind('/') + 1).c_str(), paths.rays);
  bench::heading();
  command(paths, "raydenoise 4 cm", {6.0, 40.0});
  command(paths, "raydenoise 3 sigmas", {1.0, 90.0});
  command(paths, "raysmooth ", {1.0, 90.0});
  command(paths, "raycolour normal", {1.0, 90.0});
  command(paths, "raycolour shape", {1.0, 90.0});
  whole_cloud(paths, "raytransients min 10 rays",
              "raytransients -q min " + paths.big + " 10 rays -o " + paths.file("out.ply"),
              {0.6, 130.0, 40.0});
  bench::run("rm -f " + paths.file("out.ply") + " " + paths.file("out_transient.ply"));
  return 0;
}
