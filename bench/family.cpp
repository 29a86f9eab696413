// The streaming family: whole commands against `cp` of the same file, rates, and a pipe against its commands.
//   bench_family BIN_FOLDER CLOUD.ply WORK_FOLDER RAYS
// Prints a Markdown table. Every ratio is the median of five pairs of runs taken in turn, files in the page
// cache.

#include "table.h"

#include <cstdio>
#include <cstdlib>
#include <string>

namespace {

using namespace bench;

void against_cp(const Paths& p, const char* what, const std::string& words, const std::string& written) {
  const std::string copy = p.file("copy.ply");
  const Subject cp{"exec cp " + p.big + " " + copy, "rm -f " + copy};
  const Result result = time_against({p.command(words), "rm -f " + written}, cp, kRuns);
  row(what, result, p.rays, "cp", "≤ 2 × cp", result.ratio <= 2.0);
  run("rm -f " + copy + " " + written);
}

void whole_commands(const Paths& p) {
  const std::string out = p.file("out.ply");
  const std::string both = out + " " + p.file("out_outside.ply");
  const auto split = [&](const std::string& form) {
    against_cp(p, ("raysplit " + form).c_str(), "raysplit -q " + p.big + " " + form + " -o " + out, both);
  };
  split("plane 5,3,1");
  split("range 10");
  split("time 50 %");
  split("alpha 0.2");
  against_cp(p, "raycolour time", "raycolour -q " + p.big + " time -o " + out, out);
  const std::string first = p.file("first.ply");
  const std::string second = p.file("second.ply");
  run(p.command("raysplit -q " + p.big + " time 50 % -o " + first));
  run("mv " + p.file("first_outside.ply") + " " + second);
  against_cp(p, "raycombine all", "raycombine -q all " + first + " " + second + " -o " + out, out);
  run("rm -f " + first + " " + second);
}

void rate(const Paths& p, const std::string& words, const std::string& written, double least_millions) {
  const Result result = time_alone({p.command(words + " -q -o " + written), "rm -f " + written}, kRuns);
  char bar[64];
  std::snprintf(bar, sizeof bar, "≥ %g M rays/s", least_millions);
  std::string what = words;
  for (auto at = what.find(p.work); at != std::string::npos; at = what.find(p.work))
    what.erase(at, p.work.size() + 1);
  row(what.c_str(), result, p.rays, "", bar, p.rays / result.seconds >= least_millions * 1e6);
  run("rm -f " + written);
}

void rates(const Paths& p) {
  const std::string out = p.file("out.ply");
  const std::string image = p.file("out.png");
  rate(p, "raydecimate " + p.big + " 10 cm", out, 8.0);
  rate(p, "raydecimate " + p.big + " 20 cm 64 points", out, 3.0);
  rate(p, "raydecimate " + p.big + " 20 cm/ray", out, 3.0);
  rate(p, "raydecimate " + p.big + " 3 cm/m", out, 3.0);
  const std::string thin = p.file("thin.ply");
  run(p.command("raydecimate -q " + p.big + " 10 cm -o " + thin));
  rate(p, "rayrestore " + thin + " 10 cm " + p.big, out, 4.0);
  run("rm -f " + thin);
  rate(p, "rayrender " + p.big + " top ends", image, 15.0);
  rate(p, "rayrender " + p.big + " top rays --resolution 2000", image, 3.0);
}

/// Cells of a width that makes about a thousand of them.
void grid(const Paths& p) {
  const std::string folder = p.file("cells");
  const std::string out = folder + "/cell.ply";
  const Result result = time_alone({p.command("raysplit -q " + p.big + " grid 15,15,15 -o " + out),
                                    "rm -rf " + folder + "; mkdir " + folder},
                                   2);
  run("ls " + folder + " | wc -l > " + p.file("cells.txt") + "; grep -ah 'element vertex' " + folder +
      "/*.ply | awk '{n += $3} END {print n}' >> " + p.file("cells.txt"));
  double cells = 0.0;
  double pieces = 0.0;
  if (std::FILE* file = std::fopen(p.file("cells.txt").c_str(), "r")) {
    if (std::fscanf(file, "%lf %lf", &cells, &pieces) != 2) pieces = 0.0;
    std::fclose(file);
  }
  char what[96];
  std::snprintf(what, sizeof what, "raysplit grid, %.0f cells, %.1f M pieces", cells, pieces / 1e6);
  row(what, result, pieces, "", "≥ 4 M pieces/s", pieces / result.seconds >= 4e6);
  run("rm -rf " + folder + " " + p.file("cells.txt"));
}

/// The same steps as one pipe and as commands with files between them.
void pipe(const Paths& p, const char* what, const std::string& steps, const std::string& commands,
          double least_gain) {
  const std::string out = p.file("out.ply");
  const Result result =
      time_against({p.command("raypipe -q " + p.big + " " + steps + " -o " + out), "rm -f " + out},
                   {commands, "rm -f " + p.file("step*.ply")}, kRuns);
  char bar[64];
  std::snprintf(bar, sizeof bar, "≤ 1/%g of them", least_gain);
  row(what, result, p.rays, "its commands", bar, result.ratio <= 1.0 / least_gain);
  run("cmp " + out + " " + p.file("step3.ply"));
  run("rm -f " + out + " " + p.file("step*.ply"));
}

void pipes(const Paths& p) {
  const auto command = [&](const std::string& words) { return p.bin + "/" + words; };
  const std::string one = p.file("step1.ply");
  const std::string two = p.file("step2.ply");
  const std::string three = p.file("step3.ply");
  pipe(p, "pipe split : colour : split", "split range 30 : colour time : split plane 5,3,1",
       command("raysplit -q " + p.big + " range 30 -o " + one) + " && " +
           command("raycolour -q " + one + " time -o " + two) + " && " +
           command("raysplit -q " + two + " plane 5,3,1 -o " + three),
       2.0);
  pipe(p, "pipe split : decimate : colour", "split range 30 : decimate 10 cm : colour time",
       command("raysplit -q " + p.big + " range 30 -o " + one) + " && " +
           command("raydecimate -q " + one + " 10 cm -o " + two) + " && " +
           command("raycolour -q " + two + " time -o " + three),
       1.3);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 5) {
    std::fprintf(stderr, "usage: bench_family BIN_FOLDER CLOUD.ply WORK_FOLDER RAYS\n");
    return 2;
  }
  const Paths paths{argv[1], argv[2], argv[3], std::atof(argv[4])};
  std::printf("\nThe streaming family, %.0f rays\n\n", paths.rays);
  heading();
  whole_commands(paths);
  rates(paths);
  grid(paths);
  pipes(paths);
  return 0;
}
