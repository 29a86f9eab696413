#include "hypotheses.h"

#include <raycloud/align/clouds.h>
#include <raycloud/core/error.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <string>

namespace ray {
namespace {

using namespace align;

Known known_of(const Context& context, RaySource& source, const Survey& survey, double width) {
  return {context, gather_surfaces(context, source, survey, width)};
}

void require_surfaces(const Survey& survey, const char* which) {
  if (survey.bounded == 0)
    throw Error(ErrorCode::no_data, std::string(which) + " has no surfaces to align: no ray is bounded");
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

/// The covariance of turns and shifts: the residuals stand for noise. Patches of one wall share what is wrong
/// with it, so that there are fewer that are independent.
Matrix6 covariance_of(const FineFit& fit) {
  constexpr double kTogether = 10.0;  // patches
  const Eigen::SelfAdjointEigenSolver<Matrix6> solver(fit.information);
  const Vector6 values = solver.eigenvalues().cwiseMax(1e-12 * solver.eigenvalues().maxCoeff() + 1e-300);
  return kTogether * fit.rmse * fit.rmse * solver.eigenvectors() * values.cwiseInverse().asDiagonal() *
         solver.eigenvectors().transpose();
}

/// Why the best of some hypotheses is not to be trusted; empty if it is. `rivals` are those that came to lie
/// elsewhere.
std::string doubt_of(const Hypothesis& best, const std::vector<Hypothesis>& rivals, double overlap) {
  constexpr double kLeastSame = 100.0, kLeastOverlap = 0.1, kMostEmpty = 0.035, kMostRival = 0.7;
  Agreement::Counts both = best.there.all();
  both += best.back.all();
  const std::string found = "the best overlap found is " + percent(overlap);
  if (both.same < kLeastSame || overlap < kLeastOverlap) return "too few surfaces are in both: " + found;
  const double empty = share(both.empty, both.same + both.empty);
  if (empty > kMostEmpty)
    return percent(empty) + " of the surfaces would be where the other cloud has seen empty space: " + found;
  for (const Hypothesis& rival : rivals)
    if (rival.score > kMostRival * best.score) return "it fits nearly as well elsewhere: " + found;
  return {};
}

void dump(const std::vector<Hypothesis>& hypotheses) {
  if (getenv("ALIGN_DEBUG") == nullptr) return;
  for (std::size_t i = 0; i < std::min<std::size_t>(hypotheses.size(), 4); ++i) {
    const Hypothesis& h = hypotheses[i];
    const auto& a = h.there.upright;
    const auto& b = h.back.upright;
    const auto& c = h.there.others;
    const auto& d = h.back.others;
    fprintf(
        stderr,
        "  #%zu score %.0f up there s%.0f o%.0f e%.0f u%.0f back s%.0f o%.0f e%.0f u%.0f | oth there s%.0f o%.0f e%.0f u%.0f back s%.0f o%.0f e%.0f u%.0f yaw %.2f t %.2f %.2f %.2f\n",
        i, h.score, a.same, a.other, a.empty, a.unknown, b.same, b.other, b.empty, b.unknown, c.same, c.other,
        c.empty, c.unknown, d.same, d.other, d.empty, d.unknown,
        std::atan2(h.pose.rotation(1, 0), h.pose.rotation(0, 0)) * 57.29578, h.pose.translation.x(),
        h.pose.translation.y(), h.pose.translation.z());
  }
}

}  // namespace

CloudAlignment align_clouds(const Context& context, RaySource& cloud_source, RaySource& reference_source,
                            const AlignRule& rule) {
  constexpr std::size_t kKept = 24;
  const Survey of_cloud = survey_ends(context, cloud_source),
               of_reference = survey_ends(context, reference_source);
  require_surfaces(of_cloud, "the cloud");
  require_surfaces(of_reference, "the reference");
  const double width = std::max(patch_width(of_cloud), patch_width(of_reference));
  const Known cloud = known_of(context, cloud_source, of_cloud, width),
              reference = known_of(context, reference_source, of_reference, width);

  std::vector<Hypothesis> hypotheses;
  if (!rule.local) hypotheses = rough_hypotheses(context, cloud, reference);
  hypotheses.resize(std::min(hypotheses.size(), kKept));
  hypotheses.push_back({{Eigen::Matrix3d::Identity(), of_cloud.origin - of_reference.origin}, {}, {}, 0.0});
  hypotheses = fitted(context, cloud, reference, hypotheses);
  const Hypothesis best = hypotheses.front();
  std::vector<Hypothesis> rivals = fitted(context, cloud, reference, aside_of(best.pose, cloud, reference));
  dump(hypotheses);
  dump(rivals);
  rivals.insert(rivals.end(), hypotheses.begin() + 1, hypotheses.end());
  std::erase_if(rivals, [&](const Hypothesis& one) { return is_same_place(one.pose, best.pose, cloud); });

  FineFit fit = fit_patches(context, cloud.fine.patches(), reference.fine, best.pose,
                            {0.25 * reference.fine.width(), 20, false});
  CloudAlignment alignment;
  alignment.pose = in_world(fit.pose, cloud, reference);
  alignment.rmse = fit.rmse;
  alignment.patches = fit.count;
  alignment.covariance = covariance_of(fit);
  alignment.centre = fit.centre + of_reference.origin;
  const Agreement::Counts there = best.there.all(), back = best.back.all();
  alignment.overlap = share(there.same, there.known() + there.unknown);
  alignment.reference_overlap = share(back.same, back.known() + back.unknown);
  alignment.agreement = share(there.same + back.same, there.known() + back.known());
  alignment.doubt = doubt_of(best, rivals, std::max(alignment.overlap, alignment.reference_overlap));
  alignment.dropped = of_cloud.dropped + of_reference.dropped;
  return alignment;
}

}  // namespace ray
