#pragma once
/// What rays tell of ellipsoids, and what becomes by that of ends and of rays: for all of a cloud, or for the
/// ellipsoids of one block.

#include "contradiction.h"

#include <raycloud/core/ray_stream.h>
#include <raycloud/volume/free_space.h>
#include <raycloud/volume/transients.h>

#include <cstdint>
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

/// How a cloud is judged.
struct JudgeRule {
  TransientRule transients;
  TimeScale times{0.0, 0.0};
  CountRule counting;
};

/// Most memory for an end of a whole cloud, the judgement included.
inline constexpr std::size_t kJudgedPointBytes = 140;

/// Whose ends, and which rays that passed, the merge takes out.
[[nodiscard]] Sides sides_of(Merge merge);

/// How long a pause must be to part hits, in ticks: no time is as long as the paper's.
[[nodiscard]] double look_ticks(const JudgeRule& rule);

/// All that rays tell of the ellipsoids, by slot: those of `ending` may end in one, those of `crossing` may
/// cross one; they may be one source. Reads each once and rewinds it. About 2 µs of one core a ray.
[[nodiscard]] std::vector<Evidence> count_evidence(const Context& context, RaySource& ending,
                                                   RaySource& crossing, const EllipsoidTree& tree,
                                                   const JudgeRule& rule);

/// The same, where the hits are known: by slot, and they are given away.
[[nodiscard]] std::vector<Evidence> count_evidence(const Context& context, std::vector<HitEpisodes>&& hits,
                                                   RaySource& crossing, const EllipsoidTree& tree,
                                                   const JudgeRule& rule);

[[nodiscard]] JudgedEnd judged_end(const Evidence& evidence, float score);

/// What is itself taken out contradicts nobody: where the score of an end is no less, that of its passes is 0
/// from now on. Either may be empty.
void spare_passes(std::span<const float> ends, std::span<float> passes);

/// Judges rays by what they passed.
class PassJudge {
 public:
  /// All by slot; the scores are those for the passes.
  PassJudge(const EllipsoidTree& tree, std::span<const Evidence> evidence, std::vector<float> scores,
            const JudgeRule& rule);
  /// Of each ray, the most rays of the rule for which it goes as a pass. Thread-safe.
  [[nodiscard]] std::vector<float> judge(const RayCloud& rays) const;

 private:
  [[nodiscard]] float score_of(std::uint32_t slot, double time) const;

  const EllipsoidTree& tree_;
  std::span<const Evidence> evidence_;
  std::vector<float> scores_;
  const JudgeRule& rule_;
  Contradiction which_;
};

}  // namespace ray
