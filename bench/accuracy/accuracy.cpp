// How true normals, smoothing and denoising are, on scenes whose truth is known.
//   bench_accuracy [normals|smoothing|denoising|transients|merging|alignment]
// Prints Markdown tables; the same numbers on every run, whatever the threads.

#include "tables.h"

#include <cstdio>
#include <string>

int main(int argc, char** argv) {
  const std::string only = argc > 1 ? argv[1] : "";
  if (argc > 2 || (argc == 2 && only != "normals" && only != "smoothing" && only != "denoising" &&
                   only != "transients" && only != "merging" && only != "alignment")) {
    std::fprintf(stderr,
                 "usage: bench_accuracy [normals|smoothing|denoising|transients|merging|alignment]\n");
    return 2;
  }
  if (only.empty() || only == "normals") bench::print_normals();
  if (only.empty() || only == "smoothing") bench::print_smoothing();
  if (only.empty() || only == "denoising") {
    bench::print_denoising();
    bench::print_calibration();
    bench::print_far_from_others();
  }
  if (only.empty() || only == "transients") {
    bench::print_opacity();
    bench::print_transients();
  }
  if (only.empty() || only == "merging") bench::print_merging();
  if (only.empty() || only == "alignment") bench::print_alignment();
  return 0;
}
