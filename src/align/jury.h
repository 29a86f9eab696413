#pragma once
/// Which of the poses that may be right is: by what both clouds have seen.

#include "agreement.h"
#include "patches.h"
#include "sightlines.h"

#include <raycloud/core/pose.h>
#include <raycloud/exec/context.h>

namespace ray::align {

/// A cloud as alignment knows it.
struct Known {
  static constexpr double kLeastPoints = 5.0;  ///< of a patch

  Known(const Context& context, Surfaces gathered);

  Surfaces surfaces;
  PatchLevel narrow, fine, middle, wide;  ///< cubes as wide as the surfaces', and two, four and eight times
  FreeCubes free;
  std::vector<Segment> sightlines;  ///< an even choice
};

struct Hypothesis {
  Pose pose;             ///< from the origin of the cloud to that of the reference
  Evidence there, back;  ///< of the cloud's patches about the reference, and the other way round
  double score = 0.0;

  /// The share of the patches of the cloud or of the reference that agree with the other, whichever is more.
  [[nodiscard]] double overlap() const;
  /// Next to nothing would be in both: no answer.
  [[nodiscard]] bool is_idle() const {
    constexpr double kLeastSame = 100.0;  // patches
    constexpr double kLeastOverlap = 0.1;
    return there.counts.same + back.counts.same < kLeastSame || overlap() < kLeastOverlap;
  }
  /// Of what both clouds tell something of, the share that is refuted.
  [[nodiscard]] double refuted_share() const {
    const double known = there.known + back.known;
    return known > 0.0 ? (there.refuted + back.refuted) / known : 0.0;
  }
  /// One cloud has much that is not in the other, and the other nearly nothing that is not in it: leaves,
  /// snow, or furniture. Of a wrong pose both have.
  [[nodiscard]] bool is_refuted_by_one_only(double nearly_none = 0.02) const;
  [[nodiscard]] bool is_refuted() const {
    constexpr double kMostRefuted = 0.07;  // right poses: up to 4 %, 7 % in traffic
    return refuted_share() > kMostRefuted && !is_refuted_by_one_only();
  }
};

/// By how many standard errors more speaks against a pose than is usual under the best one, if cells are
/// independent of each other; 0 where that is less than `least_share` of what is known. That the best
/// overlaps more tells nothing.
[[nodiscard]] double sigmas_worse(const Hypothesis& other, const Hypothesis& best, double least_share = 0.01);

/// The same of what is refuted alone.
[[nodiscard]] double sigmas_more_refuted(const Hypothesis& other, const Hypothesis& best);

/// Judges poses from both sides, by an even choice of the patches of either cloud.
class Jury {
 public:
  Jury(const Known& cloud, const Known& reference);

  /// Scores a pose by the evidence of both sides. Where next to nothing is in both it is the lowest score.
  void judge(Hypothesis& one) const;
  /// `sigmas_worse` of two poses near each other, by surfaces in cubes half as wide: what tells them apart is
  /// within a patch.
  [[nodiscard]] double sigmas_worse_closely(const Hypothesis& other, const Hypothesis& best) const;
  /// The pose, and of all clean patches which ones rays of the other cloud go through: to a fraction of a
  /// patch, where free cubes leave two patches before each surface untold. Of right poses that is less than 1
  /// % of space, but for what has moved.
  [[nodiscard]] Hypothesis judged_by_rays(const Context& context, const Pose& pose) const;
  /// Of a pose judged by rays: by how many standard errors these go through more surfaces than is usual of
  /// right poses: a hundredth, and more of patches wider than 80 cm.
  [[nodiscard]] double sigmas_pierced(const Hypothesis& by_rays) const;
  /// The score of a pose by an eighth of the witnesses.
  [[nodiscard]] double glance(const Pose& pose) const;

 private:
  /// The evidence of both sides by narrow patches.
  [[nodiscard]] Hypothesis judged_closely(const Pose& pose) const;

  static constexpr std::size_t kJudged = 8000, kGlanced = 1000;  // of each cloud
  const Known& cloud_;
  const Known& reference_;
  double tolerance_;
  Witnesses there_, back_, few_there_, few_back_, narrow_there_, narrow_back_, all_there_, all_back_;
};

/// Whether two poses put a cloud to the same place, within the width of a patch.
[[nodiscard]] bool is_same_place(const Pose& a, const Pose& b, const Known& cloud);

/// How far (m) from a surface a patch is on it.
[[nodiscard]] double tolerance_of(const Known& cloud, const Known& reference);

}  // namespace ray::align
