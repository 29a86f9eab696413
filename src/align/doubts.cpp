#include "doubts.h"

#include "hypotheses.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <iterator>

namespace ray::align {
namespace {

/// So near each other (a few metres) that narrow patches tell which is right, if anything does.
bool is_near(const Pose& a, const Pose& b, const Known& cloud) {
  constexpr double kFar = 6.0;     // widths
  constexpr double kTurned = 0.1;  // rad
  return (a.translation - b.translation).norm() < kFar * cloud.fine.width() &&
         Eigen::AngleAxisd(Eigen::Matrix3d(a.rotation.transpose() * b.rotation)).angle() < kTurned;
}

/// The best pose, judged by patches and by rays.
struct Best {
  Hypothesis by_patches, by_rays;
};

/// Where no ray goes through a clean surface, what free space refutes in one cloud is leaves and the like,
/// and in the other no more than what edges come to.
bool is_refuted(const Best& best) {
  constexpr double kNearlyNone = 0.005, kEdges = 0.03, kLeastKnown = 50.0;  // of space; cells
  const Hypothesis& by_rays = best.by_rays;
  const bool pierces_none =
      by_rays.there.known + by_rays.back.known > kLeastKnown && by_rays.refuted_share() < kNearlyNone;
  return best.by_patches.is_refuted() && !(pierces_none && best.by_patches.is_refuted_by_one_only(kEdges));
}

/// What patches say clearly of two poses. Where little is in both, much of what speaks against a pose is
/// edges, and apart: far away, what is refuted must tell, too, or narrow patches beyond doubt: of sparse
/// scans wide ones fit nearly anywhere.
bool is_worse(const Case& of, const Hypothesis& other, const Hypothesis& best) {
  constexpr double kSigmas = 2.0, kSigmasFar = 3.0;
  const bool near = is_near(other.pose, best.pose, of.cloud), is_less = sigmas_worse(other, best) >= kSigmas;
  if (is_less && (near || sigmas_more_refuted(other, best) >= kSigmas)) return true;
  return of.jury.sigmas_worse_closely(other, best) >= (near ? kSigmas : kSigmasFar);
}

/// What rays say of two poses: near each other they tell of the same surfaces.
bool is_worse_by_rays(const Case& of, const Hypothesis& other, const Best& best) {
  constexpr double kSigmas = 2.0;
  return is_near(other.pose, best.by_patches.pose, of.cloud) &&
         sigmas_worse(of.jury.judged_by_rays(of.context, other.pose), best.by_rays, 0.0) >= kSigmas;
}

/// The score from which on another pose may be as good as the best.
double least_of_rivals(const Hypothesis& best) {
  constexpr double kLess = 0.5;        // of the score of the best
  constexpr double kLessKnown = 0.03;  // or of what is known of it
  return best.score -
         std::max(kLess * std::abs(best.score), kLessKnown * (best.there.known + best.back.known));
}

/// All that are as good elsewhere, each once. Only where the finest fit rests is a rival: on the way there,
/// what fits less may not show yet.
std::vector<Hypothesis> rivals_of(const Case& of, const std::vector<Hypothesis>& judged,
                                  const Best& judged_best) {
  const Hypothesis& best = judged_best.by_patches;
  const double least = least_of_rivals(best);
  const auto is_rival = [&](const Hypothesis& other) {
    return is_elsewhere(other.pose, best.pose, of.cloud) && !other.is_idle() && other.score > least &&
           !is_worse(of, other, best);
  };
  std::vector<Hypothesis> maybe, rivals;
  std::copy_if(judged.begin(), judged.end(), std::back_inserter(maybe), is_rival);
  for (const Hypothesis& one : without_twins(maybe, of.cloud)) {
    const Rest rest = settled(of, one);
    // What nothing holds nearby is on the way to the best.
    const bool is_on_the_way = is_near(rest.place.pose, best.pose, of.cloud) && is_loose(rest.fit, of.cloud);
    if (is_rival(rest.place) && !is_on_the_way && !is_worse_by_rays(of, rest.place, judged_best))
      rivals.push_back(rest.place);
  }
  return without_twins(rivals, of.cloud);
}

}  // namespace

std::string percent(double share_of_one) {
  return std::to_string(std::lround(100.0 * share_of_one)) + " %";
}

Hypothesis best_of(const Case& of, const std::vector<Hypothesis>& judged) {
  constexpr double kSigmas = 3.0;
  Hypothesis best = judged.front();
  if (best.is_idle()) return best;
  const double least = least_of_rivals(best);
  for (const Hypothesis& other : without_twins(judged, of.cloud))
    if (!other.is_idle() && other.score > least && is_elsewhere(other.pose, best.pose, of.cloud) &&
        of.jury.sigmas_worse_closely(best, other) >= kSigmas)
      best = other;
  return best;
}

Doubt doubt_of(const Case& of, const std::vector<Hypothesis>& judged, const Hypothesis& best) {
  constexpr double kSigmasPierced = 2.0;  // right poses: up to 1.6, of thin scans of a wood
  const std::string found = "the best overlap found is " + percent(best.overlap());
  if (best.is_idle()) return {"too few surfaces are in both: " + found};
  const Best judged_best{best, of.jury.judged_by_rays(of.context, best.pose)};
  if (is_refuted(judged_best))
    return {percent(best.refuted_share()) +
            " of the surfaces would be where the other cloud has seen that there are none: " + found};
  if (of.jury.sigmas_pierced(judged_best.by_rays) >= kSigmasPierced)
    return {"rays of one cloud would go through " + percent(judged_best.by_rays.refuted_share()) +
            " of the surfaces of the other: " + found};
  const std::vector<Hypothesis> rivals = rivals_of(of, judged, judged_best);
  if (rivals.empty()) return {};
  return {"it fits nearly as well elsewhere: " + found,
          std::any_of(rivals.begin(), rivals.end(), [&](const Hypothesis& other) {
            return !is_same_place(other.pose, best.pose, of.cloud);
          })};
}

bool agrees_too_little(const Hypothesis& best, double agreement) {
  constexpr double kLeast = 0.86;
  const double cells = best.there.known + best.back.known;
  return agreement - std::sqrt(agreement * (1.0 - agreement) / cells) < kLeast;
}

}  // namespace ray::align
