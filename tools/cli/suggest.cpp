#include "cli/suggest.h"

#include <algorithm>
#include <vector>

namespace ray::cli {
namespace {

constexpr std::size_t kLongest = 64;

/// Optimal string alignment: the fewest letters changed, added, lost or swapped with their neighbour.
std::size_t slips(std::string_view a, std::string_view b) {
  std::vector<std::size_t> before(b.size() + 1), last(b.size() + 1), now(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j)
    last[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    now[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      now[j] = std::min({last[j] + 1, now[j - 1] + 1, last[j - 1] + (a[i - 1] == b[j - 1] ? 0u : 1u)});
      const bool swapped = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
      if (swapped) now[j] = std::min(now[j], before[j - 2] + 1);
    }
    std::swap(before, last);
    std::swap(last, now);
  }
  return last[b.size()];
}

}  // namespace

std::string nearest(std::string_view typed, std::span<const std::string> candidates) {
  if (typed.size() > kLongest) return {};
  std::string best;
  std::size_t fewest = kLongest;
  for (const std::string& candidate : candidates) {
    const std::size_t shorter = std::min(typed.size(), candidate.size());
    const std::size_t allowed = shorter < 3 ? 0 : (shorter + 1) / 3;
    const std::size_t found = slips(typed, candidate);
    if (found == 0 || found > allowed || found >= fewest) continue;
    best = candidate;
    fewest = found;
  }
  return best;
}

std::string did_you_mean(std::string_view typed, std::span<const std::string> candidates) {
  const std::string best = nearest(typed, candidates);
  return best.empty() ? "" : "; did you mean " + best + "?";
}

}  // namespace ray::cli
