#include "transience.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace ray {
namespace {

/// How many different ones set so many of 64 bits by chance (Whang and others 1990).
double looks_in(std::uint64_t bits) {
  const int count = std::popcount(bits);
  return count >= 64 ? 64.0 * std::log(64.0) : -64.0 * std::log1p(-count / 64.0);
}

double low_share(double hits, double others) {
  constexpr double kZ2 = 1.2816 * 1.2816;  // one in ten is below
  const double n = hits + others;
  if (!(hits > 0.0)) return 0.0;
  const double share = hits / n;
  return (share + kZ2 / (2.0 * n) - std::sqrt(kZ2 * (share * (1.0 - share) / n + kZ2 / (4.0 * n * n)))) /
         (1.0 + kZ2 / n);
}

double independent(std::uint16_t passes, std::uint64_t looks) {
  constexpr double kOfOneLook = 3.0;
  constexpr double kFewestLooks = 2.0;
  const double count = looks_in(looks);
  if (count < kFewestLooks) return 0.0;
  return std::min<double>(passes, kOfOneLook * count);
}

}  // namespace

float opacity_of(const Evidence& evidence) {
  const double hits = evidence.hits > 1 ? evidence.hits - 1.0 : evidence.hits;
  return hits > 0.0 ? static_cast<float>(hits / (hits + evidence.crossings)) : 0.0F;
}

Transience paper_transience(const Evidence& evidence) {
  if (evidence.hits == 0) return {};
  const float opacity = static_cast<float>(evidence.hits) /
                        (static_cast<float>(evidence.hits) + static_cast<float>(evidence.crossings));
  return {static_cast<float>(evidence.before) * opacity, static_cast<float>(evidence.after) * opacity};
}

Transience transience_of(const Evidence& evidence) {
  const double opacity = low_share(evidence.hits - 1.0, evidence.within);
  return {static_cast<float>(independent(evidence.before, evidence.looks_before) * opacity),
          static_cast<float>(independent(evidence.after, evidence.looks_after) * opacity)};
}

}  // namespace ray
