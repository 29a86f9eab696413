#include "displacements.h"

#include <cmath>

namespace ray {

Displacements::Displacements(std::size_t groups, const Pose& pose)
    : pose_(pose), known_(groups), ends_(groups), moves_(groups) {}

void Displacements::set(std::uint32_t group, const Lines& was, std::size_t from, const Lines& is,
                        std::size_t to) {
  const auto moved = [&](const Eigen::Vector3d& p) -> Eigen::Vector3d {
    return pose_.is_identity() ? p : pose_ * p;
  };
  known_[group] = 1;
  ends_[group] = was.ends[from];
  moves_[group] = {is.starts[to] - moved(was.starts[from]), is.ends[to] - moved(was.ends[from])};
}

Displacements::Move Displacements::around(const Eigen::Vector3d& end, std::uint32_t group,
                                          const RayGroups& groups) const {
  const VoxelIndex cube = voxel_index(end, groups.width());
  const double reach = 2.0 * groups.width().value;  // more than the diagonal of a cube
  Move sum;
  double weights = 0.0;
  for (int n = 0; n < 27; n++) {
    const std::uint32_t other =
        n == 13 ? group : groups.at({cube.x + n % 3 - 1, cube.y + n / 3 % 3 - 1, cube.z + n / 9 - 1});
    if (!has(other)) continue;
    const double distance = (end - ends_[other]).norm();
    if (distance == 0.0) return moves_[other];
    const double weight = std::pow(std::max(reach - distance, 0.0) / distance, 2);
    sum.start += weight * moves_[other].start;
    sum.end += weight * moves_[other].end;
    weights += weight;
  }
  return {sum.start / weights, sum.end / weights};
}

Displacements::Move Displacements::between(std::uint64_t row, std::uint32_t group,
                                           std::uint64_t every) const {
  const double part = static_cast<double>(row % every) / static_cast<double>(every);
  const Move& from = moves_[group];
  if (part == 0.0 || !has(group + 1)) return from;
  const Move& to = moves_[group + 1];
  return {from.start + part * (to.start - from.start), from.end + part * (to.end - from.end)};
}

void Displacements::move(RayCloud& rays, const RayGroups& groups, std::span<const std::uint32_t> group,
                         std::uint64_t row) const {
  for (std::size_t i = 0; i < rays.size(); i++) {
    if (!has(group[i])) continue;
    const Move step =
        groups.by_row() ? between(row + i, group[i], groups.every()) : around(rays.ends[i], group[i], groups);
    if (!pose_.is_identity()) {
      rays.starts[i] = pose_ * rays.starts[i];
      rays.ends[i] = pose_ * rays.ends[i];
    }
    // What stays keeps every bit: -0 + 0 would not.
    if (!step.start.isZero(0.0)) rays.starts[i] += step.start;
    if (!step.end.isZero(0.0)) rays.ends[i] += step.end;
  }
}

}  // namespace ray
