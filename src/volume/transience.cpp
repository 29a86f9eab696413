#include "transience.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <span>

namespace ray {
namespace {

/// How many different ones set so many of 16 bits by chance (Whang and others 1990).
double looks_in(std::uint16_t bits) {
  const int count = std::popcount(bits);
  return count >= 16 ? 16.0 * std::log(16.0) : -16.0 * std::log1p(-count / 16.0);
}

/// One in ten is below.
double low_share(double hits, double others) {
  constexpr double kZ2 = 1.2816 * 1.2816;
  if (!(hits > 0.0)) return 0.0;
  const double n = hits + others;
  const double share = hits / n;
  return (share + kZ2 / (2.0 * n) - std::sqrt(kZ2 * (share * (1.0 - share) / n + kZ2 / (4.0 * n * n)))) /
         (1.0 + kZ2 / n);
}

struct Caution {
  double own_point;    ///< how much less than a hit its own point is
  double of_one_look;  ///< passes that count
  double fewest_looks;
};

struct Run {
  double passes = 0.0;
  double counted = 0.0;
};

Run run_of(const Evidence& evidence, std::size_t i, const Caution& caution) {
  const double passes = evidence.passes[i];
  if (evidence.passes[i] == 0) return {};
  const double looks = looks_in(evidence.looks[i]);
  return {passes, looks < caution.fewest_looks ? 0.0 : std::min(passes, caution.of_one_look * looks)};
}

Transience cautious_transience(const Evidence& evidence, const Caution& caution) {
  std::array<Run, Evidence::kRuns> runs;
  double passes = 0.0;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    runs[i] = run_of(evidence, i, caution);
    passes += runs[i].counted;
  }
  if (!(passes > 0.0)) return {};
  const auto pauses = std::span(runs).subspan(1, runs.size() - 2);
  std::sort(pauses.begin(), pauses.end(), [](const Run& a, const Run& b) {
    return a.counted != b.counted ? a.counted > b.counted : a.passes > b.passes;
  });
  double others = evidence.within;
  for (const Run& pause : pauses)
    others += pause.passes;
  // The more pauses are left out of the episodes, the higher the opacity; but each must be worth it.
  double before = 0.0, between = 0.0, after = 0.0;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t left_out = 0;; ++left_out) {
    const double opacity = low_share(evidence.hits - caution.own_point, others);
    before = std::max(before, opacity * std::min(least, runs.front().counted));
    after = std::max(after, opacity * std::min(least, runs.back().counted));
    if (left_out > 0) between = std::max(between, opacity * least);
    if (left_out == pauses.size() || !(pauses[left_out].counted > 0.0)) break;
    least = pauses[left_out].counted;
    others -= pauses[left_out].passes;
  }
  return {static_cast<float>(before), static_cast<float>(between), static_cast<float>(after)};
}

}  // namespace

float opacity_of(const Evidence& evidence) {
  const double hits = evidence.hits > 1 ? evidence.hits - 1.0 : evidence.hits;
  return hits > 0.0 ? static_cast<float>(hits / (hits + evidence.crossings)) : 0.0F;
}

float opacity_while_there(const Evidence& evidence) {
  const double hits = evidence.hits;
  return hits > 0.0 ? static_cast<float>(hits / (hits + evidence.within)) : 0.0F;
}

Transience paper_transience(const Evidence& evidence) {
  if (evidence.hits == 0) return {};
  const float opacity = static_cast<float>(evidence.hits) /
                        (static_cast<float>(evidence.hits) + static_cast<float>(evidence.crossings));
  return {static_cast<float>(evidence.passes.front()) * opacity, 0.0F,
          static_cast<float>(evidence.passes.back()) * opacity};
}

Transience transience_of(const Evidence& evidence) {
  return cautious_transience(evidence, {.own_point = 0.5, .of_one_look = 5.0, .fewest_looks = 2.0});
}

Transience hint_of(const Evidence& evidence) {
  return cautious_transience(evidence, {.own_point = 0.0, .of_one_look = 3.0, .fewest_looks = 1.0});
}

}  // namespace ray
