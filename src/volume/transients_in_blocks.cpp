#include "transients_in_blocks.h"

#include "block_regions.h"
#include "count_rule.h"
#include "crossing_rays.h"
#include "each_chunk.h"
#include "ellipsoid_blocks.h"
#include "write_judged.h"

#include <raycloud/core/error.h>

#include <algorithm>
#include <numeric>

namespace ray {
namespace {

constexpr std::size_t kAtOnce = 1 << 14;

/// By the slots of a tree what is by the numbers of its ellipsoids.
template <class Value>
std::vector<Value> by_slot(const Context& context, const EllipsoidTree& tree,
                           const std::vector<Value>& by_number) {
  std::vector<Value> values(by_number.size());
  parallel_for(context, values.size(), kAtOnce, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      values[tree.slot(i)] = by_number[i];
  });
  return values;
}
template <class Value>
std::vector<Value> by_number(const Context& context, const EllipsoidTree& tree,
                             const std::vector<Value>& by_slot) {
  std::vector<Value> values(by_slot.size());
  parallel_for(context, values.size(), kAtOnce, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      values[i] = by_slot[tree.slot(i)];
  });
  return values;
}

std::vector<std::uint32_t> row_numbers(const RayCloud& rays, const RawChunk& raw) {
  std::vector<std::uint32_t> numbers(rays.size());
  std::iota(numbers.begin(), numbers.end(), static_cast<std::uint32_t>(raw.first_row));
  return numbers;
}

class TransientBlocks {
 public:
  TransientBlocks(const Context& context, RaySource& source, const ReadEnds& ends, const JudgeRule& rule)
      : context_(context),
        memory_(memory_budget(context)),
        rule_(rule),
        sides_(sides_of(rule.transients.merge)),
        blocks_(context, source, ends, kJudgedPointBytes),
        evidence_(blocks_.parts(), memory_ / 64),
        judged_(blocks_.parts(), memory_ / 64) {
    rule_.counting = count_rule(rule.transients.paper, blocks_.range_noise());
    rays_ = std::make_unique<CrossingRays>(blocks_.boxes(), memory_ / 16);
    rays_->add(context, source, row_numbers);
    if (sides_.passes) passes_.resize(ends.rows);
  }

  void count() {
    if (!rule_.transients.paper) {
      if (sides_.ends) of_ends_ = std::make_unique<BlockRegions>(blocks_, kWithinCloud);
      if (sides_.passes) of_passes_ = std::make_unique<BlockRegions>(blocks_, kWithinCloud);
    }
    each_part([&](std::size_t part) {
      const std::vector<Evidence> evidence = count_part(part);
      evidence_.append(part, evidence);
      if (rule_.transients.paper) return;
      const std::vector<PackedEllipsoid> ellipsoids = blocks_.load(part);
      if (sides_.ends) of_ends_->see(part, seeds(evidence, *sides_.ends), ellipsoids);
      if (sides_.passes) of_passes_->see(part, seeds(evidence, *sides_.passes), ellipsoids);
    });
    if (!sides_.passes) rays_.reset();
  }

  void judge() {
    if (of_ends_) bring_together(*of_ends_, *sides_.ends);
    if (of_passes_) bring_together(*of_passes_, *sides_.passes);
    each_part([&](std::size_t part) {
      const std::vector<Evidence> evidence = evidence_.load(part);
      evidence_.drop(part);
      const std::vector<float> ends = scores(part, evidence, sides_.ends, of_ends_.get());
      std::vector<float> passes = scores(part, evidence, sides_.passes, of_passes_.get());
      spare_passes(ends, passes);
      std::vector<JudgedEnd> judged(evidence.size());
      parallel_for(context_, judged.size(), kAtOnce, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
          judged[i] = judged_end(evidence[i], ends.empty() ? 0.0F : ends[i]);
      });
      judged_.append(part, judged);
      if (std::any_of(passes.begin(), passes.end(), [](float score) { return score > 0.0F; }))
        judge_passes(part, evidence, passes);
    });
    rays_.reset();
  }

  TransientCounts write(RaySource& source, RaySink& fixed, RaySink& transient) {
    struct Where {
      std::uint64_t first_row = 0;
      std::vector<std::uint32_t> parts;
    };
    return write_judged(
        context_, source, fixed, transient, rule_.transients,
        [&](const RayCloud& rays, const RawChunk& raw) {
          Where where{raw.first_row, {}};
          for (std::size_t i = 0; i < rays.size(); ++i)
            if (rays.bounded[i] != 0)
              where.parts.push_back(static_cast<std::uint32_t>(blocks_.part_of(rays.ends[i])));
          return where;
        },
        [&](const RayCloud& rays, const Where& where) {
          return JudgedChunk{judged_.take(where.parts),
                             passes_.empty()
                                 ? std::span<const float>()
                                 : std::span<const float>(passes_).subspan(where.first_row, rays.size())};
        });
  }

 private:
  template <class Work>
  void each_part(const Work& work) {
    for (std::size_t part = 0; part < blocks_.parts(); ++part) {
      if (blocks_.size(part) == 0) continue;
      check_cancelled(context_);
      work(part);
    }
  }

  std::vector<Evidence> count_part(std::size_t part) {
    const std::unique_ptr<EllipsoidTree> tree = blocks_.tree(context_, part);
    return by_number(context_, *tree,
                     count_evidence(context_, *rays_->ending(part), *rays_->crossing(part), *tree, rule_));
  }

  [[nodiscard]] std::vector<RegionSeed> seeds(const std::vector<Evidence>& evidence,
                                              const Contradiction& which) const {
    std::vector<RegionSeed> seeds(evidence.size());
    parallel_for(context_, seeds.size(), kAtOnce, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i)
        seeds[i] = region_seed(evidence[i], which);
    });
    return seeds;
  }

  void bring_together(BlockRegions& regions, const Contradiction& which) {
    regions.judge(context_, [&](std::size_t part) { return seeds(evidence_.load(part), which); });
  }

  static std::vector<float> scores(std::size_t part, const std::vector<Evidence>& evidence,
                                   const std::optional<Contradiction>& which, BlockRegions* regions) {
    if (!which) return {};
    if (regions != nullptr) return regions->scores(part);
    std::vector<float> of_paper(evidence.size());
    std::transform(evidence.begin(), evidence.end(), of_paper.begin(),
                   [&](const Evidence& of_end) { return paper_score(of_end, *which); });
    return of_paper;
  }

  void judge_passes(std::size_t part, const std::vector<Evidence>& evidence,
                    const std::vector<float>& scores) {
    const std::unique_ptr<EllipsoidTree> tree = blocks_.tree(context_, part);
    const std::vector<Evidence> of_slots = by_slot(context_, *tree, evidence);
    const PassJudge judge(*tree, of_slots, by_slot(context_, *tree, scores), rule_);
    const std::unique_ptr<RaySource> source = rays_->crossing(part);
    each_chunk(context_, *source, [&](const RayCloud& rays) {
      const std::vector<float> of_chunk = judge.judge(rays);
      const std::span<const std::uint32_t> rows = numbers_of(rays);
      for (std::size_t i = 0; i < rays.size(); ++i)
        passes_[rows[i]] = std::max(passes_[rows[i]], of_chunk[i]);
    });
  }

  const Context& context_;
  std::size_t memory_;
  JudgeRule rule_;
  Sides sides_;
  EllipsoidBlocks blocks_;
  std::unique_ptr<CrossingRays> rays_;
  SpilledRows<Evidence> evidence_;
  SpilledRows<JudgedEnd> judged_;
  std::unique_ptr<BlockRegions> of_ends_, of_passes_;  ///< none by the rule of the paper
  std::vector<float> passes_;  ///< by row of the cloud: empty if no ray goes for what it passed
};

}  // namespace

TransientCounts split_in_blocks(const Context& context, RaySource& source, RaySink& fixed, RaySink& transient,
                                const ReadEnds& ends, JudgeRule rule) {
  constexpr std::uint64_t kMostRows = 0xffffffff;
  if (ends.rows > kMostRows) throw Error(ErrorCode::out_of_range, "more than 4 billion rays");
  TransientBlocks blocks(context, source, ends, rule);
  blocks.count();
  blocks.judge();
  return blocks.write(source, fixed, transient);
}

}  // namespace ray
