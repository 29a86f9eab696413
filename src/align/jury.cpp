#include "jury.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

namespace ray::align {
namespace {

Pose inverse_of(const Pose& pose) {
  return {pose.rotation.transpose(), -(pose.rotation.transpose() * pose.translation)};
}

constexpr std::size_t kSightlines = 100'000;
constexpr double kCell = 4.0;  // patches

/// Cells of the size of things that move, where patches are wide.
Witnesses all_of(const PatchLevel& level) {
  constexpr double kMoves = 2.0;  // m
  return {level, level.patches().size(), std::clamp(kMoves, level.width(), kCell * level.width())};
}

/// By how many standard errors there is more of `what` in the cells of a pose than is usual under the best
/// one, in which there is `in_best` of it.
double sigmas_more(float Evidence::Cell::*what, double in_best, const Hypothesis& other,
                   const Hypothesis& best, double least_share) {
  const double known = best.there.known + best.back.known;
  const double usual = known > 0.0 ? in_best / known : 0.0;
  const auto excess = [&](const Evidence::Cell& cell) {
    return static_cast<double>(cell.*what) - usual * static_cast<double>(cell.known);
  };
  double sum = 0.0, squares = 0.0;
  const auto add = [&](const Evidence& a, const Evidence& b) {
    for (std::size_t i = 0; i < a.cells.size(); ++i) {
      const double difference = excess(a.cells[i]) - excess(b.cells[i]);
      sum += difference;
      squares += difference * difference;
    }
  };
  add(other.there, best.there);
  add(other.back, best.back);
  // Noise alone is significant where it is the same everywhere.
  return sum > least_share * known ? sum / std::sqrt(squares) : 0.0;
}

}  // namespace

Known::Known(const Context& context, Surfaces gathered)
    : surfaces(std::move(gathered)),
      narrow(context, surfaces, 1, kLeastPoints),
      fine(context, surfaces, 2, kLeastPoints),
      middle(context, surfaces, 4, kLeastPoints),
      wide(context, surfaces, 8, kLeastPoints),
      free(context, surfaces, fine),
      sightlines(sightlines_of(surfaces, kSightlines)) {}

double tolerance_of(const Known& cloud, const Known& reference) {
  return 0.15 * std::max(cloud.fine.width(), reference.fine.width());
}

bool is_same_place(const Pose& a, const Pose& b, const Known& cloud) {
  constexpr double kTurn = 0.03;  // rad
  const double apart = (a.translation - b.translation).norm();
  const Eigen::Matrix3d between = a.rotation.transpose() * b.rotation;
  return apart < 1.5 * cloud.fine.width() && Eigen::AngleAxisd(between).angle() < kTurn;
}

double Hypothesis::overlap() const {
  const auto share = [](const Agreement::Counts& counts) {
    const double all = counts.known() + counts.unknown;
    return all > 0.0 ? counts.same / all : 0.0;
  };
  return std::max(share(there.counts), share(back.counts));
}

bool Hypothesis::is_refuted_by_one_only(double nearly_none) const {
  constexpr double kMost = 0.2;
  constexpr double kAlike = 0.5;  // of what one side tells of, for the other to know as well
  const auto share = [](const Evidence& side) { return side.known > 0.0 ? side.refuted / side.known : 0.0; };
  const Evidence& less = share(there) < share(back) ? there : back;
  const Evidence& more = &less == &there ? back : there;
  return share(less) < nearly_none && share(more) < kMost && less.known > kAlike * more.known;
}

Jury::Jury(const Known& cloud, const Known& reference)
    : cloud_(cloud),
      reference_(reference),
      tolerance_(tolerance_of(cloud, reference)),
      there_(cloud.fine, kJudged, kCell * cloud.fine.width()),
      back_(reference.fine, kJudged, kCell * reference.fine.width()),
      few_there_(cloud.fine, kGlanced, kCell * cloud.fine.width()),
      few_back_(reference.fine, kGlanced, kCell * reference.fine.width()),
      narrow_there_(cloud.narrow, kJudged, kCell * cloud.narrow.width()),
      narrow_back_(reference.narrow, kJudged, kCell * reference.narrow.width()),
      all_there_(all_of(cloud.fine)),
      all_back_(all_of(reference.fine)) {}

void Jury::judge(Hypothesis& one) const {
  one.there = evidence_of(there_, one.pose, {reference_.fine, reference_.free}, tolerance_);
  one.back = evidence_of(back_, inverse_of(one.pose), {cloud_.fine, cloud_.free}, tolerance_);
  one.score = one.is_idle() ? std::numeric_limits<double>::lowest() : one.there.sum() + one.back.sum();
}

Hypothesis Jury::judged_closely(const Pose& pose) const {
  const double tolerance = 0.5 * tolerance_;
  return {pose, evidence_of(narrow_there_, pose, {reference_.narrow, reference_.free}, tolerance),
          evidence_of(narrow_back_, inverse_of(pose), {cloud_.narrow, cloud_.free}, tolerance), 0.0};
}

double Jury::sigmas_worse_closely(const Hypothesis& other, const Hypothesis& best) const {
  constexpr double kLeastShare = 0.005;
  return sigmas_worse(judged_closely(other.pose), judged_closely(best.pose), kLeastShare);
}

Hypothesis Jury::judged_by_rays(const Context& context, const Pose& pose) const {
  const Pose inverse = inverse_of(pose);
  return {pose,
          evidence_of(all_there_, pierced_patches(context, reference_.sightlines, inverse, cloud_.fine), pose,
                      reference_.fine, tolerance_),
          evidence_of(all_back_, pierced_patches(context, cloud_.sightlines, pose, reference_.fine), inverse,
                      cloud_.fine, tolerance_),
          0.0};
}

double Jury::sigmas_pierced(const Hypothesis& by_rays) const {
  constexpr double kUsual = 0.01, kGap = 0.8;  // m: wider patches have gaps, between cars, in fences
  const double usual = kUsual * std::max(1.0, reference_.fine.width() / kGap);
  double sum = 0.0, squares = 0.0;
  for (const Evidence* side : {&by_rays.there, &by_rays.back})
    for (const Evidence::Cell& cell : side->cells) {
      const double excess = static_cast<double>(cell.refuted) - usual * static_cast<double>(cell.known);
      sum += excess;
      squares += excess * excess;
    }
  return sum > 0.0 ? sum / std::sqrt(squares) : 0.0;
}

double Jury::glance(const Pose& pose) const {
  return evidence_of(few_there_, pose, {reference_.fine, reference_.free}, tolerance_).sum() +
         evidence_of(few_back_, inverse_of(pose), {cloud_.fine, cloud_.free}, tolerance_).sum();
}

double sigmas_worse(const Hypothesis& other, const Hypothesis& best, double least_share) {
  return sigmas_more(&Evidence::Cell::against, best.there.against + best.back.against, other, best,
                     least_share);
}

double sigmas_more_refuted(const Hypothesis& other, const Hypothesis& best) {
  constexpr double kLeastShare = 0.01;
  return sigmas_more(&Evidence::Cell::refuted, best.there.refuted + best.back.refuted, other, best,
                     kLeastShare);
}

}  // namespace ray::align
