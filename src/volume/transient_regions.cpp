#include "transient_regions.h"

#include "raise.h"
#include "transience.h"

#include <raycloud/exec/parallel.h>

#include <algorithm>

namespace ray {
namespace {

/// Of exchangeable hits and passes, one run is as long as 1 / opacity on average, and the longest of a dozen
/// pauses three times that.
constexpr Transience kByChance{1.0F, 3.0F, 1.0F};
constexpr Transience kHintByChance{0.5F, 1.5F, 0.5F};

constexpr float kTogether = 2.5F;  ///< how much surer several are than one
constexpr float kSource = 14.0F, kSolidSource = 10.0F, kLeastHint = 0.7F;

float beyond(const Transience& transience, const Transience& chance, const Contradiction& which) {
  return (which.before ? std::max(0.0F, transience.before - chance.before) : 0.0F) +
         (which.between ? std::max(0.0F, transience.between - chance.between) : 0.0F) +
         (which.after ? std::max(0.0F, transience.after - chance.after) : 0.0F);
}

float quantile(std::vector<float>& values, std::size_t tenths) {
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(tenths * values.size() / 10);
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

class Regions {
 public:
  Regions(const Context& context, const EllipsoidTree& tree,
          const std::function<RegionSeed(std::size_t slot)>& seed)
      : context_(context),
        tree_(tree),
        own_(tree.size()),
        hints_(tree.size()),
        opaque_(tree.size()),
        solid_(tree.size()) {
    parallel_for(context, tree.size(), kGrain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        const RegionSeed of_slot = seed(i);
        own_[i] = of_slot.own;
        hints_[i] = of_slot.hint;
        opaque_[i] = of_slot.opaque;
        solid_[i] = of_slot.solid;
      }
    });
  }

  void begin() {
    scores_.resize(own_.size());
    each([&](std::size_t i) { return own_[i] > 0.0F; },
         [&](std::size_t i, std::span<const std::uint32_t> around) {
           const float alone = std::min(own_[i], quantile_of(own_, around, kMedian));
           const float together = kTogether * std::min(own_[i], quantile_of(own_, around, kLeastTenth));
           scores_[i] = opaque_[i] != 0 ? std::max(alone, together) : alone;
         });
  }

  /// To those whose centre is in the ellipsoid, and to those in which its centre is.
  void spread(float source, bool only_solid) {
    constexpr float kMostOfHint = 10.0F;
    std::vector<float>& reached = own_;  // which is needed no more
    std::fill(reached.begin(), reached.end(), 0.0F);
    const auto may = [&](std::size_t i) { return !only_solid || solid_[i] != 0; };
    each([&](std::size_t i) { return may(i) && (scores_[i] >= source || hints_[i] > kLeastHint); },
         [&](std::size_t i, std::span<const std::uint32_t> around) {
           float best = 0.0F;
           for (const std::uint32_t other : around) {
             if (may(other)) best = std::max(best, scores_[other]);
             if (scores_[i] >= source) raise(reached[other], scores_[i]);
           }
           if (best >= source) raise(reached[i], best);
         });
    for (std::size_t i = 0; i < scores_.size(); ++i)
      if (may(i) && hints_[i] > kLeastHint)
        scores_[i] = std::max(scores_[i], std::min(kMostOfHint * hints_[i], reached[i]));
  }

  void fill_holes() {
    std::vector<float>& reached = own_;
    std::fill(reached.begin(), reached.end(), 0.0F);
    each([&](std::size_t i) { return scores_[i] > 0.0F; },
         [&](std::size_t i, std::span<const std::uint32_t> around) {
           for (const std::uint32_t other : around)
             raise(reached[other], scores_[i]);
         });
    std::vector<float>& filled = hints_;
    filled = scores_;
    each([&](std::size_t i) { return reached[i] > 0.0F || scores_[i] > 0.0F; },
         [&](std::size_t i, std::span<const std::uint32_t> around) {
           filled[i] = std::max(scores_[i], quantile_of(scores_, around, kMedian));
         });
    scores_ = std::move(filled);
  }

  [[nodiscard]] std::vector<float> take() { return std::move(scores_); }

 private:
  static constexpr std::size_t kGrain = 4096;
  static constexpr std::size_t kMedian = 5, kLeastTenth = 1;  ///< tenths

  /// `work(i, around)` for each that `wanted(i)`, with the ellipsoids that its centre is in.
  template <class Wanted, class Work>
  void each(const Wanted& wanted, const Work& work) const {
    parallel_for(context_, own_.size(), kGrain, [&](std::size_t begin, std::size_t end) {
      std::vector<std::uint32_t> around;
      for (std::size_t i = begin; i < end; ++i) {
        if (!wanted(i)) continue;
        tree_.holding(tree_.at_slot(static_cast<std::uint32_t>(i)).centre, around);
        work(i, around);
      }
    });
  }

  static float quantile_of(const std::vector<float>& of, std::span<const std::uint32_t> around,
                           std::size_t tenths) {
    thread_local std::vector<float> values;
    values.clear();
    for (const std::uint32_t slot : around)
      values.push_back(of[slot]);
    return quantile(values, tenths);
  }

  const Context& context_;
  const EllipsoidTree& tree_;
  std::vector<float> own_;
  std::vector<float> hints_;
  std::vector<std::uint8_t> opaque_, solid_;
  std::vector<float> scores_;
};

}  // namespace

RegionSeed region_seed(const Evidence& evidence, const Contradiction& which) {
  constexpr float kOpaque = 0.95F, kSolid = 0.5F;
  const float opacity = opacity_while_there(evidence);
  return {beyond(transience_of(evidence), kByChance, which), beyond(hint_of(evidence), kHintByChance, which),
          static_cast<std::uint8_t>(opacity >= kOpaque ? 1 : 0),
          static_cast<std::uint8_t>(opacity >= kSolid ? 1 : 0)};
}

bool is_awake(const RegionSeed& seed) {
  return seed.own > 0.0F || seed.hint > kLeastHint;
}

bool is_source(const RegionSeed& seed, const SpreadSteps& steps) {
  return kTogether * seed.own >= (steps.solid > 0 && seed.solid != 0 ? kSolidSource : kSource);
}

std::vector<float> transient_regions(const Context& context, const EllipsoidTree& tree,
                                     const std::function<RegionSeed(std::size_t slot)>& seed,
                                     const SpreadSteps& steps) {
  Regions regions(context, tree, seed);
  regions.begin();
  for (int i = 0; i < steps.all(); ++i)
    i < steps.any ? regions.spread(kSource, false) : regions.spread(kSolidSource, true);
  regions.fill_holes();
  return regions.take();
}

float paper_score(const Evidence& evidence, const Contradiction& which) {
  const Transience transience = paper_transience(evidence);
  return std::max(which.before ? transience.before : 0.0F, which.after ? transience.after : 0.0F);
}

std::vector<float> transience_scores(const Context& context, const EllipsoidTree& tree,
                                     std::span<const Evidence> evidence, const Contradiction& which,
                                     const SpreadSteps& steps, bool paper) {
  if (!paper)
    return transient_regions(
        context, tree, [&](std::size_t i) { return region_seed(evidence[i], which); }, steps);
  std::vector<float> scores(evidence.size());
  std::transform(evidence.begin(), evidence.end(), scores.begin(),
                 [&](const Evidence& of_slot) { return paper_score(of_slot, which); });
  return scores;
}

}  // namespace ray
