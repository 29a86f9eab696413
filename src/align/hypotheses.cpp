#include "hypotheses.h"

#include "coarse.h"
#include "fine.h"
#include "rises.h"

#include <raycloud/exec/parallel.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

namespace ray::align {
namespace {

/// Of the largest information: wide patches of level ground and of foliage say little of shifts.
constexpr double kHeld = 0.02;
constexpr double kAgainstFitted = 10.0, kAgainstAtFirst = 4.0;  // weights, against surfaces that agree

/// What agrees, less what speaks against it, which weighs most: there are one or two in a hundred where
/// clouds lie as they should, and five where the two halves of a building that look the same lie on each
/// other. Level surfaces agree with any other of their height: upright ones tell.
double score_of(const Agreement& agreement, double against) {
  constexpr double kOther = 0.5, kOthers = 0.5;
  const auto of = [](const Agreement::Counts& counts) { return counts.same - kOther * counts.other; };
  return of(agreement.upright) + kOthers * of(agreement.others) - against * agreement.against;
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

Pose pose_of(const Candidate& candidate, double rise, const Verticals& verticals) {
  const Eigen::Matrix3d back = verticals.reference.transpose();
  return {back * Eigen::AngleAxisd(candidate.yaw, Eigen::Vector3d::UnitZ()) * verticals.cloud,
          back * Eigen::Vector3d(candidate.shift.x(), candidate.shift.y(), rise)};
}

std::vector<Patch> turned(std::vector<Patch> patches, const Eigen::Matrix3d& rotation) {
  for (Patch& patch : patches) {
    patch.mean = rotation * patch.mean;
    patch.normal = rotation * patch.normal;
    patch.along = rotation * patch.along;
  }
  return patches;
}

/// Of a grid of shifts around a pose, half a width apart, the best, no two next to each other.
std::vector<Hypothesis> small_shifts(const Context& context, const Pose& pose, double width,
                                     const Jury& jury) {
  constexpr int kSteps = 6;
  constexpr std::size_t kBest = 6;
  constexpr double kStep = 0.5, kApart = 0.8;  // widths
  std::vector<Hypothesis> shifted;
  for (int y = -kSteps; y <= kSteps; ++y)
    for (int x = -kSteps; x <= kSteps; ++x) {
      if (x == 0 && y == 0) continue;
      shifted.push_back({pose, {}, {}, 0.0});
      shifted.back().pose.translation += kStep * width * Eigen::Vector3d(x, y, 0.0);
    }
  parallel_for(context, shifted.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      shifted[i].score = jury.glance(shifted[i].pose);
  });
  sort_by_score(shifted);
  std::vector<Hypothesis> best;
  for (const Hypothesis& one : shifted)
    if (best.size() < kBest && std::none_of(best.begin(), best.end(), [&](const Hypothesis& other) {
          return (one.pose.translation - other.pose.translation).norm() < kApart * width;
        }))
      best.push_back(one);
  return best;
}

/// The best of all candidates at all heights, at a glance.
std::vector<Hypothesis> promising_of(const Context& context, const Known& cloud, const Known& reference,
                                     const Verticals& verticals) {
  constexpr std::size_t kCandidates = 2500;
  constexpr std::size_t kRises = 3, kGlanced = 150, kPromising = 200, kLevels = 1000;
  const std::vector<Patch> from = turned(cloud.fine.patches(), verticals.cloud),
                           onto = turned(reference.fine.patches(), verticals.reference);
  const std::vector<Candidate> candidates =
      find_candidates(context, footprint_of(from, cloud.fine.width()),
                      footprint_of(onto, reference.fine.width()), kCandidates);
  const LevelHeights heights(onto, reference.fine.width());
  const std::vector<Patch> levels = level_patches(from, kLevels);
  const std::vector<JudgedPatch> glanced = judged_patches(cloud.fine, kGlanced);
  const double tolerance = 2.0 * tolerance_of(cloud, reference);
  std::vector<std::vector<Hypothesis>> of_candidate(candidates.size());
  parallel_for(context, candidates.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      for (const double rise : heights.rises(levels, candidates[i], kRises)) {
        const Pose pose = pose_of(candidates[i], rise, verticals);
        const Agreement there = agreement_of(glanced, pose, {reference.fine, reference.free}, tolerance);
        of_candidate[i].push_back({pose, {}, {}, score_of(there, kAgainstAtFirst)});
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
      one.score = score_of(agreement_of(judged, one.pose, {reference.fine, reference.free}, tolerance),
                           kAgainstFitted);
    }
  });
  return hypotheses;
}

}  // namespace

void sort_by_score(std::vector<Hypothesis>& hypotheses) {
  std::stable_sort(hypotheses.begin(), hypotheses.end(),
                   [](const Hypothesis& a, const Hypothesis& b) { return a.score > b.score; });
}

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

std::vector<Hypothesis> rough_hypotheses(const Context& context, const Known& cloud, const Known& reference,
                                         const Verticals& verticals) {
  std::vector<Hypothesis> hypotheses =
      roughly_fitted(context, cloud, reference, promising_of(context, cloud, reference, verticals));
  return distinct_of(hypotheses, cloud);
}

std::vector<Hypothesis> aside_of(const Context& context, const Pose& pose, const Known& cloud,
                                 const Known& reference, const Jury& jury) {
  constexpr double kFar = 2.5;   // widths
  constexpr double kTurn = 0.1;  // rad
  const double width = std::max(cloud.fine.width(), reference.fine.width()), step = kFar * width;
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
  const std::vector<Hypothesis> shifted = small_shifts(context, pose, width, jury);
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
