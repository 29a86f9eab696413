#include "hypotheses.h"

#include "coarse.h"
#include "rises.h"

#include <raycloud/exec/parallel.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

namespace ray::align {
namespace {

constexpr double kLeastPoints = 5.0;
/// Of the largest information: wide patches of level ground and of foliage say little of shifts.
constexpr double kHeld = 0.02;
constexpr double kAgainst = 20.0, kAgainstFitted = 10.0,
                 kAgainstAtFirst = 4.0;  // weights, against surfaces that agree

/// What agrees, less what speaks against it, which weighs most: there are one or two in a hundred where
/// clouds lie as they should, and five where the two halves of a building that look the same lie on each
/// other. Level surfaces agree with any other of their height: upright ones tell.
double score_of(const Agreement& there, const Agreement& back, double against) {
  constexpr double kOther = 0.5, kOthers = 0.5;
  const auto of = [](const Agreement::Counts& counts) { return counts.same - kOther * counts.other; };
  return of(there.upright) + of(back.upright) + kOthers * (of(there.others) + of(back.others)) -
         against * (there.against + back.against);
}

/// Of those that put the cloud to the same place, the best.
std::vector<Hypothesis> distinct_of(std::vector<Hypothesis>& hypotheses, const Known& cloud) {
  sort_by_score(hypotheses);
  std::vector<Hypothesis> distinct;
  for (const Hypothesis& one : hypotheses)
    if (std::none_of(distinct.begin(), distinct.end(),
                     [&](const Hypothesis& other) { return is_same_place(one.pose, other.pose, cloud); }))
      distinct.push_back(one);
  return distinct;
}

/// Without those that were fitted to just the pose of one before.
std::vector<Hypothesis> without_twins(const std::vector<Hypothesis>& hypotheses, const Known& cloud) {
  constexpr double kNear = 0.1;      // widths
  constexpr double kTurned = 0.003;  // rad
  std::vector<Hypothesis> distinct;
  for (const Hypothesis& one : hypotheses)
    if (std::none_of(distinct.begin(), distinct.end(), [&](const Hypothesis& other) {
          return (one.pose.translation - other.pose.translation).norm() < kNear * cloud.fine.width() &&
                 Eigen::AngleAxisd(Eigen::Matrix3d(one.pose.rotation.transpose() * other.pose.rotation))
                         .angle() < kTurned;
        }))
      distinct.push_back(one);
  return distinct;
}

Pose inverse_of(const Pose& pose) {
  return {pose.rotation.transpose(), -(pose.rotation.transpose() * pose.translation)};
}

Pose pose_of(const Candidate& candidate, double rise) {
  return {Eigen::AngleAxisd(candidate.yaw, Eigen::Vector3d::UnitZ()).toRotationMatrix(),
          {candidate.shift.x(), candidate.shift.y(), rise}};
}

/// A grid of shifts around a pose, half a width apart.
std::vector<Hypothesis> small_shifts(const Context& context, const Pose& pose, const Known& cloud,
                                     const Known& reference) {
  constexpr int kSteps = 6;
  constexpr std::size_t kJudged = 600, kBest = 6;
  const std::vector<JudgedPatch> judged = judged_patches(cloud.fine, kJudged);
  const double step = 0.5 * std::max(cloud.fine.width(), reference.fine.width());
  std::vector<Hypothesis> shifted;
  for (int y = -kSteps; y <= kSteps; ++y)
    for (int x = -kSteps; x <= kSteps; ++x) {
      if (x == 0 && y == 0) continue;
      shifted.push_back({pose, {}, {}, 0.0});
      shifted.back().pose.translation += step * Eigen::Vector3d(x, y, 0.0);
    }
  parallel_for(context, shifted.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Agreement there = agreement_of(judged, shifted[i].pose, {reference.fine, reference.free},
                                           tolerance_of(cloud, reference));
      shifted[i].score = score_of(there, {}, kAgainst);
    }
  });
  sort_by_score(shifted);
  shifted.resize(kBest);
  return shifted;
}

/// The best of all candidates at all heights, at a glance.
std::vector<Hypothesis> promising_of(const Context& context, const Known& cloud, const Known& reference,
                                     std::span<const Candidate> candidates) {
  constexpr std::size_t kRises = 3, kGlanced = 150, kPromising = 200, kLevels = 1000;
  const LevelHeights heights(reference.fine);
  const std::vector<Patch> levels = level_patches(cloud.fine, kLevels);
  const std::vector<JudgedPatch> glanced = judged_patches(cloud.fine, kGlanced);
  const double tolerance = 2.0 * tolerance_of(cloud, reference);
  std::vector<std::vector<Hypothesis>> of_candidate(candidates.size());
  parallel_for(context, candidates.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      for (const double rise : heights.rises(levels, candidates[i], kRises)) {
        const Pose pose = pose_of(candidates[i], rise);
        const Agreement there = agreement_of(glanced, pose, {reference.fine, reference.free}, tolerance);
        of_candidate[i].push_back({pose, there, {}, score_of(there, {}, kAgainstAtFirst)});
      }
  });
  std::vector<Hypothesis> hypotheses;
  for (const std::vector<Hypothesis>& some : of_candidate)
    hypotheses.insert(hypotheses.end(), some.begin(), some.end());
  sort_by_score(hypotheses);
  hypotheses.resize(std::min(hypotheses.size(), kPromising));
  return hypotheses;
}

/// Fitted by wide patches, turned about the vertical only.
std::vector<Hypothesis> roughly_fitted(const Context& context, const Known& cloud, const Known& reference,
                                       std::vector<Hypothesis> hypotheses) {
  constexpr std::size_t kFitted = 500, kJudged = 800;
  const std::vector<JudgedPatch> judged = judged_patches(cloud.fine, kJudged);
  const double tolerance = 2.0 * tolerance_of(cloud, reference);
  const std::vector<Patch> wide = some_of(cloud.wide.patches(), kFitted),
                           middle = some_of(cloud.middle.patches(), kFitted);
  parallel_for(context, hypotheses.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      Hypothesis& one = hypotheses[i];
      one.pose =
          fit_patches(wide, reference.wide, one.pose, {0.8 * reference.wide.width(), 6, true, kHeld}).pose;
      one.pose =
          fit_patches(middle, reference.middle, one.pose, {0.6 * reference.middle.width(), 8, true, kHeld})
              .pose;
      one.there = agreement_of(judged, one.pose, {reference.fine, reference.free}, tolerance);
      one.score = score_of(one.there, {}, kAgainstFitted);
    }
  });
  return hypotheses;
}

}  // namespace

Known::Known(const Context& context, Surfaces gathered)
    : surfaces(std::move(gathered)),
      narrow(context, surfaces, 1, kLeastPoints),
      fine(context, surfaces, 2, kLeastPoints),
      middle(context, surfaces, 4, kLeastPoints),
      wide(context, surfaces, 8, kLeastPoints),
      free(context, surfaces, fine) {}

void sort_by_score(std::vector<Hypothesis>& hypotheses) {
  std::stable_sort(hypotheses.begin(), hypotheses.end(),
                   [](const Hypothesis& a, const Hypothesis& b) { return a.score > b.score; });
}

double tolerance_of(const Known& cloud, const Known& reference) {
  return 0.15 * std::max(cloud.fine.width(), reference.fine.width());
}

bool is_same_place(const Pose& a, const Pose& b, const Known& cloud) {
  constexpr double kTurn = 0.03;  // rad
  const double apart = (a.translation - b.translation).norm();
  const Eigen::Matrix3d between = a.rotation.transpose() * b.rotation;
  return apart < 1.5 * cloud.fine.width() && Eigen::AngleAxisd(between).angle() < kTurn;
}

Jury::Jury(const Known& cloud, const Known& reference)
    : cloud_(cloud),
      reference_(reference),
      tolerance_(tolerance_of(cloud, reference)),
      there_(judged_patches(cloud.fine, kJudged)),
      back_(judged_patches(reference.fine, kJudged)),
      more_there_(judged_patches(cloud.fine, kCompared)),
      more_back_(judged_patches(reference.fine, kCompared)) {}

void Jury::judge(Hypothesis& one) const {
  one.there = agreement_of(there_, one.pose, {reference_.fine, reference_.free}, tolerance_);
  one.back = agreement_of(back_, inverse_of(one.pose), {cloud_.fine, cloud_.free}, tolerance_);
  one.score = score_of(one.there, one.back, kAgainst);
}

bool Jury::is_clearly_better(const Pose& pose, const Pose& rival, double sigmas) const {
  constexpr double kLeast = 100.0;      // patches
  constexpr double kLeastShare = 0.01;  // of these, that fit under one and not at all under the other
  Preference both = preference_of(more_there_, pose, rival, {reference_.fine, reference_.free}, tolerance_);
  both +=
      preference_of(more_back_, inverse_of(pose), inverse_of(rival), {cloud_.fine, cloud_.free}, tolerance_);
  return both.count >= kLeast && both.sum > kLeastShare * both.count && both.sigmas() > sigmas;
}

void Jury::put_best_first(std::vector<Hypothesis>& all) const {
  constexpr double kSigmas = 4.0, kSigmasOfRefuted = 1.5;
  std::size_t best = 0;
  for (std::size_t i = 1; i < all.size(); ++i) {
    const Hypothesis &one = all[i], &other = all[best];
    // What is better has less against it, too.
    if (one.there.all().same + one.back.all().same < Hypothesis::kLeastSame ||
        one.against_share() > other.against_share())
      continue;
    const bool by_less = other.is_refuted() && !one.is_refuted();
    if (is_clearly_better(one.pose, other.pose, by_less ? kSigmasOfRefuted : kSigmas)) best = i;
  }
  const auto begin = all.begin(), at = begin + static_cast<std::ptrdiff_t>(best);
  std::rotate(begin, at, at + 1);
}

std::vector<Hypothesis> rough_hypotheses(const Context& context, const Known& cloud, const Known& reference) {
  constexpr std::size_t kCandidates = 2500;
  const std::vector<Candidate> candidates =
      find_candidates(context, footprint_of(cloud.fine), footprint_of(reference.fine), kCandidates);
  std::vector<Hypothesis> hypotheses =
      roughly_fitted(context, cloud, reference, promising_of(context, cloud, reference, candidates));
  return distinct_of(hypotheses, cloud);
}

std::vector<Hypothesis> aside_of(const Context& context, const Pose& pose, const Known& cloud,
                                 const Known& reference) {
  constexpr double kFar = 2.5;   // widths
  constexpr double kTurn = 0.1;  // rad
  const double step = kFar * std::max(cloud.fine.width(), reference.fine.width());
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  for (const Patch& patch : cloud.wide.patches())
    centre += pose * patch.mean / static_cast<double>(cloud.wide.patches().size());
  std::vector<Hypothesis> aside;
  for (int i = 0; i < 8; ++i) {
    const double heading = 0.25 * std::numbers::pi * i;
    aside.push_back({pose, {}, {}, 0.0});
    aside.back().pose.translation += step * Eigen::Vector3d(std::cos(heading), std::sin(heading), 0.0);
  }
  for (const double turn : {-kTurn, kTurn}) {
    const Eigen::Matrix3d rotation = Eigen::AngleAxisd(turn, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    aside.push_back(
        {{rotation * pose.rotation, rotation * (pose.translation - centre) + centre}, {}, {}, 0.0});
  }
  const std::vector<Hypothesis> shifted = small_shifts(context, pose, cloud, reference);
  aside.insert(aside.end(), shifted.begin(), shifted.end());
  return aside;
}

std::vector<Hypothesis> fitted(const Context& context, const Known& cloud, const Known& reference,
                               const Jury& jury, std::vector<Hypothesis> hypotheses) {
  constexpr std::size_t kFitted = 1500, kPolished = 4000, kKept = 12;
  const std::vector<Patch> wide = some_of(cloud.wide.patches(), kFitted),
                           middle = some_of(cloud.middle.patches(), kFitted),
                           fine = some_of(cloud.fine.patches(), kFitted),
                           more = some_of(cloud.fine.patches(), kPolished);
  const auto fit = [](std::span<const Patch> patches, const PatchLevel& level, const FineRule& rule,
                      Hypothesis& one) { one.pose = fit_patches(patches, level, one.pose, rule).pose; };
  // Wide patches reach far, but may lead astray what is near already: both are tried.
  const std::size_t count = hypotheses.size();
  hypotheses.reserve(2 * count);
  for (std::size_t i = 0; i < count; ++i)
    hypotheses.push_back(hypotheses[i]);
  parallel_for(context, hypotheses.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      Hypothesis& one = hypotheses[i];
      if (i < count) {
        fit(wide, reference.wide, {0.6 * reference.wide.width(), 15, false, kHeld}, one);
        fit(middle, reference.middle, {0.5 * reference.middle.width(), 15, false, kHeld}, one);
      }
      fit(fine, reference.fine, {0.5 * reference.fine.width(), 15}, one);
    }
  });
  hypotheses = without_twins(hypotheses, cloud);
  parallel_for(context, hypotheses.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      jury.judge(hypotheses[i]);
  });
  sort_by_score(hypotheses);
  hypotheses.resize(std::min(hypotheses.size(), kKept));
  parallel_for(context, hypotheses.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      fit(more, reference.fine, {0.25 * reference.fine.width(), 15}, hypotheses[i]);
      jury.judge(hypotheses[i]);
    }
  });
  sort_by_score(hypotheses);
  return hypotheses;
}

}  // namespace ray::align
