#pragma once
/// A street in which people and vehicles come, go and move, between things that rays pass through all the
/// time.

#include <raycloud/synth/scene.h>

#include <cstdint>

namespace bench {

constexpr double kHedgeDensity = 4.0;  ///< m² of leaf, one side, in a m³; leaves face anywhere

/// 50 m by 20 m: roadway and pavements, house fronts with piers, a hedge, a wire fence, poles, trees and
/// parked cars; the scanner walks up and down twice. With `movers`, besides what `ray::with_movers` adds, one
/// parked car leaves half-way and another comes.
[[nodiscard]] ray::Scene street_scene(std::uint64_t seed, int movers);

}  // namespace bench
