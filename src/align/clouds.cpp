#include "bend_fit.h"
#include "bent_source.h"
#include "doubts.h"
#include "search.h"

#include <raycloud/align/clouds.h>
#include <raycloud/core/error.h>

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

Placed place(const Context& context, const Known& cloud, const Known& reference, bool local) {
  const Jury jury(cloud, reference);
  const Case of{context, cloud, reference, jury};
  std::vector<Hypothesis> judged = judged_poses(context, cloud, reference, jury, local);
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
