#include "cloud_conflicts.h"

#include "transience.h"
#include "transient_regions.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace ray {
namespace {

Sides sides_of(CloudMerge merge, bool own_is_earlier) {
  const Contradiction any, before{.between = false, .after = false}, after{.before = false, .between = false};
  switch (merge) {
    case CloudMerge::all:
      return {};
    case CloudMerge::min:
      return {any, {}};
    case CloudMerge::max:
      return {{}, any};
    case CloudMerge::oldest:
      return {before, after};
    case CloudMerge::newest:
      return {after, before};
    case CloudMerge::order:
      return own_is_earlier ? Sides{{}, any} : Sides{any, {}};
  }
  return {};
}

/// -1, 0 or 1: the passes came, on average, before, with or after the hits.
int order_in_time(const Encounters& own, const Encounters& other) {
  const double hit = static_cast<double>(own.hit_ticks) / own.hits;
  const double pass = static_cast<double>(other.pass_ticks) / other.passes;
  return pass < hit ? -1 : pass > hit ? 1 : 0;
}

std::uint16_t counter(double count) {
  constexpr double kMostCounted = 60000.0;
  return static_cast<std::uint16_t>(std::clamp(count, 0.0, kMostCounted));
}

/// As if the other cloud's passes were one run before or after the hits of its own.
Evidence evidence_between(const Encounters& own, const Encounters& other, bool needs_order) {
  constexpr double kOfEachHit = 2.0;
  Evidence evidence;
  if (own.hits == 0 || other.passes == 0) return evidence;
  const int order = order_in_time(own, other);
  if (needs_order && order == 0) return evidence;
  evidence.hits = counter(own.hits);
  evidence.crossings = counter(own.crossings);
  evidence.within = counter(own.passes);
  const double opacity = static_cast<double>(opacity_while_there(evidence));
  const std::size_t run = order < 0 ? 0 : Evidence::kRuns - 1;
  evidence.passes[run] = counter(std::floor(other.passes - kOfEachHit * other.hits / opacity));
  evidence.looks[run] = other.looks;
  return evidence;
}

float passes_of(const Evidence& evidence) {
  return static_cast<float>(std::max(evidence.passes.front(), evidence.passes.back()));
}

/// Those of a run that is longer than it may be by chance.
std::vector<PassConflict> pass_conflicts(std::span<const float> scores, std::span<const Evidence> evidence,
                                         bool paper) {
  constexpr float kLongestByChance = 3.0F;
  std::vector<PassConflict> conflicts;
  for (std::size_t i = 0; i < scores.size(); ++i) {
    if (!(scores[i] > 0.0F)) continue;
    const float opacity = opacity_while_there(evidence[i]);
    if (paper || passes_of(evidence[i]) * opacity > kLongestByChance)
      conflicts.push_back({static_cast<std::uint32_t>(i), scores[i], opacity});
  }
  return conflicts;
}

}  // namespace

CloudConflicts cloud_conflicts(const Context& context, const EllipsoidTree& tree, const SomeEllipsoids& some,
                               std::span<const Encounters> of_own, std::span<const Encounters> of_other,
                               const MergeRule& rule, std::size_t own, std::size_t other) {
  const bool needs_order = rule.merge == CloudMerge::oldest || rule.merge == CloudMerge::newest;
  std::vector<Evidence> evidence(tree.size());
  for (std::size_t i = 0; i < some.slots.size(); ++i) {
    const std::uint32_t slot = some.tree->slot(i);
    evidence[some.slots[i]] = evidence_between(of_own[slot], of_other[slot], needs_order);
  }
  const Sides sides = sides_of(rule.merge, own < other);
  CloudConflicts conflicts;
  if (sides.ends) conflicts.ends = transience_scores(context, tree, evidence, *sides.ends, rule.paper);
  if (sides.passes)
    conflicts.passes = pass_conflicts(transience_scores(context, tree, evidence, *sides.passes, rule.paper),
                                      evidence, rule.paper);
  return conflicts;
}

}  // namespace ray
