#pragma once
/// People and vehicles for a scene: what a map should forget.

#include <raycloud/synth/scene.h>

#include <cstdint>

namespace ray {

/// Adds up to `count` objects near the scanner's path, of which, in turn, one walks and stands by turns
/// ("stop and go", all the time where there is room for that), one comes once and passes ("appears once"),
/// and one is there from the beginning until it goes away for good ("leaves once"); the name says which.
/// Every fourth is a vehicle where one fits. They stay on the ground, clear of the scanner (0.9 m, a vehicle
/// 4 m), of what else is there at body height, and of each other; where no such way is found there are fewer.
///
/// Motion has a node every 0.1 s. Deterministic for a seed, on every machine. Cost: a SceneCaster of the
/// scene and up to a second a mover. Precondition: the scene's path is not empty.
[[nodiscard]] Scene with_movers(Scene scene, int count, std::uint64_t seed);

}  // namespace ray
