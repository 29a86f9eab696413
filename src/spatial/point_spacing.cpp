#include <raycloud/core/bounds.h>
#include <raycloud/spatial/point_spacing.h>
#include <raycloud/spatial/voxel_set.h>

#include <cmath>
#include <vector>

namespace ray {
namespace {

std::size_t count_cubes(std::span<const Eigen::Vector3d> points, Metres width) {
  VoxelSet cubes;
  static_cast<void>(cubes.insert(voxel_keys(points, width)));
  return cubes.size();
}

}  // namespace

Metres estimate_spacing(std::span<const Eigen::Vector3d> sample, std::uint64_t point_count) {
  constexpr std::size_t kPointsPerCube = 8;
  constexpr double kCubesPerArea = 1.5;
  if (sample.size() < kPointsPerCube) return {};
  Bounds bounds;
  for (const Eigen::Vector3d& point : sample)
    bounds.add(point);
  const double extent = bounds.extent().maxCoeff();
  if (!(extent > 0.0) || !std::isfinite(extent)) return {};

  std::vector<Eigen::Vector3d> local(sample.begin(), sample.end());  // so that the place does not matter
  for (Eigen::Vector3d& point : local)
    point -= bounds.min;
  const auto is_full = [&](double width) {
    return count_cubes(local, {width}) * kPointsPerCube <= local.size();
  };
  // If the points lay on one plane as large as the box, this width would do: begin there, it saves passes.
  double width = std::exp2(std::ceil(std::log2(extent / std::sqrt(static_cast<double>(sample.size())))));
  while (!is_full(width) && width < 4.0 * extent)
    width *= 2.0;
  constexpr double kFinest = 0x1p-20;  // of the extent: below, the points are copies of a few
  while (width > extent * kFinest && is_full(0.5 * width))
    width *= 0.5;
  const auto cubes = static_cast<double>(count_cubes(local, {width}));
  return {width * std::sqrt(cubes / kCubesPerArea / static_cast<double>(point_count))};
}

}  // namespace ray
