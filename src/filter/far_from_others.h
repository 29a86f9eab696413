#pragma once
/// Which points have few others around them.

#include <raycloud/exec/context.h>

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

namespace ray {

/// 1 for each point with fewer than `min_neighbours` others within `distance` (m, inclusive: the sum of the
/// squared differences of the coordinates, as doubles, is at most the square of the distance); exactly.
///
/// O(n) for few neighbours, about 0.15 µs a point and thread wherever its neighbours are. Memory: at most 13
/// bytes a point besides the result. Throws Error(out_of_range) for more than 2^32 - 1 points, and for
/// coordinates beyond 6e11 distances. Precondition: distance > 0.
[[nodiscard]] std::vector<std::uint8_t> far_from_others(const Context& context,
                                                        std::span<const Eigen::Vector3d> points,
                                                        double distance, unsigned min_neighbours);

}  // namespace ray
