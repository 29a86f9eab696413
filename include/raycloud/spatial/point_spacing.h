#pragma once
/// How far apart the points of a surface are.

#include <raycloud/core/units.h>

#include <Eigen/Core>
#include <cstdint>
#include <span>

namespace ray {

/// The spacing that `point_count` points would have if they were spread evenly over the surfaces they lie on:
/// √(area / point_count). The area is measured on a sample of the points: the cubes of the smallest width (a
/// power of two of a metre) that hold 8 or more sample points on average are counted, and a surface of area A
/// in a random direction meets 1.5 A / width² of them (Cauchy's formula). True to about a third on surfaces,
/// and only an order of magnitude in foliage. 0 if there are fewer than 8 sample points or they do not
/// extend. Cost: O(sample) for each of some 20 widths. Deterministic.
[[nodiscard]] Metres estimate_spacing(std::span<const Eigen::Vector3d> sample, std::uint64_t point_count);

}  // namespace ray
