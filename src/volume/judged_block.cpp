#include "judged_block.h"

#include "count_rule.h"
#include "each_chunk.h"
#include "transience.h"

#include <algorithm>

namespace ray {
namespace {

/// All that rays tell of the ellipsoids.
std::vector<Evidence> evidence_of(const Context& context, RaySource& source, const EllipsoidTree& tree,
                                  const TimeScale& scale, const CountRule& counting, bool one_episode) {
  std::vector<Evidence> evidence(tree.size());
  {
    HitTimes times(tree.size());
    each_chunk(context, source, [&](const RayCloud& rays) { times.add(tree, rays, scale); });
    constexpr double kLongest = 65536.0;  // ticks
    times.find_episodes(context, one_episode ? kLongest : scale.ticks(counting.look_time), evidence);
  }
  each_chunk(context, source,
             [&](const RayCloud& rays) { add_passes(tree, rays, counting, scale, evidence); });
  return evidence;
}

/// Whether a run is longer than it may be by chance. Runs that are not prove nothing, whatever others do.
bool contradicts(const Evidence& evidence, std::size_t run, bool paper) {
  constexpr float kLongestByChance = 3.0F;
  return paper || static_cast<float>(evidence.passes[run]) * opacity_while_there(evidence) > kLongestByChance;
}

}  // namespace

JudgedBlock::JudgedBlock(const Context& context, RaySource& source, EllipsoidMaker&& maker,
                         const JudgeRule& rule)
    : rule_(rule),
      counting_(count_rule(rule.transients.paper, rule.range_noise)),
      tree_(EllipsoidMaker(std::move(maker)).make(context, rule.reach, rule.range_noise)),
      evidence_(evidence_of(context, source, *tree_, rule.times, counting_, rule.transients.paper)) {
  score(context);
}

std::vector<float> JudgedBlock::scores_by(const Context& context, const Contradiction& which) const {
  if (!rule_.transients.paper) return transient_regions(context, *tree_, evidence_, which);
  std::vector<float> scores(evidence_.size());
  for (std::size_t i = 0; i < scores.size(); ++i) {
    const Transience transience = paper_transience(evidence_[i]);
    scores[i] = std::max(which.before ? transience.before : 0.0F, which.after ? transience.after : 0.0F);
  }
  return scores;
}

void JudgedBlock::score(const Context& context) {
  switch (rule_.transients.merge) {
    case Merge::min:
      ends_ = scores_by(context, {});
      return;
    case Merge::max:
      passes_ = scores_by(context, {});
      return;
    case Merge::oldest:
      ends_ = scores_by(context, {.between = false, .after = false});
      passes_ = scores_by(context, {.before = false});
      first_run_ = 1;
      break;
    case Merge::newest:
      ends_ = scores_by(context, {.before = false, .between = false});
      passes_ = scores_by(context, {.after = false});
      last_run_ = Evidence::kRuns - 2;
      break;
  }
  // What is itself taken out contradicts nobody.
  for (std::size_t i = 0; i < ends_.size(); ++i)
    if (ends_[i] >= passes_[i]) passes_[i] = 0.0F;
}

JudgedEnd JudgedBlock::end(std::size_t i) const {
  const std::uint32_t slot = tree_->slot(i);
  const Evidence& evidence = evidence_[slot];
  return {opacity_of(evidence), evidence.hits, evidence.crossings, ends_.empty() ? 0.0F : ends_[slot]};
}

void JudgedBlock::keep_passes_of(std::span<const std::uint8_t> own) {
  for (std::size_t i = 0; i < own.size(); ++i)
    if (own[i] == 0) passes_[tree_->slot(i)] = 0.0F;
}

float JudgedBlock::pass_score(std::uint32_t slot, double time) const {
  const std::size_t run = evidence_[slot].run_at(rule_.times.tick(time));
  if (run == Evidence::kRuns || run < first_run_ || run > last_run_) return 0.0F;
  return contradicts(evidence_[slot], run, rule_.transients.paper) ? passes_[slot] : 0.0F;
}

std::vector<float> JudgedBlock::judge_passes(const RayCloud& rays) const {
  return contradicting_rays(
      *tree_, rays, counting_.guard,
      [this](std::uint32_t slot, double time) { return pass_score(slot, time); },
      [this](std::uint32_t slot) { return opacity_while_there(evidence_[slot]); });
}

}  // namespace ray
