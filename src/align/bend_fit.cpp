#include "bend_fit.h"

#include <raycloud/exec/parallel.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

namespace ray::align {
namespace {

/// Three of turning, three of shifting, nine of bending.
constexpr int kParameters = 15;
using Vector15 = Eigen::Matrix<double, kParameters, 1>;
using Matrix15 = Eigen::Matrix<double, kParameters, kParameters>;

struct BendEquation {
  Matrix15 information = Matrix15::Zero();
  Vector15 pull = Vector15::Zero();
  double squares = 0.0, weights = 0.0, count = 0.0;
};

BendEquation both_of(BendEquation a, const BendEquation& b) {
  a.information += b.information;
  a.pull += b.pull;
  a.squares += b.squares, a.weights += b.weights, a.count += b.count;
  return a;
}

/// How far a patch is from its counterpart, along a direction: the normal of a flat one.
struct Miss {
  double off = 0.0;  ///< m
  Eigen::Vector3d direction = Eigen::Vector3d::Zero();
};

/// One of a flat patch, two of a thin one, none without a counterpart.
struct Misses {
  std::array<Miss, 2> all;
  std::size_t count = 0;
  [[nodiscard]] auto begin() const { return all.begin(); }
  [[nodiscard]] auto end() const { return all.begin() + static_cast<std::ptrdiff_t>(count); }
};

Misses misses_of(const Patch& patch, const Eigen::Vector3d& place, const Eigen::Matrix3d& rotation,
                 const PatchLevel& reference) {
  const Patch* other = counterpart_of(patch, reference, place, rotation);
  if (other == nullptr) return {};
  const Eigen::Vector3d apart = other->mean - place;
  if (patch.is_flat()) return {{Miss{other->normal.dot(apart), other->normal}, Miss{}}, 1};
  const Eigen::Vector3d first = other->along.unitOrthogonal(), second = other->along.cross(first);
  return {{Miss{first.dot(apart), first}, Miss{second.dot(apart), second}}, 2};
}

struct BendState {
  Pose pose;
  Bend bend;
  Eigen::Vector3d centre;  ///< m, about which turns are
  double reach;            ///< m, horizontal, root mean square from the centre
};

BendEquation bend_equation(std::span<const Patch> patches, const PatchLevel& reference, const BendState& at,
                           double gate) {
  BendEquation equation;
  for (const Patch& patch : patches) {
    const Eigen::Vector3d straight = at.pose * patch.mean, place = at.bend * straight;
    const Eigen::Vector2d from = (straight.head<2>() - at.bend.centre) / at.reach;
    const Eigen::Vector3d quadratic(from.x() * from.x(), from.y() * from.y(), from.x() * from.y());
    const Eigen::Vector3d arm = (place - at.centre) / at.reach;
    bool counts = false;
    for (const Miss& miss : misses_of(patch, place, at.pose.rotation, reference)) {
      const double u = miss.off / gate, weight = std::abs(u) < 1.0 ? (1.0 - u * u) * (1.0 - u * u) : 0.0;
      if (!(weight > 0.0)) continue;
      Vector15 row;
      row << arm.cross(miss.direction), miss.direction, quadratic[0] * miss.direction,
          quadratic[1] * miss.direction, quadratic[2] * miss.direction;
      equation.information.selfadjointView<Eigen::Lower>().rankUpdate(row, weight);
      equation.pull += weight * miss.off * row;
      equation.squares += weight * miss.off * miss.off;
      equation.weights += weight;
      counts = true;
    }
    equation.count += counts ? 1.0 : 0.0;
  }
  return equation;
}

/// What is held much less than the rest hardly moves in a step.
Vector15 bend_step(const BendEquation& equation) {
  constexpr double kDamping = 1e-4;
  const Matrix15 information = equation.information.selfadjointView<Eigen::Lower>();
  const double most = information.diagonal().maxCoeff();
  if (!(most > 0.0)) return Vector15::Zero();
  const Eigen::SelfAdjointEigenSolver<Matrix15> solver(information);
  const Vector15 values = (solver.eigenvalues().cwiseMax(0.0).array() + kDamping * most).matrix();
  return solver.eigenvectors() * (solver.eigenvectors().transpose() * equation.pull).cwiseQuotient(values);
}

void move_by(const Vector15& change, BendState& at) {
  const Eigen::Matrix3d rotation = rotation_pose(change.head<3>() / at.reach).rotation;
  at.pose.translation = rotation * (at.pose.translation - at.centre) + at.centre + change.segment<3>(3);
  at.pose.rotation = rotation * at.pose.rotation;
  for (Eigen::Index i = 0; i < 3; ++i)
    at.bend.shifts.col(i) += change.segment<3>(6 + 3 * i) / (at.reach * at.reach);
}

BendEquation fit_level(const Context& context, std::span<const Patch> patches, const PatchLevel& reference,
                       double gate, BendState& at) {
  constexpr int kSteps = 30;
  constexpr double kEnough = 1e-5;  // m, at the reach
  constexpr std::size_t kGrain = 512;
  BendEquation equation;
  for (int step = 0; step < kSteps; ++step) {
    equation = parallel_reduce(
        context, patches.size(), kGrain, BendEquation(),
        [&](std::size_t begin, std::size_t end) {
          return bend_equation(patches.subspan(begin, end - begin), reference, at, gate);
        },
        both_of);
    const Vector15 change = bend_step(equation);
    if (!change.allFinite()) break;
    move_by(change, at);
    if (change.norm() < kEnough) break;
  }
  at.pose.rotation = Eigen::Quaterniond(at.pose.rotation).normalized().toRotationMatrix();
  return equation;
}

/// Of each of some poses, the mean square of the misses, those beyond the gate and of patches without a
/// counterpart as large as that, in columns of space; a column counts where any of them finds one.
struct Misfit {
  std::array<double, 2> squares{};
  double columns = 0.0;
};

Misfit misfit_of(const Context& context, const PatchLevel& cloud, const PatchLevel& reference, double gate,
                 const std::array<BendState, 2>& states) {
  constexpr double kBendColumn = 8.0;  // patches
  const std::vector<Patch>& patches = cloud.patches();
  std::vector<std::array<double, 2>> squares(patches.size());
  parallel_for(context, patches.size(), 512, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      for (std::size_t k = 0; k < 2; ++k) {
        const Eigen::Vector3d place = states[k].bend * (states[k].pose * patches[i].mean);
        double sum = 0.0;
        const Misses misses = misses_of(patches[i], place, states[k].pose.rotation, reference);
        for (const Miss& miss : misses)
          sum += miss.off * miss.off;
        squares[i][k] = misses.count == 0 ? gate * gate : std::min(sum, gate * gate);
      }
  });
  struct InColumn {
    std::pair<double, double> cell;
    std::array<double, 2> squares;
  };
  std::vector<InColumn> all;
  for (std::size_t i = 0; i < patches.size(); ++i) {
    if (squares[i][0] >= gate * gate && squares[i][1] >= gate * gate) continue;
    const Eigen::Array2d cell = (patches[i].mean.head<2>().array() / (kBendColumn * cloud.width())).floor();
    all.push_back({{cell.x(), cell.y()}, squares[i]});
  }
  std::stable_sort(all.begin(), all.end(),
                   [](const InColumn& a, const InColumn& b) { return a.cell < b.cell; });
  Misfit misfit;
  for (std::size_t begin = 0, end = 0; begin < all.size(); begin = end) {
    std::array<double, 2> sums{};
    for (; end < all.size() && all[end].cell == all[begin].cell; ++end)
      for (std::size_t k = 0; k < 2; ++k)
        sums[k] += all[end].squares[k];
    for (std::size_t k = 0; k < 2; ++k)
      misfit.squares[k] += sums[k] / static_cast<double>(end - begin);
    misfit.columns += 1.0;
  }
  return misfit;
}

BendState start_of(const Known& cloud, const Pose& rigid) {
  BendState at{rigid, {}, Eigen::Vector3d::Zero(), 0.0};
  const std::vector<Patch>& patches = cloud.fine.patches();
  const auto count = static_cast<double>(patches.size());
  for (const Patch& patch : patches)
    at.centre += rigid * patch.mean / count;
  for (const Patch& patch : patches)
    at.reach += (rigid * patch.mean - at.centre).head<2>().squaredNorm() / count;
  at.reach = std::max(std::sqrt(at.reach), 1e-3);
  at.bend.centre = at.centre.head<2>();
  return at;
}

}  // namespace

BendFit fit_bend(const Context& context, const Known& cloud, const Known& reference, const Pose& rigid) {
  constexpr double kWideGate = 0.6, kGate = 0.25;  // widths
  constexpr double kLeast = 100.0;                 // patches
  const BendState before = start_of(cloud, rigid);
  BendState at = before;
  const auto fit_to = [&](const PatchLevel& from, const PatchLevel& to, double gate) {
    return fit_level(context, from.patches(), to, gate * to.width(), at);
  };
  fit_to(cloud.wide, reference.wide, kWideGate);
  fit_to(cloud.middle, reference.middle, kWideGate);
  fit_to(cloud.fine, reference.fine, kWideGate);
  const BendEquation last = fit_to(cloud.fine, reference.fine, kGate);
  BendFit fit{at.pose, at.bend, 0.0, 0.0, last.count, 0.0};
  if (last.count < kLeast || !(last.weights > 0.0)) return fit;
  fit.rmse = std::sqrt(last.squares / last.weights);
  for (const Patch& patch : cloud.fine.patches())
    fit.size = std::max(fit.size, at.bend.shift_at(at.pose * patch.mean).norm());
  const Misfit misfit =
      misfit_of(context, cloud.fine, reference.fine, kGate * reference.fine.width(), {before, at});
  constexpr double kBending = 9.0;  // parameters
  if (misfit.squares[1] > 0.0)
    fit.gain = misfit.columns * std::log(misfit.squares[0] / misfit.squares[1]) -
               kBending * std::log(misfit.columns);
  return fit;
}

}  // namespace ray::align
