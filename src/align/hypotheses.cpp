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
constexpr double kEmpty = 20.0, kEmptyAtFirst = 4.0;  // weights, against surfaces that agree

/// What agrees, less what does not. A surface in space that was seen to be empty weighs most: there are one
/// in a hundred where clouds lie as they should, moving things included, but one in fifteen where the two
/// halves of a building that look the same lie on each other. Level surfaces agree with any other of their
/// height: upright ones tell.
double score_of(const Agreement& there, const Agreement& back, double empty) {
  constexpr double kOthers = 0.5;
  const auto of = [empty](const Agreement::Counts& counts) {
    return counts.same - empty * counts.empty - 0.5 * counts.other;
  };
  return of(there.upright) + of(back.upright) + kOthers * (of(there.others) + of(back.others));
}

void sort_by_score(std::vector<Hypothesis>& hypotheses) {
  std::stable_sort(hypotheses.begin(), hypotheses.end(),
                   [](const Hypothesis& a, const Hypothesis& b) { return a.score > b.score; });
}

Pose inverse_of(const Pose& pose) {
  return {pose.rotation.transpose(), -(pose.rotation.transpose() * pose.translation)};
}

Pose pose_of(const Candidate& candidate, double rise) {
  return {Eigen::AngleAxisd(candidate.yaw, Eigen::Vector3d::UnitZ()).toRotationMatrix(),
          {candidate.shift.x(), candidate.shift.y(), rise}};
}

}  // namespace

Known::Known(const Context& context, Surfaces gathered)
    : surfaces(std::move(gathered)),
      narrow(context, surfaces, 1, kLeastPoints),
      fine(context, surfaces, 2, kLeastPoints),
      middle(context, surfaces, 4, kLeastPoints),
      wide(context, surfaces, 8, kLeastPoints),
      free(context, fine, surfaces.sky) {}

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
  constexpr std::size_t kCandidates = 64, kRises = 3, kFitted = 500, kJudged = 800;
  const std::vector<Candidate> candidates =
      find_candidates(context, footprint_of(cloud.fine), footprint_of(reference.fine), kCandidates);
  const LevelHeights heights(reference.fine);
  const std::vector<Patch> levels = level_patches(cloud.fine, 2000);
  std::vector<Hypothesis> hypotheses;
  for (const Candidate& candidate : candidates)
    for (const double rise : heights.rises(levels, candidate, kRises))
      hypotheses.push_back({pose_of(candidate, rise), {}, {}, 0.0});

  const std::vector<Patch> wide = some_of(cloud.wide.patches(), kFitted),
                           middle = some_of(cloud.middle.patches(), kFitted),
                           fine = some_of(cloud.fine.patches(), kJudged);
  const double tolerance = tolerance_of(cloud, reference);
  const Observed other{reference.fine, reference.free};
  parallel_for(context, hypotheses.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      Pose& pose = hypotheses[i].pose;
      pose = fit_patches(wide, reference.wide, pose, {0.8 * reference.wide.width(), 6, true}).pose;
      pose = fit_patches(middle, reference.middle, pose, {0.6 * reference.middle.width(), 8, true}).pose;
      hypotheses[i].there = agreement_of(fine, pose, other, 2.0 * tolerance);
      hypotheses[i].score = score_of(hypotheses[i].there, {}, kEmptyAtFirst);
    }
  });
  sort_by_score(hypotheses);
  return hypotheses;
}

std::vector<Hypothesis> aside_of(const Pose& pose, const Known& cloud, const Known& reference) {
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
  return aside;
}

std::vector<Hypothesis> fitted(const Context& context, const Known& cloud, const Known& reference,
                               const std::vector<Hypothesis>& from) {
  constexpr std::size_t kFitted = 3000, kJudged = 3000;
  const std::vector<Patch> wide = some_of(cloud.wide.patches(), kFitted),
                           middle = some_of(cloud.middle.patches(), kFitted),
                           fine = some_of(cloud.fine.patches(), kFitted),
                           judged = some_of(cloud.fine.patches(), kJudged),
                           judged_back = some_of(reference.fine.patches(), kJudged);
  const double tolerance = tolerance_of(cloud, reference);
  std::vector<Hypothesis> hypotheses = from;
  parallel_for(context, hypotheses.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      Hypothesis& one = hypotheses[i];
      one.pose = fit_patches(wide, reference.wide, one.pose, {0.6 * reference.wide.width(), 15, false}).pose;
      one.pose =
          fit_patches(middle, reference.middle, one.pose, {0.5 * reference.middle.width(), 15, false}).pose;
      one.pose = fit_patches(fine, reference.fine, one.pose, {0.5 * reference.fine.width(), 15, false}).pose;
      one.there = agreement_of(judged, one.pose, {reference.fine, reference.free}, tolerance);
      one.back = agreement_of(judged_back, inverse_of(one.pose), {cloud.fine, cloud.free}, tolerance);
      one.score = score_of(one.there, one.back, kEmpty);
    }
  });
  sort_by_score(hypotheses);
  std::vector<Hypothesis> distinct;
  for (Hypothesis& one : hypotheses)
    if (std::none_of(distinct.begin(), distinct.end(),
                     [&](const Hypothesis& other) { return is_same_place(one.pose, other.pose, cloud); }))
      distinct.push_back(std::move(one));
  return distinct;
}

}  // namespace ray::align
