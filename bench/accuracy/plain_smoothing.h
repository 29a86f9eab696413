#pragma once
/// What smoothing is worth without rays: the usual projection onto the plane of the neighbours.

#include <Eigen/Core>
#include <vector>

namespace bench {

/// Two passes; in each, every point goes along the normal onto the plane of itself and its 16 nearest
/// neighbours.
[[nodiscard]] std::vector<Eigen::Vector3d> plainly_smoothed(std::vector<Eigen::Vector3d> points);

}  // namespace bench
