// The streaming commands against `cp` of the same bytes, and LAZ import against a LASzip loop.
//   bench_streaming BIN_FOLDER CLOUD.ply WORK_FOLDER RAYS
// Prints a Markdown table. Every ratio is the median of five pairs of runs taken in turn, files in the page
// cache.

#include "table.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <string>

namespace {

using namespace bench;

void make_inputs(const Paths& p) {
  run(p.command("rayexport -q " + p.big + " " + p.file("points.laz") + " " + p.file("trajectory.txt") +
                " --traj_delta 0.01"));
}

void against_cp(const Paths& p) {
  const std::string& big = p.big;
  const std::string out = p.file("out.ply");
  const Subject cp{"exec cp " + big + " " + p.file("copy.ply"), "rm -f " + p.file("copy.ply")};
  const auto every =
      time_against({p.command("raydecimate -q " + big + " 10 rays -o " + out), "rm -f " + out}, cp, kRuns);
  row("raydecimate 10 rays", every, p.rays, "cp", "≤ 1.6 × cp", every.ratio <= 1.6);

  const auto exported =
      time_against({p.command("rayexport -q " + big + " " + out + " -"), "rm -f " + out}, cp, kRuns);
  row("rayexport to PLY", exported, p.rays, "cp", "≤ 1.6 × cp", exported.ratio <= 1.6);

  const std::string moved = p.file("moved.ply");
  run("cp " + big + " " + moved);
  const Subject cp_sync{"cp " + big + " " + p.file("copy.ply") + " && sync " + p.file("copy.ply"),
                        "rm -f " + p.file("copy.ply") + "; sync"};
  const auto translated =
      time_against({p.command("raytranslate -q " + moved + " 0.5,0.25,0"), "sync"}, cp_sync, kRuns);
  row("raytranslate in place", translated, p.rays, "cp && sync", "≤ 1.6 × cp && sync",
      translated.ratio <= 1.6);
  run("rm -f " + moved + " " + out + " " + p.file("copy.ply"));
}

void rates(const Paths& p) {
  const std::string& big = p.big;
  const std::string out = p.file("out.ply");
  const auto info = time_against({p.command("rayinfo " + big), ""}, {"exec cat " + big, ""}, kRuns);
  row("rayinfo", info, p.rays, "cat", "≥ 30 M rays/s", p.rays / info.seconds >= 30e6);

  const auto decimate =
      time_alone({p.command("raydecimate -q " + big + " 10 cm -o " + out), "rm -f " + out}, kRuns);
  row("raydecimate 10 cm", decimate, p.rays, "", "≥ 8 M rays/s", p.rays / decimate.seconds >= 8e6);

  const auto render = time_alone(
      {p.command("rayrender -q " + big + " top ends -o " + p.file("out.png")), "rm -f " + p.file("out.png")},
      kRuns);
  row("rayrender top ends", render, p.rays, "", "≥ 15 M rays/s", p.rays / render.seconds >= 15e6);
  run("rm -f " + out + " " + p.file("out.png"));
}

void laz_import(const Paths& p) {
  const std::string laz = p.file("points.laz");
  const std::string out = p.file("imported.ply");
  const auto imported = time_against(
      {p.command("rayimport -q " + laz + " " + p.file("trajectory.txt") + " -o " + out + " 2>/dev/null"),
       "rm -f " + out},
      {"exec " + p.bin + "/laszip_loop " + laz, ""}, kRuns);
  row("rayimport LAZ", imported, p.rays, "LASzip loop", "≤ 1/1.6 of the loop", imported.ratio <= 1.0 / 1.6);
  run("rm -f " + out);
}

void start_up(const Paths& p) {
  double slowest = 0.0;
  std::string which;
  for (const char* name :
       {"rayimport", "rayexport", "rayinfo", "raytranslate", "rayrotate", "raydecimate", "rayrender"}) {
    const auto result = time_alone({p.command(std::string(name) + " --version"), ""}, 21);
    if (result.seconds > slowest) which = name;
    slowest = std::max(slowest, result.seconds);
  }
  std::printf("\nStarting the slowest command (%s): %.1f ms with its shell (bar 15 ms)\n", which.c_str(),
              slowest * 1e3);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 5) {
    std::fprintf(stderr, "usage: bench_streaming BIN_FOLDER CLOUD.ply WORK_FOLDER RAYS\n");
    return 2;
  }
  const Paths paths{argv[1], argv[2], argv[3], std::atof(argv[4])};
  make_inputs(paths);
  std::printf("%.0f rays, %d timed runs each, files in the page cache\n\n", paths.rays, kRuns);
  heading();
  rates(paths);
  against_cp(paths);
  laz_import(paths);
  start_up(paths);
  return 0;
}
