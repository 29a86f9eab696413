#pragma once
/// An order of points in which a tree of boxes can be laid over them without pointers.

#include <raycloud/exec/context.h>

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

namespace ray {

/// Cuts the points in two across the longest side of their box, again and again, such that every part begins
/// at a multiple of its size and all sizes are 8 times a power of two, but for what is left at the end. So
/// points [8 · 4^k · i, 8 · 4^k · (i + 1)) are near each other for every k and i. Returns the index of each
/// point in that order, which is the same for any number of threads. O(n log n); 16 bytes a point.
[[nodiscard]] std::vector<std::uint32_t> spatial_order(
    const Context& context, std::size_t count, const std::function<Eigen::Vector3f(std::size_t)>& point);

}  // namespace ray
