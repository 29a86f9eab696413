// How true results are, on scenes whose truth is known.
//   bench_accuracy
//   [normals|smoothing|denoising|transients|merging|axes|alignment|real_alignment|bends|terrain]
// Prints Markdown tables; the same numbers on every run, whatever the threads.

#include "tables.h"

#include <array>
#include <cstdio>
#include <string>

namespace {

struct Topic {
  const char* name;
  void (*print)();
};

void print_all_denoising() {
  bench::print_denoising();
  bench::print_calibration();
  bench::print_far_from_others();
}

void print_all_transients() {
  bench::print_opacity();
  bench::print_transients();
}

void print_all_terrain() {
  bench::print_terrain();
  bench::print_ground_samples();
}

constexpr std::array kTopics{
    Topic{"normals", bench::print_normals},     Topic{"smoothing", bench::print_smoothing},
    Topic{"denoising", print_all_denoising},    Topic{"transients", print_all_transients},
    Topic{"merging", bench::print_merging},     Topic{"axes", bench::print_axes},
    Topic{"alignment", bench::print_alignment}, Topic{"real_alignment", bench::print_real_alignment},
    Topic{"bends", bench::print_bends},         Topic{"terrain", print_all_terrain}};

}  // namespace

int main(int argc, char** argv) {
  const std::string only = argc > 1 ? argv[1] : "";
  bool is_known = only.empty();
  for (const Topic& topic : kTopics) {
    if (!only.empty() && only != topic.name) continue;
    is_known = true;
    topic.print();
  }
  if (is_known) return 0;
  std::fprintf(stderr, "usage: bench_accuracy [");
  for (const Topic& topic : kTopics)
    std::fprintf(stderr, "%s%s", &topic == kTopics.data() ? "" : "|", topic.name);
  std::fprintf(stderr, "]\n");
  return 2;
}
