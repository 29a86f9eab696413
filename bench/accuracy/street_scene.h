#pragma once
/// A street in which people and vehicles come, go and move, between things that rays pass through all the
/// time.

#include <raycloud/synth/scene.h>

#include <Eigen/Core>
#include <cstdint>

namespace bench {

/// 50 m by 20 m: roadway and pavements, house fronts with piers, a hedge, a wire fence, poles, trees and
/// parked cars; the scanner walks up and down twice. With `movers`, besides what `ray::with_movers` adds, one
/// parked car leaves half-way and another comes.
[[nodiscard]] ray::Scene street_scene(std::uint64_t seed, int movers);

/// A hedge alone, of leaves that are triangles of `blade` m, `density` m² of them (one side) in a m³, that
/// face anywhere. The scanner walks around it once.
[[nodiscard]] ray::Scene hedge_scene(double density, double blade, std::uint64_t seed);
inline const Eigen::Vector3d kHedgeLow(-2.0, -0.75, 0.0);  ///< m
inline const Eigen::Vector3d kHedgeHigh(2.0, 0.75, 1.5);   ///< m

}  // namespace bench
