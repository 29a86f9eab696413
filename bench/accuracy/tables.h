#pragma once
/// The tables of bench_accuracy: how true the library's results are where the truth is known. Each prints
/// itself on standard output, in Markdown, each row with its bar, where there is one, and whether it is met.

#include <string>

namespace bench {

void print_normals();
void print_smoothing();
void print_denoising();
void print_calibration();
void print_far_from_others();
void print_transients();
void print_opacity();
void print_merging();
void print_axes();
void print_alignment();
void print_real_alignment();
void print_bends();
void print_terrain();
void print_ground_samples();

/// The last cells of a row.
[[nodiscard]] inline std::string verdict(const std::string& bar, bool met) {
  return bar + " | " + (met ? "met" : "MISSED");
}

}  // namespace bench
