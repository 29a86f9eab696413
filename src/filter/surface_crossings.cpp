#include "surface_crossings.h"

#include <raycloud/exec/parallel.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace ray {
namespace {

constexpr double kCube = 0.25;  // m
constexpr std::size_t kFewestEnds = 6;
constexpr double kThickest = 0.1 * kCube;    // standard deviation across a patch
constexpr double kNarrowest = 0.12 * kCube;  // and along its shorter side
constexpr double kSteep = 0.3;               // least cosine between ray and normal
constexpr double kSkippedAtStart = 0.5;      // m
constexpr double kSkippedAtEnd = 1.0;        // m, or the share below of the length
constexpr double kSkippedShare = 0.05;
constexpr double kLongestWalk = 100.0;  // m
constexpr double kFar = 1e15;           // cubes; beyond, a point only has to be in some cube
constexpr std::size_t kFilterWords = std::size_t{1} << 15;

std::uint64_t cube_key(const Eigen::Vector3d& point) {
  constexpr std::uint64_t kMask = (1u << 21) - 1;
  const auto index = [](double v) {
    return static_cast<std::uint64_t>(static_cast<std::int64_t>(std::clamp(v / kCube, -kFar, kFar))) & kMask;
  };
  return index(point.x()) | index(point.y()) << 21 | index(point.z()) << 42;
}

std::uint64_t hash_of(std::uint64_t key) {
  return key * 0x9E3779B97F4A7C15u >> 40;
}

struct KeyedEnd {
  std::uint64_t key;
  std::uint32_t index;
};

}  // namespace

SurfacePatches::SurfacePatches(const Context& context, std::span<const Eigen::Vector3d> ends)
    : filter_(kFilterWords, 0) {
  constexpr std::size_t kGrain = 4096;
  std::vector<KeyedEnd> keyed(ends.size());
  parallel_for(context, ends.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      keyed[i] = {cube_key(ends[i]), static_cast<std::uint32_t>(i)};
  });
  parallel_sort(context, keyed.begin(), keyed.end(),
                [](const KeyedEnd& a, const KeyedEnd& b) { return a.key < b.key; });
  std::vector<std::size_t> firsts;  // of the ends of each cube
  for (std::size_t i = 0; i < keyed.size(); ++i)
    if (i == 0 || keyed[i].key != keyed[i - 1].key) firsts.push_back(i);
  firsts.push_back(keyed.size());

  std::vector<std::optional<Patch>> fitted(firsts.size() - 1);
  parallel_for(context, fitted.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    std::vector<Eigen::Vector3d> cube;
    for (std::size_t i = begin; i < end; ++i) {
      cube.clear();
      for (std::size_t j = firsts[i]; j < firsts[i + 1]; ++j)
        cube.push_back(ends[keyed[j].index]);
      fitted[i] = fit(cube);
    }
  });
  for (std::size_t i = 0; i < fitted.size(); ++i) {
    if (!fitted[i]) continue;
    const std::uint64_t key = keyed[firsts[i]].key;
    patches_.emplace(key, *fitted[i]);
    const std::uint64_t hash = hash_of(key);
    filter_[(hash >> 6) % kFilterWords] |= std::uint64_t{1} << (hash & 63);
  }
}

std::optional<SurfacePatches::Patch> SurfacePatches::fit(std::span<const Eigen::Vector3d> ends) {
  if (ends.size() < kFewestEnds) return std::nullopt;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  for (const Eigen::Vector3d& end : ends) {
    sum += end;
    squares += end * end.transpose();
  }
  const auto count = static_cast<double>(ends.size());
  const Eigen::Vector3d centre = sum / count;
  const Eigen::Matrix3d covariance = squares / count - centre * centre.transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(covariance);
  const Eigen::Vector3d variances = solver.eigenvalues().cwiseMax(0.0);
  if (variances[0] > kThickest * kThickest || variances[1] < kNarrowest * kNarrowest) return std::nullopt;
  return Patch{centre, solver.eigenvectors().col(0), 2.25 * variances[1]};
}

bool SurfacePatches::blocks(const Eigen::Vector3d& start, const Eigen::Vector3d& end) const {
  const double length = (end - start).norm();
  const double stop = length - std::max(kSkippedAtEnd, kSkippedShare * length);
  const double begin = std::max(kSkippedAtStart, stop - kLongestWalk);
  if (!(stop > begin) || !std::isfinite(length)) return false;
  const Eigen::Vector3d direction = (end - start) / length;
  std::uint64_t last = ~std::uint64_t{0};
  const int steps = static_cast<int>((stop - begin) / (0.5 * kCube)) + 1;
  for (int i = 0; i < steps; ++i) {
    const std::uint64_t key = cube_key(start + direction * (begin + 0.5 * kCube * i));
    if (key == last || !maybe(hash_of(key))) continue;
    last = key;
    const auto found = patches_.find(key);
    if (found == patches_.end()) continue;
    const Patch& patch = found->second;
    const double cosine = direction.dot(patch.normal);
    if (std::abs(cosine) < kSteep) continue;
    const double crossing = (patch.centre - start).dot(patch.normal) / cosine;
    const Eigen::Vector3d offset = start + direction * crossing - patch.centre;
    if (crossing > begin && crossing < stop && offset.squaredNorm() < patch.radius_squared) return true;
  }
  return false;
}

}  // namespace ray
