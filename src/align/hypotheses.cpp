#include "hypotheses.h"

#include "coarse.h"
#include "rises.h"

#include <raycloud/exec/parallel.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace ray::align {
namespace {

constexpr double kLeastPoints = 5.0;
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

void sort_by_score(std::vector<Hypothesis>& hypotheses) {
  std::stable_sort(hypotheses.begin(), hypotheses.end(),
                   [](const Hypothesis& a, const Hypothesis& b) { return a.score > b.score; });
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

}  // namespace

Known::Known(const Context& context, Surfaces gathered)
    : surfaces(std::move(gathered)),
      narrow(context, surfaces, 1, kLeastPoints),
      fine(context, surfaces, 2, kLeastPoints),
      middle(context, surfaces, 4, kLeastPoints),
      wide(context, surfaces, 8, kLeastPoints),
      free(context, surfaces, fine) {}

double tolerance_of(const Known& cloud, const Known& reference) {
  return 0.15 * std::max(cloud.fine.width(), reference.fine.width());
}

bool is_same_place(const Pose& a, const Pose& b, const Known& cloud) {
  constexpr double kTurn = 0.03;  // rad
  const double apart = (a.translation - b.translation).norm();
  const Eigen::Matrix3d between = a.rotation.transpose() * b.rotation;
  return apart < 1.5 * cloud.fine.width() && Eigen::AngleAxisd(between).angle() < kTurn;
}

std::vector<Hypothesis> rough_hypotheses(const Context& context, const Known& cloud, const Known& reference) {
  constexpr std::size_t kCandidates = 2500, kRises = 3, kGlanced = 150, kPromising = 200, kFitted = 500,
                        kJudged = 800;
  const std::vector<Candidate> candidates =
      find_candidates(context, footprint_of(cloud.fine), footprint_of(reference.fine), kCandidates);
  const LevelHeights heights(reference.fine);
  const std::vector<Patch> levels = level_patches(cloud.fine, 1000);
  const std::vector<JudgedPatch> glanced = judged_patches(cloud.fine, kGlanced),
                                 fine = judged_patches(cloud.fine, kJudged);
  const double tolerance = 2.0 * tolerance_of(cloud, reference);
  const Observed other{reference.fine, reference.free};
  std::vector<std::vector<Hypothesis>> of_candidate(candidates.size());
  parallel_for(context, candidates.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      for (const double rise : heights.rises(levels, candidates[i], kRises)) {
        const Pose pose = pose_of(candidates[i], rise);
        const Agreement there = agreement_of(glanced, pose, other, tolerance);
        of_candidate[i].push_back({pose, there, {}, score_of(there, {}, kAgainstAtFirst)});
      }
  });
  std::vector<Hypothesis> hypotheses;
  for (const std::vector<Hypothesis>& some : of_candidate)
    hypotheses.insert(hypotheses.end(), some.begin(), some.end());
  sort_by_score(hypotheses);
  hypotheses.resize(std::min(hypotheses.size(), kPromising));

  const std::vector<Patch> wide = some_of(cloud.wide.patches(), kFitted),
                           middle = some_of(cloud.middle.patches(), kFitted);
  parallel_for(context, hypotheses.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      Pose& pose = hypotheses[i].pose;
      pose = fit_patches(wide, reference.wide, pose, {0.8 * reference.wide.width(), 6, true}).pose;
      pose = fit_patches(middle, reference.middle, pose, {0.6 * reference.middle.width(), 8, true}).pose;
      hypotheses[i].there = agreement_of(fine, pose, other, tolerance);
      hypotheses[i].score = score_of(hypotheses[i].there, {}, kAgainstFitted);
    }
  });
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
                               std::vector<Hypothesis> hypotheses) {
  constexpr std::size_t kFitted = 3000, kJudged = 3000;
  const std::vector<Patch> wide = some_of(cloud.wide.patches(), kFitted),
                           middle = some_of(cloud.middle.patches(), kFitted),
                           fine = some_of(cloud.fine.patches(), kFitted);
  const std::vector<JudgedPatch> judged = judged_patches(cloud.fine, kJudged),
                                 judged_back = judged_patches(reference.fine, kJudged);
  const double tolerance = tolerance_of(cloud, reference);
  parallel_for(context, hypotheses.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      Hypothesis& one = hypotheses[i];
      one.pose = fit_patches(wide, reference.wide, one.pose, {0.6 * reference.wide.width(), 15, false}).pose;
      one.pose =
          fit_patches(middle, reference.middle, one.pose, {0.5 * reference.middle.width(), 15, false}).pose;
      one.pose = fit_patches(fine, reference.fine, one.pose, {0.5 * reference.fine.width(), 15, false}).pose;
      one.there = agreement_of(judged, one.pose, {reference.fine, reference.free}, tolerance);
      one.back = agreement_of(judged_back, inverse_of(one.pose), {cloud.fine, cloud.free}, tolerance);
      one.score = score_of(one.there, one.back, kAgainst);
    }
  });
  sort_by_score(hypotheses);
  return hypotheses;
}

}  // namespace ray::align
