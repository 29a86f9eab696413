#include "bend_fit.h"

#include "fine.h"

#include <raycloud/exec/parallel.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
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

/// How far a patch is from its counterpart, along two directions that should be one: the normals of flat
/// ones, each of which has its own noise (see fine.cpp).
struct Miss {
  std::array<Eigen::Vector3d, 2> directions;
  std::array<double, 2> off;  ///< m

  [[nodiscard]] double mean() const { return 0.5 * (off[0] + off[1]); }
};

Miss miss_along(const Eigen::Vector3d& first, const Eigen::Vector3d& second, const Eigen::Vector3d& apart) {
  return {{first, second}, {first.dot(apart), second.dot(apart)}};
}

/// One of a flat patch, two of a thin one, none without a counterpart.
struct Misses {
  std::array<Miss, 2> all{};
  std::size_t count = 0;
  [[nodiscard]] auto begin() const { return all.begin(); }
  [[nodiscard]] auto end() const { return all.begin() + static_cast<std::ptrdiff_t>(count); }
};

Misses misses_of(const Patch& patch, const Eigen::Vector3d& place, const Eigen::Matrix3d& rotation,
                 const PatchLevel& reference) {
  const Patch* other = counterpart_of(patch, reference, place, rotation);
  if (other == nullptr) return {};
  const Eigen::Vector3d apart = other->mean - place;
  if (patch.is_flat()) return {{miss_along(other->normal, rotation * patch.normal, apart)}, 1};
  const Eigen::Vector3d first = other->along.unitOrthogonal(), second = other->along.cross(first);
  return {{miss_along(first, first, apart), miss_along(second, second, apart)}, 2};
}

struct BendState {
  Pose pose;
  Bend bend;
  Eigen::Vector3d centre;  ///< m, about which turns are
  double reach;            ///< m, horizontal, root mean square from the centre
  /// To the place along and across the cloud, each over its root mean square: so that what bends a long map
  /// across counts as much in a step as what bends it along.
  Eigen::Matrix2d to_axes;

  [[nodiscard]] Eigen::Vector3d quadratic(const Eigen::Vector3d& straight) const {
    const Eigen::Vector2d from = to_axes * (straight.head<2>() - bend.centre);
    return {from.x() * from.x(), from.y() * from.y(), from.x() * from.y()};
  }
};

/// From (x², y², x y) to those along and across.
Eigen::Matrix3d quadratics_to_axes(const Eigen::Matrix2d& to_axes) {
  const auto product = [&](Eigen::Index i, Eigen::Index j) {
    const Eigen::Vector2d a = to_axes.row(i), b = to_axes.row(j);
    return Eigen::RowVector3d(a.x() * b.x(), a.y() * b.y(), a.x() * b.y() + a.y() * b.x());
  };
  Eigen::Matrix3d matrix;
  matrix << product(0, 0), product(1, 1), product(0, 1);
  return matrix;
}

BendEquation bend_equation(std::span<const Patch> patches, const PatchLevel& reference, const BendState& at,
                           double gate) {
  BendEquation equation;
  for (const Patch& patch : patches) {
    const Eigen::Vector3d straight = at.pose * patch.mean, place = at.bend * straight;
    const Eigen::Vector3d quadratic = at.quadratic(straight), arm = (place - at.centre) / at.reach;
    bool counts = false;
    for (const Miss& miss : misses_of(patch, place, at.pose.rotation, reference)) {
      const double u = miss.mean() / gate, weight = std::abs(u) < 1.0 ? (1.0 - u * u) * (1.0 - u * u) : 0.0;
      if (!(weight > 0.0)) continue;
      const auto row_of = [&](const Eigen::Vector3d& direction) {
        Vector15 row;
        row << arm.cross(direction), direction, quadratic[0] * direction, quadratic[1] * direction,
            quadratic[2] * direction;
        return row;
      };
      const Vector15 first = row_of(miss.directions[0]), second = row_of(miss.directions[1]);
      equation.information.selfadjointView<Eigen::Lower>()
          .rankUpdate((0.5 * (first + second)).eval(), weight)
          .rankUpdate((0.5 * (first - second)).eval(), -weight);
      equation.pull += 0.5 * weight * (miss.off[0] * second + miss.off[1] * first);
      equation.squares += weight * miss.mean() * miss.mean();
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
  at.bend.shifts += change.tail<9>().reshaped(3, 3) * quadratics_to_axes(at.to_axes);
}

/// Patches to be fitted to others, of about the same width.
struct LevelPair {
  const PatchLevel& from;
  const PatchLevel& to;
  double gate;  ///< m
};

BendEquation sum_of_levels(const Context& context, std::span<const LevelPair> levels, const BendState& at) {
  constexpr std::size_t kGrain = 512;
  BendEquation sum;
  for (const LevelPair& level : levels) {
    const std::span<const Patch> patches = level.from.patches();
    sum = both_of(sum, parallel_reduce(
                           context, patches.size(), kGrain, BendEquation(),
                           [&](std::size_t begin, std::size_t end) {
                             return bend_equation(patches.subspan(begin, end - begin), level.to, at,
                                                  level.gate);
                           },
                           both_of));
  }
  return sum;
}

BendEquation fit_levels(const Context& context, std::span<const LevelPair> levels, BendState& at) {
  constexpr int kSteps = 30;
  constexpr double kEnough = 1e-5;  // m, at the reach
  BendEquation equation;
  for (int step = 0; step < kSteps; ++step) {
    equation = sum_of_levels(context, levels, at);
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
          sum += miss.mean() * miss.mean();
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
  constexpr double kLeastReach = 1e-3;  // m
  BendState at{rigid, {}, Eigen::Vector3d::Zero(), 0.0, Eigen::Matrix2d::Identity()};
  const std::vector<Patch>& patches = cloud.fine.patches();
  const auto count = static_cast<double>(patches.size());
  for (const Patch& patch : patches)
    at.centre += rigid * patch.mean / count;
  Eigen::Matrix2d spread = Eigen::Matrix2d::Zero();
  for (const Patch& patch : patches) {
    const Eigen::Vector2d from = (rigid * patch.mean - at.centre).head<2>();
    spread += from * from.transpose() / count;
  }
  at.reach = std::max(std::sqrt(spread.trace()), kLeastReach);
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes(spread);
  const Eigen::Vector2d reaches = axes.eigenvalues().cwiseMax(kLeastReach * kLeastReach).cwiseSqrt();
  at.to_axes = reaches.cwiseInverse().asDiagonal() * axes.eigenvectors().transpose();
  at.bend.centre = at.centre.head<2>();
  return at;
}

}  // namespace

BendFit fit_bend(const Context& context, const Known& cloud, const Known& reference, const Pose& rigid) {
  constexpr double kWideGate = 0.6, kGate = 0.25;  // widths
  constexpr double kLeast = 100.0;                 // patches
  const BendState before = start_of(cloud, rigid);
  BendState at = before;
  const auto pair = [](const PatchLevel& from, const PatchLevel& to, double gate) {
    return LevelPair{from, to, gate * to.width()};
  };
  const auto fit_to = [&](std::initializer_list<LevelPair> levels) {
    return fit_levels(context, std::span(levels.begin(), levels.size()), at);
  };
  fit_to({pair(cloud.wide, reference.wide, kWideGate)});
  fit_to({pair(cloud.middle, reference.middle, kWideGate)});
  fit_to({pair(cloud.fine, reference.fine, kWideGate)});
  fit_to({pair(cloud.fine, reference.fine, kGate)});
  // Narrow ones follow a bend best; where they have few points, wider ones are truer.
  const BendEquation last =
      fit_to({pair(cloud.fine, reference.fine, kGate), pair(cloud.narrow, reference.narrow, kGate)});
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
