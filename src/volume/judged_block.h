#pragma once
/// What becomes of the ends, and of the rays that passed them, in a piece of space: all of it, or a block
/// with what lies around it.

#include "cloud_ellipsoids.h"
#include "contradicting_rays.h"
#include "transient_regions.h"

#include <raycloud/core/ray_stream.h>
#include <raycloud/volume/free_space.h>
#include <raycloud/volume/transients.h>

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace ray {

/// Of one end. 12 bytes.
struct JudgedEnd {
  float opacity = 0.0F;
  std::uint16_t hits = 0;
  std::uint16_t passes = 0;
  float transience = 0.0F;  ///< 0 where the merge takes out no ends
};

/// How all blocks of a cloud are judged.
struct JudgeRule {
  TransientRule transients;
  double reach = 0.0;  ///< m, of neighbours
  double range_noise = 0.0;
  TimeScale times{0.0, 0.0};
};

/// Most memory for a point of the block, the judgement included.
inline constexpr std::size_t kJudgedPointBytes = 140;

class JudgedBlock {
 public:
  /// Of the ends that `maker` has. Reads `source` twice and rewinds it. About 4 µs of one core an end.
  JudgedBlock(const Context& context, RaySource& source, EllipsoidMaker&& maker, const JudgeRule& rule);
  JudgedBlock(const JudgedBlock&) = delete;
  JudgedBlock& operator=(const JudgedBlock&) = delete;

  [[nodiscard]] JudgedEnd end(std::size_t i) const;

  /// Whether the merge takes out rays that saw through something.
  [[nodiscard]] bool judges_passes() const { return !passes_.empty(); }
  /// The ends that are not `own` are contradicted by no rays from now on.
  void keep_passes_of(std::span<const std::uint8_t> own);
  /// Of each ray, the most rays of the rule for which it goes as a pass. Thread-safe.
  [[nodiscard]] std::vector<float> judge_passes(const RayCloud& rays) const;

 private:
  void score(const Context& context);
  [[nodiscard]] std::vector<float> scores_by(const Context& context, const Contradiction& which) const;
  [[nodiscard]] float pass_score(std::uint32_t slot, double time) const;

  JudgeRule rule_;
  CountRule counting_;
  std::unique_ptr<EllipsoidTree> tree_;
  std::vector<Evidence> evidence_;  ///< by slot, as the following are
  std::vector<float> ends_;         ///< empty: none is taken out
  std::vector<float> passes_;       ///< empty: none is taken out
  std::size_t first_run_ = 0;       ///< of the passes
  std::size_t last_run_ = Evidence::kRuns - 1;
};

}  // namespace ray
