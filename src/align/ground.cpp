#include "ground.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace ray::align {
namespace {

double tukey(double u) {
  return std::abs(u) < 1.0 ? (1.0 - u * u) * (1.0 - u * u) : 0.0;
}

/// The most frequent normal: the one with most area around it, found from coarse to fine.
Eigen::Vector3d usual_normal(const std::vector<Floor>& floors, double most_tilt) {
  constexpr int kTiltSteps = 15;  // at either side of up
  Eigen::Vector3d best = Eigen::Vector3d::UnitZ();
  double most = -1.0;
  const double step = most_tilt / kTiltSteps;
  std::vector<double> areas((2 * kTiltSteps + 1) * (2 * kTiltSteps + 1));
  const auto cell = [&](double tilt) {
    return std::clamp<int>(static_cast<int>(std::lround(tilt / step)), -kTiltSteps, kTiltSteps);
  };
  const auto at = [&](int x, int y) -> double& {
    return areas[static_cast<std::size_t>((y + kTiltSteps) * (2 * kTiltSteps + 1) + x + kTiltSteps)];
  };
  for (const Floor& floor : floors)
    at(cell(floor.normal.x()), cell(floor.normal.y())) += floor.area;
  for (int y = 1 - kTiltSteps; y < kTiltSteps; ++y)
    for (int x = 1 - kTiltSteps; x < kTiltSteps; ++x) {
      double sum = 0.0;
      for (int j = -1; j <= 1; ++j)
        for (int i = -1; i <= 1; ++i)
          sum += at(x + i, y + j);
      if (sum > most) most = sum, best = Eigen::Vector3d(x * step, y * step, 1.0).normalized();
    }
  for (double reach = 2.0 * step; reach > 0.5 * step; reach *= 0.7) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (const Floor& floor : floors)
      sum += floor.area * tukey((floor.normal - best).norm() / reach) * floor.normal;
    if (sum.squaredNorm() > 0.0) best = sum.normalized();
  }
  return best;
}

Eigen::Matrix3d to_up(const Eigen::Vector3d& normal) {
  return Eigen::Quaterniond::FromTwoVectors(normal, Eigen::Vector3d::UnitZ()).toRotationMatrix();
}

std::vector<Floor> turned(const std::vector<Floor>& floors, const Eigen::Matrix3d& rotation) {
  std::vector<Floor> result = floors;
  for (Floor& floor : result) {
    floor.place = rotation * floor.place;
    floor.normal = rotation * floor.normal;
  }
  return result;
}

/// The normal of the plane through what is near the ground.
Eigen::Vector3d plane_normal(const std::vector<Floor>& floors, double height, double reach) {
  double weights = 0.0;
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  for (const Floor& floor : floors) {
    const double weight = floor.count * tukey((floor.place.z() - height) / reach);
    weights += weight;
    mean += weight * floor.place;
    squares += weight * floor.place * floor.place.transpose();
  }
  if (!(weights > 0.0)) return Eigen::Vector3d::UnitZ();
  mean /= weights;
  const Eigen::Matrix3d covariance = squares / weights - mean * mean.transpose();
  const Eigen::Vector2d slope =
      covariance.topLeftCorner<2, 2>().ldlt().solve(covariance.topRightCorner<2, 1>());
  return slope.allFinite() ? Eigen::Vector3d(-slope.x(), -slope.y(), 1.0).normalized()
                           : Eigen::Vector3d::UnitZ();
}

}  // namespace

std::vector<Floor> floor_patches(const PatchLevel& level, double most_tilt) {
  std::vector<Floor> floors;
  const double least = std::cos(most_tilt);
  for (const Patch& patch : level.patches()) {
    if (!patch.is_flat() || patch.normal.z() < least) continue;
    floors.push_back({patch.mean, patch.normal, patch.area(), patch.count});
  }
  return floors;
}

std::optional<Ground> ground_of(const std::vector<Floor>& floors) {
  constexpr double kBin = 0.05;  // m
  constexpr double kShare = 1.0 / 3.0;
  constexpr double kNear = 0.1;  // m
  if (floors.empty()) return {};
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const Floor& floor : floors)
    low = std::min(low, floor.place.z()), high = std::max(high, floor.place.z());
  constexpr double kMostHeight = 20000.0;  // m; 10 million bins would be no histogram
  if (!(high - low < kMostHeight)) return {};
  std::vector<double> areas(static_cast<std::size_t>((high - low) / kBin) + 3);
  for (const Floor& floor : floors)
    areas[static_cast<std::size_t>((floor.place.z() - low) / kBin) + 1] += floor.area;
  std::vector<double> sums(areas.size());
  for (std::size_t i = 1; i + 1 < areas.size(); ++i)
    sums[i] = areas[i - 1] + areas[i] + areas[i + 1];
  const double most = *std::max_element(sums.begin(), sums.end());
  std::size_t lowest = 0;
  while (sums[lowest] < kShare * most)
    ++lowest;
  while (lowest + 1 < sums.size() && sums[lowest + 1] > sums[lowest])
    ++lowest;
  Ground ground{low + (static_cast<double>(lowest) - 0.5) * kBin, 0.0};
  for (double reach = 0.15; reach > 0.05; reach *= 0.8) {
    double weights = 0.0, pull = 0.0;
    for (const Floor& floor : floors) {
      const double off = floor.place.z() - ground.height;
      const double weight = floor.count * tukey(off / reach);
      weights += weight, pull += weight * off;
    }
    if (weights > 0.0) ground.height += pull / weights;
  }
  for (const Floor& floor : floors)
    if (std::abs(floor.place.z() - ground.height) < kNear) ground.area += floor.area;
  return ground;
}

std::optional<Eigen::Matrix3d> levelling(const std::vector<Floor>& floors) {
  constexpr double kMostTilt = 0.26;  // rad, 15 degrees
  if (floors.empty()) return {};
  Eigen::Matrix3d rotation = to_up(usual_normal(floors, kMostTilt));
  for (const double reach : {0.1, 0.08, 0.06, 0.06, 0.06}) {  // less than a step
    const std::vector<Floor> level = turned(floors, rotation);
    const std::optional<Ground> ground = ground_of(level);
    if (!ground) return {};
    rotation = to_up(plane_normal(level, ground->height, reach)) * rotation;
  }
  return rotation;
}

std::vector<Eigen::Vector3d> maybe_up(const PatchLevel& level, std::size_t most) {
  constexpr double kMostTilt = std::numbers::pi / 3.0, kReach = 0.2, kApart = 0.35;  // rad
  constexpr double kLeastShare = 0.25;
  constexpr std::size_t kAsked = 1000;
  const std::vector<Floor> floors = floor_patches(level, kMostTilt);
  const std::size_t stride = 1 + floors.size() / kAsked;
  const auto near = [&](const Eigen::Vector3d& direction) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (std::size_t i = 0; i < floors.size(); i += stride)
      sum += floors[i].area * tukey((floors[i].normal - direction).norm() / kReach) * floors[i].normal;
    return sum;
  };
  std::vector<Eigen::Vector3d> ups;
  double first = 0.0;
  while (ups.size() < most) {
    Eigen::Vector3d best = Eigen::Vector3d::Zero();
    for (std::size_t i = 0; i < floors.size(); i += stride) {
      const Eigen::Vector3d sum = near(floors[i].normal);
      const bool is_new = std::none_of(ups.begin(), ups.end(), [&](const Eigen::Vector3d& up) {
        return up.dot(floors[i].normal) > std::cos(kApart);
      });
      if (is_new && sum.squaredNorm() > best.squaredNorm()) best = sum;
    }
    if (ups.empty()) first = best.norm();
    if (!(best.norm() > 0.0) || best.norm() < kLeastShare * first) break;
    ups.push_back(best.normalized());
  }
  return ups;
}

}  // namespace ray::align
