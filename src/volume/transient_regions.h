#pragma once
/// What is transient comes in regions: evidence of neighbours is brought together.

#include "contradiction.h"

#include <raycloud/exec/context.h>
#include <raycloud/volume/ellipsoid_tree.h>

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace ray {

/// What the evidence of an ellipsoid says before that of others is heard. 12 bytes.
struct RegionSeed {
  float own = 0.0F;         ///< its transience, less what a hedge of even opacity would have by chance
  float hint = 0.0F;        ///< the same of its hint of transience
  std::uint8_t opaque = 0;  ///< 1: hardly a ray went through while it was there
  std::uint8_t solid = 0;   ///< 1: more rays ended in it than went through while it was there
};
[[nodiscard]] RegionSeed region_seed(const Evidence& evidence, const Contradiction& which);

/// Whether its number can be above 0 before holes are filled.
[[nodiscard]] bool is_awake(const RegionSeed& seed);
/// How often transience spreads: to any others, and after that among solid ones alone.
struct SpreadSteps {
  int any = 3;
  int solid = 0;
  [[nodiscard]] int all() const { return any + solid; }
};
/// By the rays of the cloud itself, which see through the rims of things everywhere.
inline constexpr SpreadSteps kWithinCloud{};
/// By those of another cloud. Twice its hits are taken off its passes, so that what both saw gives no hint.
inline constexpr SpreadSteps kBetweenClouds{.solid = 8};

/// Whether it may be so sure that it spreads to others.
[[nodiscard]] bool is_source(const RegionSeed& seed, const SpreadSteps& steps);

/// For each ellipsoid, by slot, the number of rays below which it is transient. Every step treats all numbers
/// at once: it takes medians, minima and maxima, and multiples of them.
///
/// 1. Its own transience, as a seed has it, but not above the median of the ellipsoids around its centre. Or,
/// if it was opaque, two and a half times that, but not above as
///    much of the least tenth of them: together they cover some four times its area, and so many more rays
///    went through.
/// 2. From where it is above 14 it spreads, step by step, to ellipsoids that overlap, up to ten times their
/// own hint of transience, where that is above 0.7. Among solid ones, from where it is above 10.
/// 3. It is at least the median of the ellipsoids around its centre, whatever its own evidence.
///
/// Memory: 14 bytes an ellipsoid. Time: little where nothing is transient.
[[nodiscard]] std::vector<float> transient_regions(const Context& context, const EllipsoidTree& tree,
                                                   const std::function<RegionSeed(std::size_t slot)>& seed,
                                                   const SpreadSteps& steps);

/// The numbers of the ellipsoids of a whole tree by their evidence alone: transient_regions, or what the
/// paper's rule says of each by itself.
[[nodiscard]] std::vector<float> transience_scores(const Context& context, const EllipsoidTree& tree,
                                                   std::span<const Evidence> evidence,
                                                   const Contradiction& which, const SpreadSteps& steps,
                                                   bool paper);
/// By the paper's rule.
[[nodiscard]] float paper_score(const Evidence& evidence, const Contradiction& which);

}  // namespace ray
