#include "table.h"

#include <cstdio>

namespace bench {

void row(const char* what, const Result& result, double rays, const char* baseline, const char* bar,
         bool met) {
  char ratio[64] = "";
  if (result.base_seconds > 0.0) {
    std::snprintf(ratio, sizeof ratio, "%.2f (%.2f to %.2f) × %s", result.ratio, result.ratio_min,
                  result.ratio_max, baseline);
  }
  std::printf("| %s | %.3f s | %.1f | %s | %.0f MB | %s | %s |\n", what, result.seconds,
              rays / result.seconds / 1e6, ratio, result.peak_megabytes, bar, met ? "yes" : "NO");
  std::fflush(stdout);
}

void heading() {
  std::printf(
      "| command | median | M rays/s | time against the baseline (min to max) | peak memory | bar | met |\n");
  std::printf("|---|---|---|---|---|---|---|\n");
}

}  // namespace bench
