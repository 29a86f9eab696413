// How much of each kind of noise denoising takes out, and how much else.

#include "kept_rows.h"
#include "room_scan.h"
#include "tables.h"

#include <array>
#include <cstdio>
#include <string>

namespace bench {

namespace {

/// Rays by RoomPart.
struct Removed {
  std::array<double, kNothing + 1> all{};
  std::array<double, kNothing + 1> gone{};
  void add(const Sampled& scan, const ray::Noise& noise) {
    const std::vector<std::uint8_t> kept = kept_rows(scan.rays, noise);
    for (std::size_t i = 0; i < kept.size(); ++i) {
      const auto part = static_cast<std::size_t>(scan.truth[i].part);
      all[part] += 1.0;
      if (kept[i] == 0) gone[part] += 1.0;
    }
  }
};

/// One cell, and the name of what is missed.
struct Cell {
  const char* name;
  double share;  ///< of what there was, NaN where there was none
  double bar;
  bool at_least;
  [[nodiscard]] bool missed() const { return at_least ? share < bar : share > bar; }
};

void denoising_row(const std::string& what, const Removed& removed) {
  const auto share = [&](int part) {
    const auto p = static_cast<std::size_t>(part);
    return removed.gone[p] / removed.all[p];
  };
  const double good = removed.all[kSolid] + removed.all[kWire];
  const double lost = removed.gone[kSolid] + removed.gone[kWire];
  const std::array cells{Cell{"uniform", share(kUniform), 0.9, true}, Cell{"mixed", share(kMixed), 0.8, true},
                         Cell{"dust", share(kDust), 0.8, true}, Cell{"loss", lost / good, 0.006, false},
                         Cell{"wires", share(kWire), 0.02, false}};
  std::printf("| %s |", what.c_str());
  std::string missed;
  for (const Cell& cell : cells) {
    if (cell.share == cell.share) {
      std::printf(" %.2f %% |", 100 * cell.share);
    } else {
      std::printf(" |");
    }
    if (cell.missed()) missed += std::string(" ") + cell.name;
  }
  std::printf(" %s |\n", missed.empty() ? "met" : ("MISSED:" + missed).c_str());
  std::fflush(stdout);
}

void print_counts() {
  Removed all;  // of which nothing is gone
  const Sampled scan = room_scan(1, {true, true, true});
  for (const Truth& truth : scan.truth)
    all.all[static_cast<std::size_t>(truth.part)] += 1.0;
  std::printf(
      "One scan, with all noise: %.0f on solids, %.0f on wires, %.0f uniform, %.0f mixed, %.0f dust.\n\n",
      all.all[kSolid], all.all[kWire], all.all[kUniform], all.all[kMixed], all.all[kDust]);
}

void print_head() {
  std::printf(
      "| noise in the scan, command | uniform, ≥ 90 %% | mixed, ≥ 80 %% | dust, ≥ 80 %% | "
      "good, ≤ 0.6 %% | of them wires, ≤ 2 %% | |\n|---|---|---|---|---|---|---|\n");
}

/// Other scans than those on which most of the rules were adjusted.
void print_other_scans() {
  struct Case {
    const char* name;
    RoomScanner scanner;
  };
  std::printf("\nThe same with all noise and 3 sigmas, from %d other scans, and by other scanners\n\n",
              kScans);
  print_head();
  for (const Case& one :
       {Case{"the same scanner", {}}, Case{"1.2 m aside", {.aside = 1.2}}, Case{"16 beams", {.beams = 16}},
        Case{"64 beams", {.beams = 64}}, Case{"noise 0.5 cm", {.noise = 0.005}},
        Case{"noise 2 cm", {.noise = 0.02}}, Case{"half as long", {.rays = 157'000}},
        Case{"twice as long", {.rays = 628'000}}}) {
    Removed removed;
    for (std::uint64_t seed = kScans + 1; seed <= 2 * kScans; ++seed)
      removed.add(room_scan(seed, {true, true, true}, one.scanner), ray::OutsideNeighbours{3.0});
    denoising_row(one.name, removed);
  }
}

}  // namespace

void print_denoising() {
  struct Case {
    const char* name;
    NoiseKinds kinds;
  };
  std::printf("\nDenoising: the share of each kind that is removed, from %d scans of a room\n\n", kScans);
  print_counts();
  print_head();
  for (const Case& one :
       {Case{"none", {}}, Case{"uniform", {.uniform = true}}, Case{"mixed", {.mixed = true}},
        Case{"dust", {.dust = true}}, Case{"all", {true, true, true}}}) {
    Removed by_sigmas;
    Removed by_range;
    for (std::uint64_t seed = 1; seed <= kScans; ++seed) {
      const Sampled scan = room_scan(seed, one.kinds);
      by_sigmas.add(scan, ray::OutsideNeighbours{3.0});
      by_range.add(scan, ray::OnRangeEdges{{0.04}});
    }
    denoising_row(std::string(one.name) + ", 3 sigmas", by_sigmas);
    denoising_row(std::string(one.name) + ", range 4 cm", by_range);
  }
  print_other_scans();
}

}  // namespace bench
