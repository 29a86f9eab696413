#include "cloud_conflicts.h"

#include "cloud_ellipsoids.h"
#include "conflict_evidence.h"
#include "conflicts_in_blocks.h"
#include "judgement.h"
#include "read_ends.h"
#include "transient_regions.h"

#include <algorithm>
#include <utility>

namespace ray {
namespace {

/// Where the whole cloud is in memory; everything is by slot.
class WholeConflicts {
 public:
  WholeConflicts(const Context& context, const ConflictQuestion& question, CloudEllipsoids&& cloud)
      : context_(context),
        question_(question),
        tree_(std::move(cloud.tree)),
        rule_(context, question, cloud.range_noise) {}

  void hear(std::size_t other) {
    std::vector<std::uint32_t> passed = rule_.passed_slots(*tree_, rule_.rays_of(other));
    if (passed.empty()) return;
    const std::vector<Evidence> evidence = evidence_of(std::move(passed), other);
    if (evidence.empty()) return;
    const Sides& sides = rule_.sides(other);
    if (sides.ends) {
      const std::vector<float> ends =
          transience_scores(context_, *tree_, evidence, *sides.ends, kBetweenClouds, rule_.paper());
      ends_.resize(ends.size());
      for (std::size_t i = 0; i < ends.size(); ++i)
        ends_[i] = std::max(ends_[i], ends[i]);
    }
    if (sides.passes) {
      const std::vector<float> passes =
          transience_scores(context_, *tree_, evidence, *sides.passes, kBetweenClouds, rule_.paper());
      std::vector<PassConflict> conflicts;
      for (std::uint32_t slot = 0; slot < passes.size(); ++slot)
        add_pass_conflict(slot, passes[slot], evidence[slot], rule_.paper(), conflicts);
      passes_.emplace_back(other, std::move(conflicts));
    }
  }

  void tell(const TellConflicts& to) {
    for (auto& [other, conflicts] : passes_) {
      std::erase_if(conflicts, [&](const PassConflict& conflict) {
        return !rule_.gives_way(conflict.score) ||
               (!ends_.empty() && rule_.gives_way(ends_[conflict.ellipsoid]));
      });
      if (conflicts.empty()) continue;
      std::vector<std::uint32_t> slots;
      for (const PassConflict& conflict : conflicts)
        slots.push_back(conflict.ellipsoid);
      const SomeEllipsoids some = some_of(context_, *tree_, std::move(slots));
      tell_passes(*some.tree, conflicts, rule_.counting().guard, rule_.rays_of(other), to.passes);
    }
    if (ends_.empty()) return;
    std::size_t next = 0;
    std::vector<float> of_chunk;
    tell_ends(
        context_, question_.clouds[question_.own],
        [&](const RayCloud& rays) {
          of_chunk.clear();
          for (const std::uint8_t bounded : rays.bounded)
            if (bounded != 0) of_chunk.push_back(ends_[tree_->slot(next++)]);
          return std::span<const float>(of_chunk);
        },
        to.ends);
  }

 private:
  /// By slot; empty if nothing contradicts.
  std::vector<Evidence> evidence_of(std::vector<std::uint32_t> passed, std::size_t other) const {
    std::vector<std::uint32_t> slots;
    std::vector<Encounters> of_other;
    {
      const SomeEllipsoids some = some_of(context_, *tree_, std::move(passed));
      const std::vector<Encounters> met = rule_.met_by(*some.tree, rule_.rays_of(other));
      for (std::size_t i = 0; i < some.slots.size(); ++i)
        if (const Encounters& of_slot = met[some.tree->slot(i)]; rule_.may_contradict(of_slot)) {
          slots.push_back(some.slots[i]);
          of_other.push_back(of_slot);
        }
    }
    if (slots.empty()) return {};
    const SomeEllipsoids some = some_of(context_, *tree_, std::move(slots));
    const std::vector<Encounters> of_own = rule_.met_by(*some.tree, rule_.rays_of(question_.own));
    std::vector<Evidence> evidence(tree_->size());
    for (std::size_t i = 0; i < some.slots.size(); ++i)
      evidence[some.slots[i]] = rule_.evidence(of_own[some.tree->slot(i)], of_other[i]);
    return evidence;
  }

  const Context& context_;
  const ConflictQuestion& question_;
  std::unique_ptr<EllipsoidTree> tree_;
  ConflictRule rule_;
  std::vector<float> ends_;  ///< empty: none gives way
  std::vector<std::pair<std::size_t, std::vector<PassConflict>>> passes_;
};

}  // namespace

void find_conflicts(const Context& context, const ConflictQuestion& question, const TellConflicts& tell) {
  RaySource& source = *question.clouds[question.own].source;
  ReadEnds ends = read_ends(context, source, memory_budget(context) / kJudgedPointBytes);
  if (ends.sample.bounded == 0) return;
  if (!ends.fits()) {
    find_conflicts_in_blocks(context, question, ends, tell);
    return;
  }
  WholeConflicts conflicts(context, question, cloud_ellipsoids(context, std::move(ends)));
  for (std::size_t other = 0; other < question.clouds.size(); ++other)
    if (other != question.own) conflicts.hear(other);
  conflicts.tell(tell);
}

}  // namespace ray
