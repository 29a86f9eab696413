#include "rest.h"

#include "hypotheses.h"

#include <raycloud/spatial/symmetric_eigen.h>

#include <Eigen/Eigenvalues>
#include <array>
#include <cmath>

namespace ray::align {

Matrix6 covariance_of(const FineFit& fit) {
  // Patches of one wall share what is wrong with it: so many tell as much as one that is independent.
  constexpr double kTogether = 10.0;
  const Eigen::SelfAdjointEigenSolver<Matrix6> solver(fit.information);
  const Vector6 values = solver.eigenvalues().cwiseMax(1e-12 * solver.eigenvalues().maxCoeff() + 1e-300);
  return kTogether * fit.variance * solver.eigenvectors() * values.cwiseInverse().asDiagonal() *
         solver.eigenvectors().transpose();
}

Eigen::Matrix3d shift_covariance(const FineFit& fit) {
  return covariance_of(fit).bottomRightCorner<3, 3>();
}

FineFit last_fit(const Context& context, const Known& cloud, const Known& reference, const Pose& start) {
  constexpr double kWideEnough = 0.25;          // m, for noise not to make narrow patches round
  constexpr double kShare = 0.5;                // of the patches, for the narrow ones to count
  constexpr double kGate = 0.25, kFirst = 0.5;  // widths
  const double width = reference.fine.width();
  const auto wide = [&](double gate, double flat, const Pose& from) {
    return fit_patches(context, cloud.fine.patches(), reference.fine, from,
                       {.gate = gate * width, .flat = flat});
  };
  if (reference.narrow.width() >= kWideEnough) {
    const FineFit fit = wide(kGate, FineRule().flat, start);
    const FineFit narrow = fit_patches(context, cloud.narrow.patches(), reference.narrow, fit.pose,
                                       {.gate = kGate * reference.narrow.width()});
    return narrow.count < kShare * fit.count ? fit : narrow;
  }
  constexpr double kStrip = 0.2;  // of the variance along: what noise leaves flat of a strip
  const auto both = [&](double gate, const Pose& from) {
    const FineRule rule{.gate = gate * width, .flat = kStrip};
    const std::array<FineLevel, 2> levels{
        {{cloud.fine.patches(), reference.fine, rule}, {cloud.narrow.patches(), reference.narrow, rule}}};
    return fit_levels(context, levels, from);
  };
  const FineFit first = wide(kFirst, kStrip, start), of_both = both(kFirst, first.pose);
  return of_both.count - first.count < kShare * first.count ? wide(kGate, kStrip, first.pose)
                                                            : both(kGate, of_both.pose);
}

bool is_elsewhere(const Pose& a, const Pose& b, const Known& cloud) {
  constexpr double kApart = 0.25;  // widths
  return (a.translation - b.translation).norm() > kApart * cloud.fine.width() || !is_same_place(a, b, cloud);
}

bool is_loose(const FineFit& fit, const Known& cloud) {
  constexpr double kSigmas = 2.0, kApart = 0.25;  // of a width, as elsewhere
  return !(kSigmas * std::sqrt(symmetric_eigen(shift_covariance(fit)).values[2]) <
           kApart * cloud.fine.width());
}

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

}  // namespace ray::align
