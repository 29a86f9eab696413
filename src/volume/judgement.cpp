#include "judgement.h"

#include "contradicting_rays.h"
#include "each_chunk.h"
#include "transience.h"

#include <raycloud/exec/fresh_memory.h>
#include <raycloud/exec/parallel.h>

#include <algorithm>

namespace ray {
namespace {

/// Whether a run is longer than it may be by chance. Runs that are not prove nothing, whatever others do.
bool contradicts(const Evidence& evidence, std::size_t run, bool paper) {
  constexpr float kLongestByChance = 3.0F;
  return paper || static_cast<float>(evidence.passes[run]) * opacity_while_there(evidence) > kLongestByChance;
}

void count_passes(const Context& context, RaySource& crossing, const EllipsoidTree& tree,
                  const JudgeRule& rule, std::span<Evidence> evidence) {
  each_chunk(context, crossing,
             [&](const RayCloud& rays) { add_passes(tree, rays, rule.counting, rule.times, evidence); });
}

}  // namespace

Sides sides_of(Merge merge) {
  switch (merge) {
    case Merge::min:
      return {Contradiction{}, {}};
    case Merge::max:
      return {{}, Contradiction{}};
    case Merge::oldest:
      return {Contradiction{.between = false, .after = false}, Contradiction{.before = false}};
    case Merge::newest:
      return {Contradiction{.before = false, .between = false}, Contradiction{.after = false}};
  }
  return {};
}

double look_ticks(const JudgeRule& rule) {
  constexpr double kLongest = 65536.0;
  return rule.transients.paper ? kLongest : rule.times.ticks(rule.counting.look_time);
}

std::vector<Evidence> count_evidence(const Context& context, RaySource& ending, RaySource& crossing,
                                     const EllipsoidTree& tree, const JudgeRule& rule) {
  std::vector<Evidence> evidence(tree.size());
  {
    HitTimes times(tree.size());
    each_chunk(context, ending, [&](const RayCloud& rays) { times.add(tree, rays, rule.times); });
    times.find_episodes(context, look_ticks(rule), evidence);
  }
  count_passes(context, crossing, tree, rule, evidence);
  return evidence;
}

std::vector<Evidence> count_evidence(const Context& context, std::vector<HitEpisodes>&& hits,
                                     RaySource& crossing, const EllipsoidTree& tree, const JudgeRule& rule) {
  auto evidence = touched_vector<Evidence>(context, hits.size());
  parallel_for(context, hits.size(), 1 << 14, [&](std::size_t begin, std::size_t end) {
    for (std::size_t slot = begin; slot < end; ++slot)
      static_cast<HitEpisodes&>(evidence[slot]) = hits[slot];
  });
  hits = std::vector<HitEpisodes>();
  count_passes(context, crossing, tree, rule, evidence);
  return evidence;
}

JudgedEnd judged_end(const Evidence& evidence, float score) {
  return {opacity_of(evidence), evidence.hits, evidence.crossings, score};
}

void spare_passes(std::span<const float> ends, std::span<float> passes) {
  if (passes.empty()) return;
  for (std::size_t i = 0; i < ends.size(); ++i)
    if (ends[i] >= passes[i]) passes[i] = 0.0F;
}

PassJudge::PassJudge(const EllipsoidTree& tree, std::span<const Evidence> evidence, std::vector<float> scores,
                     const JudgeRule& rule)
    : tree_(tree),
      evidence_(evidence),
      scores_(std::move(scores)),
      rule_(rule),
      which_(*sides_of(rule.transients.merge).passes) {}

float PassJudge::score_of(std::uint32_t slot, double time) const {
  const std::size_t run = evidence_[slot].run_at(rule_.times.tick(time));
  if (run == Evidence::kRuns || !which_.covers(run)) return 0.0F;
  return contradicts(evidence_[slot], run, rule_.transients.paper) ? scores_[slot] : 0.0F;
}

std::vector<float> PassJudge::judge(const RayCloud& rays) const {
  return contradicting_rays(
      tree_, rays, rule_.counting.guard,
      [this](std::uint32_t slot, double time) { return score_of(slot, time); },
      [this](std::uint32_t slot) { return opacity_while_there(evidence_[slot]); });
}

}  // namespace ray
