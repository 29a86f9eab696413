#pragma once
/// Poses that may be right, and which of them is.

#include "agreement.h"
#include "fine.h"

#include <raycloud/exec/context.h>

#include <vector>

namespace ray::align {

/// A cloud as alignment knows it.
struct Known {
  Known(const Context& context, Surfaces gathered);

  Surfaces surfaces;
  PatchLevel narrow, fine, middle, wide;  ///< cubes as wide as the surfaces', and two, four and eight times
  FreeCubes free;
};

struct Hypothesis {
  Pose pose;              ///< from the origin of the cloud to that of the reference
  Agreement there, back;  ///< of the cloud's patches with the reference, and the other way round
  double score = 0.0;

  static constexpr double kLeastSame = 100.0;  // patches
  /// Of the patches that agree or speak against the pose, the share of the latter.
  [[nodiscard]] double against_share() const {
    const double against = there.against + back.against, same = there.all().same + back.all().same;
    return against > 0.0 ? against / (against + same) : 0.0;
  }
  /// Too much speaks against it, whatever the other ones are.
  [[nodiscard]] bool is_refuted() const {
    constexpr double kMost = 0.02;
    return against_share() > kMost;
  }
};

/// Judges poses from both sides, by an even choice of the patches of either cloud.
class Jury {
 public:
  Jury(const Known& cloud, const Known& reference);

  void judge(Hypothesis& one) const;
  /// Whether a pose explains what is known under both better than a rival does, by so many standard errors,
  /// and by more than a hundredth of it: of many patches noise alone is significant.
  [[nodiscard]] bool is_clearly_better(const Pose& pose, const Pose& rival, double sigmas) const;
  /// Of hypotheses in the order of their scores. The score prefers what overlaps most; one that explains what
  /// both have seen better goes before it: by four standard errors, or by one and a half where too much
  /// speaks against the other.
  void put_best_first(std::vector<Hypothesis>& all) const;

 private:
  static constexpr std::size_t kJudged = 3000, kCompared = 8000;  // of each cloud
  const Known& cloud_;
  const Known& reference_;
  double tolerance_;
  std::vector<JudgedPatch> there_, back_, more_there_, more_back_;
};

void sort_by_score(std::vector<Hypothesis>& hypotheses);

/// Poses from all candidates, roughly fitted, distinct, the best first.
[[nodiscard]] std::vector<Hypothesis> rough_hypotheses(const Context& context, const Known& cloud,
                                                       const Known& reference);

/// The given ones fitted with all six degrees of freedom and judged from both sides, the best first.
[[nodiscard]] std::vector<Hypothesis> fitted(const Context& context, const Known& cloud,
                                             const Known& reference, const Jury& jury,
                                             std::vector<Hypothesis> hypotheses);

/// Poses beside a pose: a step aside in eight directions and a little turn either way, which come back when
/// they are fitted if there is anything that holds the cloud where it is; and of all small shifts the six
/// that agree best without being fitted.
[[nodiscard]] std::vector<Hypothesis> aside_of(const Context& context, const Pose& pose, const Known& cloud,
                                               const Known& reference);

/// Whether two poses put a cloud to the same place, within the width of a patch.
[[nodiscard]] bool is_same_place(const Pose& a, const Pose& b, const Known& cloud);

/// How far (m) from a surface a patch is on it.
[[nodiscard]] double tolerance_of(const Known& cloud, const Known& reference);

}  // namespace ray::align
