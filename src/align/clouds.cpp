#include "bend_fit.h"
#include "bent_source.h"
#include "fine.h"
#include "ground.h"
#include "hypotheses.h"

#include <raycloud/align/clouds.h>
#include <raycloud/core/error.h>
#include <raycloud/spatial/symmetric_eigen.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <string>

namespace ray {
namespace {

using namespace align;

Known known_of(const Context& context, RaySource& source, const Survey& survey, double width) {
  Known known(context, gather_surfaces(context, source, survey, width));
  known.surfaces.gathered = {};  // patches tell what is in them
  return known;
}

void require_surfaces(const Survey& survey, const char* which) {
  if (survey.bounded == 0)
    throw Error(ErrorCode::no_data, std::string(which) + " has no bounded ray, so there is nothing to align");
  if (!(survey.spacing > 0.0))
    throw Error(ErrorCode::no_data, std::string(which) + " has too few points to align");
}

/// In metres, of where things come to lie, from that in the frames of the origins.
Pose in_world(const Pose& pose, const Known& cloud, const Known& reference) {
  return {pose.rotation,
          pose.translation + reference.surfaces.survey.origin - pose.rotation * cloud.surfaces.survey.origin};
}

double share(double part, double whole) {
  return whole > 0.0 ? part / whole : 0.0;
}

std::string percent(double share_of_one) {
  return std::to_string(std::lround(100.0 * share_of_one)) + " %";
}

/// Patches of one wall share what is wrong with it: so many tell as much as one that is independent.
constexpr double kTogether = 10.0;

/// The covariance of turns and shifts: the residuals stand for noise.
Matrix6 covariance_of(const FineFit& fit) {
  const Eigen::SelfAdjointEigenSolver<Matrix6> solver(fit.information);
  const Vector6 values = solver.eigenvalues().cwiseMax(1e-12 * solver.eigenvalues().maxCoeff() + 1e-300);
  return kTogether * fit.variance * solver.eigenvectors() * values.cwiseInverse().asDiagonal() *
         solver.eigenvectors().transpose();
}

/// With all patches; narrow ones too, where these are wide enough for noise not to make them round.
FineFit last_fit(const Context& context, const Known& cloud, const Known& reference, const Pose& start) {
  constexpr double kWideEnough = 0.25;  // m
  constexpr double kShare = 0.5;        // of the patches, for the narrow ones to count
  constexpr double kGate = 0.25;        // widths
  const FineFit fit =
      fit_patches(context, cloud.fine.patches(), reference.fine, start, {kGate * reference.fine.width(), 20});
  if (reference.narrow.width() < kWideEnough) return fit;
  const FineFit narrow = fit_patches(context, cloud.narrow.patches(), reference.narrow, fit.pose,
                                     {kGate * reference.narrow.width(), 20});
  return narrow.count < kShare * fit.count ? fit : narrow;
}

/// Whether two poses put the cloud to different places, if only a quarter of a patch apart.
bool is_elsewhere(const Pose& a, const Pose& b, const Known& cloud) {
  constexpr double kApart = 0.25;  // widths
  return (a.translation - b.translation).norm() > kApart * cloud.fine.width() || !is_same_place(a, b, cloud);
}

/// Of few patches each counts, and what is wrong with it: of a sparse scan of rings a wide one is seldom a
/// plane. Ones half as wide take their place where as many find another.
FineFit narrower_fit(const Context& context, RaySource& cloud_source, RaySource& reference_source,
                     const Known& cloud, const Known& reference, const FineFit& fit) {
  constexpr double kFew = 2000.0, kGate = 0.25;
  if (fit.count >= kFew) return fit;
  const auto level_of = [&](RaySource& source, const Known& known) {
    return PatchLevel(context,
                      gather_surfaces(context, source, known.surfaces.survey, 0.5 * known.surfaces.width), 1,
                      Known::kLeastPoints);
  };
  const PatchLevel from = level_of(cloud_source, cloud), onto = level_of(reference_source, reference);
  const FineFit narrower = fit_patches(context, from.patches(), onto, fit.pose, {kGate * onto.width(), 20});
  // Noise makes some of them round, and what is left may hold less: nobody judges where that slides to.
  return narrower.count < fit.count || is_elsewhere(narrower.pose, fit.pose, cloud) ? fit : narrower;
}

/// Adds what comes of the poses beside one to others, the best first.
void add_aside(const Context& context, const Known& cloud, const Known& reference, const Jury& jury,
               const Pose& pose, std::vector<Hypothesis>& all) {
  const std::vector<Hypothesis> aside =
      fitted(context, cloud, reference, jury, aside_of(context, pose, cloud, reference, jury));
  all.insert(all.end(), aside.begin(), aside.end());
  sort_by_score(all);
}

/// The turn about a horizontal axis that brings `up` upright.
Eigen::Matrix3d upright(const Eigen::Vector3d& up) {
  return Eigen::Quaterniond::FromTwoVectors(up, Eigen::Vector3d::UnitZ()).toRotationMatrix();
}

/// The rotation that levels the floors of a cloud, if there are any.
Eigen::Matrix3d level_by_floors(const Known& known) {
  constexpr double kMostTilt = 0.3;  // rad
  return levelling(floor_patches(known.fine, kMostTilt)).value_or(Eigen::Matrix3d::Identity());
}

/// The best `kKept` of a search with these verticals, fitted.
std::vector<Hypothesis> search(const Context& context, const Known& cloud, const Known& reference,
                               const Jury& jury, const Verticals& verticals) {
  constexpr std::size_t kKept = 24;
  std::vector<Hypothesis> found = rough_hypotheses(context, cloud, reference, verticals);
  found.resize(std::min(found.size(), kKept));
  return fitted(context, cloud, reference, jury, std::move(found));
}

/// Whether a pose brings one vertical onto the other.
bool fits_verticals(const Pose& pose, const Verticals& verticals) {
  constexpr double kTilt = 0.02;  // rad
  const Eigen::Vector3d up = pose.rotation * verticals.cloud.transpose() * Eigen::Vector3d::UnitZ();
  return up.dot(verticals.reference.transpose() * Eigen::Vector3d::UnitZ()) > std::cos(kTilt);
}

/// Whether a search with the ones finds what one with the others does.
bool are_alike(const Verticals& a, const Verticals& b) {
  constexpr double kTilt = 0.1;  // rad
  const auto is_like = [](const Eigen::Matrix3d& one, const Eigen::Matrix3d& other) {
    return one.row(2).dot(other.row(2)) > std::cos(kTilt);  // what comes to be up
  };
  return is_like(a.cloud, b.cloud) && is_like(a.reference, b.reference);
}

/// What may be upright in either cloud, together.
std::vector<Verticals> maybe_askew(const Known& cloud, const Known& reference) {
  constexpr std::size_t kMost = 2;
  std::vector<Verticals> askew;
  for (const Eigen::Vector3d& up : maybe_up(cloud.fine, kMost))
    for (const Eigen::Vector3d& reference_up : maybe_up(reference.fine, kMost))
      askew.push_back({upright(up), upright(reference_up)});
  return askew;
}

/// The search turns the cloud about the vertical, and so finds little if one of the clouds is tilted. Where
/// what it found is tilted or refuted, it is made again with the floors of both level, and then as the best
/// tilts them.
void search_tilted(const Context& context, const Known& cloud, const Known& reference, const Jury& jury,
                   std::vector<Hypothesis>& all) {
  std::vector<Verticals> searched{Verticals()};
  const auto is_searched = [&](const Pose& pose) {
    return std::any_of(searched.begin(), searched.end(),
                       [&](const Verticals& one) { return fits_verticals(pose, one); });
  };
  const auto is_found = [&] {
    const Hypothesis& best = all.front();
    return !best.is_idle() && !best.is_refuted() && is_searched(best.pose);
  };
  // A right pose nearly always has more that speaks for it than against.
  const auto is_clear = [&] { return is_found() && all.front().score > 0.0; };
  const auto add = [&](const Verticals& verticals) {
    const std::vector<Hypothesis> more = search(context, cloud, reference, jury, verticals);
    all.insert(all.end(), more.begin(), more.end());
    sort_by_score(all);
    searched.push_back(verticals);
  };
  if (is_clear()) return;
  const Verticals floors{level_by_floors(cloud), level_by_floors(reference)}, none;
  const auto is_upright = [&](const Eigen::Matrix3d& rotation) {
    return fits_verticals({rotation, {}}, none);
  };
  if (!is_upright(floors.cloud) || !is_upright(floors.reference)) add(floors);
  if (!is_found() && !is_searched(all.front().pose))
    add({upright(all.front().pose.rotation.transpose() * Eigen::Vector3d::UnitZ()), none.reference});
  for (const Verticals& askew : maybe_askew(cloud, reference))
    if (!is_clear() && std::none_of(searched.begin(), searched.end(),
                                    [&](const Verticals& one) { return are_alike(askew, one); }))
      add(askew);
}

/// Hypotheses, the best first. What slides along walls is fitted to many places: so those beside the best few
/// are looked for too, and those beside the best of all until there is no better.
std::vector<Hypothesis> judge(const Context& context, const Known& cloud, const Known& reference,
                              const Jury& jury, bool local) {
  constexpr std::size_t kBeside = 3;
  constexpr int kRounds = 3;
  constexpr double kFarBelow = 20.0;  // cells
  std::vector<Hypothesis> all;
  if (!local) all = search(context, cloud, reference, jury, Verticals());
  const Eigen::Vector3d as_they_are = cloud.surfaces.survey.origin - reference.surfaces.survey.origin;
  const std::vector<Hypothesis> here =
      fitted(context, cloud, reference, jury, {{{Eigen::Matrix3d::Identity(), as_they_are}, {}, {}, 0.0}});
  all.insert(all.end(), here.begin(), here.end());
  sort_by_score(all);
  if (!local) search_tilted(context, cloud, reference, jury, all);
  std::vector<Pose> looked;
  const auto is_looked = [&](const Hypothesis& one) {
    return std::any_of(looked.begin(), looked.end(),
                       [&](const Pose& pose) { return is_same_place(one.pose, pose, cloud); });
  };
  const std::vector<Hypothesis> first = all;
  for (const Hypothesis& one : first)
    if (looked.size() < kBeside && !one.is_idle() && !is_looked(one) &&
        one.score > all.front().score - kFarBelow) {
      looked.push_back(one.pose);
      add_aside(context, cloud, reference, jury, one.pose, all);
    }
  for (int round = 0; round < kRounds && !is_looked(all.front()); ++round) {
    looked.push_back(all.front().pose);
    add_aside(context, cloud, reference, jury, looked.back(), all);
  }
  return all;
}

/// Why the best is not to be trusted; empty if it is.
struct Doubt {
  std::string text;
  bool is_elsewhere = false;  ///< another place is as good
};

/// So near each other (a few metres) that narrow patches tell which is right, if anything does.
bool is_near(const Pose& a, const Pose& b, const Known& cloud) {
  constexpr double kFar = 6.0;   // widths
  constexpr double kTurn = 0.1;  // rad
  return (a.translation - b.translation).norm() < kFar * cloud.fine.width() &&
         Eigen::AngleAxisd(Eigen::Matrix3d(a.rotation.transpose() * b.rotation)).angle() < kTurn;
}

Eigen::Matrix3d shift_covariance(const FineFit& fit) {
  return covariance_of(fit).bottomRightCorner<3, 3>();
}

/// The patches leave some way open, by two standard errors, to shift the cloud elsewhere.
bool is_loose(const FineFit& fit, const Known& cloud) {
  constexpr double kSigmas = 2.0, kApart = 0.25;  // of a width, as elsewhere
  return !(kSigmas * std::sqrt(symmetric_eigen(shift_covariance(fit)).values[2]) <
           kApart * cloud.fine.width());
}

/// What is asked of the hypotheses: the clouds, and the jury that judged them.
struct Case {
  const Context& context;
  const Known& cloud;
  const Known& reference;
  const Jury& jury;
};

/// Where the last fit rests.
struct Rest {
  Hypothesis place;
  FineFit fit;
};

/// From a hypothesis: it may creep, and then is fitted again.
Rest settled(const Case& of, const Hypothesis& hypothesis) {
  constexpr int kMostFits = 3;
  Rest rest{{hypothesis.pose, {}, {}, 0.0}, {}};
  for (int i = 0; i < kMostFits; ++i) {
    const Pose before = rest.place.pose;
    rest.fit = last_fit(of.context, of.cloud, of.reference, before);
    rest.place.pose = rest.fit.pose;
    if (!is_elsewhere(rest.place.pose, before, of.cloud)) break;
  }
  of.jury.judge(rest.place);
  return rest;
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

/// The one with the best score, unless narrow patches are clearly for another that scores nearly as much.
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

/// By more than a standard error, if cells are independent of each other. Of right poses 89 % and more of the
/// patches agree, where leaves, people and vehicles have come and gone.
bool agrees_too_little(const Hypothesis& best, double agreement) {
  constexpr double kLeast = 0.86;
  const double cells = best.there.known + best.back.known;
  return agreement - std::sqrt(agreement * (1.0 - agreement) / cells) < kLeast;
}

/// An alignment, and its pose from the origin of one cloud to that of the other.
struct Placed {
  CloudAlignment alignment;
  FineFit fit;
  bool is_elsewhere = false;
};

void tell_fit(const FineFit& fit, const Known& cloud, const Known& reference, CloudAlignment& alignment) {
  alignment.pose = in_world(fit.pose, cloud, reference);
  alignment.rmse = fit.rmse;
  alignment.patches = fit.count;
  alignment.covariance = covariance_of(fit);
  alignment.centre = fit.centre + reference.surfaces.survey.origin;
}

/// Where nothing holds the best along some way, the places on that way: one of them may be held, which the
/// fits before slid past. They are judged, too.
void look_along(const Case& of, std::vector<Hypothesis>& judged, Rest& best) {
  constexpr int kSteps = 8;
  constexpr double kStep = 0.25;  // widths, which is how far the last fit reaches
  if (best.place.is_idle() || !is_loose(best.fit, of.cloud)) return;
  const Eigen::Vector3d way = symmetric_eigen(shift_covariance(best.fit)).vectors.col(2);
  const Pose from = best.fit.pose;
  for (int i = -kSteps; i <= kSteps; ++i) {
    if (i == 0) continue;
    Hypothesis aside{from, {}, {}, 0.0};
    aside.pose.translation += i * kStep * of.cloud.fine.width() * way;
    const Rest rest = settled(of, aside);
    judged.push_back(rest.place);
    if (rest.place.score > best.place.score && !is_loose(rest.fit, of.cloud)) best = rest;
  }
  sort_by_score(judged);
}

Placed place(const Context& context, const Known& cloud, const Known& reference, bool local) {
  const Jury jury(cloud, reference);
  const Case of{context, cloud, reference, jury};
  std::vector<Hypothesis> judged = judge(context, cloud, reference, jury, local);
  Rest rest{best_of(of, judged), {}};
  rest.fit = last_fit(context, cloud, reference, rest.place.pose);
  // Where the last fit leaves the place that the ones before it found, it must rest in the other.
  bool is_held = true;
  if (is_elsewhere(rest.fit.pose, rest.place.pose, cloud)) {
    Hypothesis moved{rest.fit.pose, {}, {}, 0.0};
    const FineFit again = last_fit(context, cloud, reference, moved.pose);
    is_held = !is_elsewhere(again.pose, moved.pose, cloud);
    jury.judge(moved);
    if (is_held) rest = {moved, again};
  }
  if (is_held) look_along(of, judged, rest);
  const Hypothesis& best = rest.place;
  Placed placed;
  placed.fit = rest.fit;
  CloudAlignment& alignment = placed.alignment;
  tell_fit(placed.fit, cloud, reference, alignment);
  const Agreement::Counts &there = best.there.counts, &back = best.back.counts;
  alignment.overlap = share(there.same, there.known() + there.unknown);
  alignment.reference_overlap = share(back.same, back.known() + back.unknown);
  alignment.agreement = share(there.same + back.same, there.known() + back.known());
  Doubt doubt = doubt_of(of, judged, best);
  if (doubt.text.empty() && agrees_too_little(best, alignment.agreement))
    doubt.text = "only " + percent(alignment.agreement) +
                 " of what both clouds have seen agrees: the best overlap found is " +
                 percent(best.overlap());
  if (doubt.text.empty() && (!is_held || is_loose(placed.fit, cloud)))
    doubt.text = "nothing holds it where it fits best: the best overlap found is " + percent(best.overlap());
  alignment.doubt = doubt.text;
  placed.is_elsewhere = doubt.is_elsewhere;
  return placed;
}

/// The same as for a rigid one, of the cloud as it is after the bend: from there, so nearly nothing moves.
CloudAlignment judge_bent(const Context& context, const BendFit& fit, RaySource& source, const Known& cloud,
                          const Known& reference) {
  const Pose pose = in_world(fit.pose, cloud, reference);
  Bend bend = fit.bend;
  bend.centre += reference.surfaces.survey.origin.head<2>();
  BentSource bent(source, pose, bend);
  const Known as_bent = known_of(context, bent, survey_ends(context, bent), cloud.surfaces.width);
  CloudAlignment alignment = place(context, as_bent, reference, true).alignment;
  alignment.pose = pose;
  alignment.bend = bend;
  alignment.bend_gain = fit.gain;
  alignment.rmse = fit.rmse;
  alignment.patches = fit.count;
  alignment.bend_size = fit.size;
  return alignment;
}

}  // namespace

CloudAlignment align_clouds(const Context& context, RaySource& cloud_source, RaySource& reference_source,
                            const AlignRule& rule) {
  const Survey of_cloud = survey_ends(context, cloud_source),
               of_reference = survey_ends(context, reference_source);
  require_surfaces(of_cloud, "the cloud");
  require_surfaces(of_reference, "the reference");
  const double width = std::max(patch_width(of_cloud), patch_width(of_reference));
  const Known cloud = known_of(context, cloud_source, of_cloud, width),
              reference = known_of(context, reference_source, of_reference, width);
  Placed placed = place(context, cloud, reference, rule.local);
  placed.fit = narrower_fit(context, cloud_source, reference_source, cloud, reference, placed.fit);
  tell_fit(placed.fit, cloud, reference, placed.alignment);
  CloudAlignment alignment = placed.alignment;
  // Where another place is as good, a bend does not tell which; but what is bent may fit here and there
  // alike, and is judged anew.
  if (rule.nonrigid && (rule.local || !placed.is_elsewhere)) {
    const BendFit fit = fit_bend(context, cloud, reference, placed.fit.pose);
    alignment.bend_gain = fit.gain;
    if (fit.is_better()) alignment = judge_bent(context, fit, cloud_source, cloud, reference);
  }
  alignment.dropped = of_cloud.dropped + of_reference.dropped;
  return alignment;
}

}  // namespace ray
