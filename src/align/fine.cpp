#include "fine.h"

#include <raycloud/exec/parallel.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace ray::align {
namespace {

/// The normal equation of a step.
struct Equation {
  Matrix6 information = Matrix6::Zero();
  Vector6 pull = Vector6::Zero();
  double squares = 0.0, weights = 0.0, count = 0.0;
};

Equation sum_of(Equation a, const Equation& b) {
  a.information += b.information;
  a.pull += b.pull;
  a.squares += b.squares, a.weights += b.weights, a.count += b.count;
  return a;
}

Vector6 row_of(const Eigen::Vector3d& arm, const Eigen::Vector3d& direction) {
  Vector6 row;
  row << arm.cross(direction), direction;
  return row;
}

void add_residual(double off, double weight, Equation& equation) {
  equation.squares += weight * off * off;
  equation.weights += weight;
}

/// That the distance `off` (m) along `direction` is to vanish, for small turns about the centre and shifts.
void pull_along(const Eigen::Vector3d& arm, const Eigen::Vector3d& direction, double off, double weight,
                Equation& equation) {
  const Vector6 row = row_of(arm, direction);
  equation.information.selfadjointView<Eigen::Lower>().rankUpdate(row, weight);
  equation.pull += weight * off * row;
  add_residual(off, weight, equation);
}

/// That two planes are to be one. Noise tilts normals, so that of thousands of patches of a plane each seems
/// to tell a little of shifts within it: all together pull means onto means, as cubes happen to lie. The
/// noise of one cloud is none of the other's: so the distance along one normal pulls along the other
/// (instrumental variables, Fuller 1987), and what tilts tell is zero on average.
void pull_together(const Eigen::Vector3d& arm, const std::array<Eigen::Vector3d, 2>& normals,
                   const std::array<double, 2>& off, double weight, Equation& equation) {
  const Vector6 first = row_of(arm, normals[0]), second = row_of(arm, normals[1]);
  const Vector6 mean = 0.5 * (first + second), half = 0.5 * (first - second);
  // The symmetric part of first · secondᵀ.
  equation.information.selfadjointView<Eigen::Lower>().rankUpdate(mean, weight).rankUpdate(half, -weight);
  equation.pull += 0.5 * weight * (off[0] * second + off[1] * first);
  add_residual(0.5 * (off[0] + off[1]), weight, equation);
}

Equation equation_of(std::span<const Patch> patches, const PatchLevel& reference, const FineFit& at,
                     const FineRule& rule) {
  constexpr double kLeastSigma = 0.003;  // m; means are no truer than that, however many points
  Equation equation;
  const Eigen::Matrix3d& rotation = at.pose.rotation;
  for (const Patch& patch : patches) {
    const Eigen::Vector3d place = at.pose * patch.mean;
    const Patch* other = counterpart_of(patch, reference, place, rotation, rule);
    if (other == nullptr) continue;
    const Eigen::Vector3d apart = other->mean - place, arm = place - at.centre;
    const auto weight_of = [&](double off, double variances) {
      const double u = off / rule.gate;
      // A patch that is rough, or has few points, is less sure of where it is.
      const double sigma2 = variances + kLeastSigma * kLeastSigma;
      return std::abs(u) < 1.0 ? (1.0 - u * u) * (1.0 - u * u) * kLeastSigma * kLeastSigma / sigma2 : 0.0;
    };
    const auto variance_of_mean = [](const Patch& one, int i) { return one.variances[i] / one.count; };
    if (patch.is_flat(rule.flat)) {
      const std::array<Eigen::Vector3d, 2> normals{other->normal, rotation * patch.normal};
      const std::array<double, 2> off{normals[0].dot(apart), normals[1].dot(apart)};
      const double weight =
          weight_of(0.5 * (off[0] + off[1]), variance_of_mean(patch, 0) + variance_of_mean(*other, 0));
      if (!(weight > 0.0)) continue;
      pull_together(arm, normals, off, weight, equation);
      equation.count += 1.0;
    } else {
      const Eigen::Vector3d across = apart - other->along * other->along.dot(apart);
      const double off = across.norm();
      const double weight = weight_of(off, variance_of_mean(patch, 1) + variance_of_mean(*other, 1));
      if (!(weight > 0.0)) continue;
      const Eigen::Vector3d first = other->along.unitOrthogonal(), second = other->along.cross(first);
      pull_along(arm, first, first.dot(apart), 0.5 * weight, equation);
      pull_along(arm, second, second.dot(apart), 0.5 * weight, equation);
      equation.count += 1.0;
    }
  }
  return equation;
}

Vector6 step_of(Equation equation, bool upright, double damping) {
  Matrix6 information = equation.information.selfadjointView<Eigen::Lower>();
  if (upright) {
    information.topRows<2>().setZero(), information.leftCols<2>().setZero();
    equation.pull.head<2>().setZero();
  }
  // Turns and shifts are made alike by the largest information of either.
  const double turns = information.diagonal().head<3>().maxCoeff(),
               shifts = information.diagonal().tail<3>().maxCoeff();
  if (!(turns > 0.0 && shifts > 0.0)) return Vector6::Zero();
  Vector6 scale;
  scale << Eigen::Vector3d::Constant(1.0 / std::sqrt(turns)),
      Eigen::Vector3d::Constant(1.0 / std::sqrt(shifts));
  const Matrix6 scaled = scale.asDiagonal() * information * scale.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Matrix6> solver(scaled);
  const Vector6 values = (solver.eigenvalues().cwiseMax(0.0).array() + damping).matrix();
  const Vector6 pull = solver.eigenvectors().transpose() * (scale.asDiagonal() * equation.pull);
  return scale.asDiagonal() * (solver.eigenvectors() * pull.cwiseQuotient(values));
}

template <class Sum>
FineFit fit(std::span<const Patch> patches, const Pose& start, const FineRule& rule, const Sum& sum) {
  constexpr double kLeastTurn = 1e-6, kLeastShift = 1e-5;
  FineFit at;
  at.pose = start;
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  for (const Patch& patch : patches)
    middle += patch.mean / static_cast<double>(patches.size());
  for (int step = 0; step < rule.steps; ++step) {
    at.centre = at.pose * middle;
    const Equation equation = sum(at);
    at.count = equation.count;
    at.information = equation.information.template selfadjointView<Eigen::Lower>();
    at.rmse = equation.weights > 0.0 ? std::sqrt(equation.squares / equation.weights) : 0.0;
    at.variance = equation.count > 0.0 ? equation.squares / equation.count : 0.0;
    constexpr double kLeastPatches = 6.0;
    if (equation.count < kLeastPatches || !(equation.weights > 0.0)) return at;
    const Vector6 change = step_of(equation, rule.upright, rule.damping);
    if (!change.allFinite() || !at.information.allFinite()) return at;
    const Eigen::Vector3d turn = change.head<3>(), shift = change.tail<3>();
    const Eigen::Matrix3d rotation = rotation_pose(turn).rotation;
    at.pose.translation = rotation * (at.pose.translation - at.centre) + at.centre + shift;
    at.pose.rotation = rotation * at.pose.rotation;
    if (turn.norm() < kLeastTurn && shift.norm() < kLeastShift) break;
  }
  // Products of many rotations stay one.
  at.pose.rotation = Eigen::Quaterniond(at.pose.rotation).normalized().toRotationMatrix();
  return at;
}

}  // namespace

const Patch* counterpart_of(const Patch& patch, const PatchLevel& reference, const Eigen::Vector3d& place,
                            const Eigen::Matrix3d& rotation, const FineRule& rule) {
  constexpr double kAligned = 0.8;  // cosine
  const bool flat = patch.is_flat(rule.flat), thin = patch.is_thin();
  if (!flat && !thin) return nullptr;
  const Eigen::Vector3d heading = rotation * (flat ? patch.normal : patch.along);
  const Patch* nearest = nullptr;
  double least = std::numeric_limits<double>::infinity();
  reference.each_near(place, [&](const Patch& other) {
    const double distance2 = (other.mean - place).squaredNorm();
    if (distance2 >= least) return;
    const bool fits = flat ? other.is_flat(rule.flat) && other.normal.dot(heading) > kAligned
                           : other.is_thin() && std::abs(other.along.dot(heading)) > kAligned;
    if (fits) least = distance2, nearest = &other;
  });
  return nearest;
}

FineFit fit_patches(std::span<const Patch> patches, const PatchLevel& reference, const Pose& start,
                    const FineRule& rule) {
  return fit(patches, start, rule,
             [&](const FineFit& at) { return equation_of(patches, reference, at, rule); });
}

FineFit fit_patches(const Context& context, std::span<const Patch> patches, const PatchLevel& reference,
                    const Pose& start, const FineRule& rule) {
  const FineLevel level{patches, reference, rule};
  return fit_levels(context, {&level, 1}, start);
}

FineFit fit_levels(const Context& context, std::span<const FineLevel> levels, const Pose& start) {
  constexpr std::size_t kGrain = 512;
  return fit(levels.front().patches, start, levels.front().rule, [&](const FineFit& at) {
    Equation all;
    for (const FineLevel& level : levels)
      all = sum_of(all, parallel_reduce(
                            context, level.patches.size(), kGrain, Equation(),
                            [&](std::size_t begin, std::size_t end) {
                              return equation_of(level.patches.subspan(begin, end - begin), level.reference,
                                                 at, level.rule);
                            },
                            sum_of));
    return all;
  });
}

std::vector<Patch> some_of(const std::vector<Patch>& patches, std::size_t most) {
  if (patches.size() <= most) return patches;
  std::vector<Patch> some;
  some.reserve(most);
  // Strides of a key order would keep rows of space; the golden ratio keeps none.
  constexpr std::uint64_t kGolden = 0x9e3779b97f4a7c15U;
  const auto threshold =
      static_cast<std::uint64_t>(0x1p64 * (static_cast<double>(most) / static_cast<double>(patches.size())));
  for (std::size_t i = 0; i < patches.size() && some.size() < most; ++i)
    if (i * kGolden < threshold) some.push_back(patches[i]);
  return some;
}

}  // namespace ray::align
