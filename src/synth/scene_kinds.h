#pragma once
/// The builders behind make_scene.

#include <raycloud/synth/scene.h>

#include <cstdint>

namespace ray {

[[nodiscard]] Scene make_room(std::uint64_t seed);
[[nodiscard]] Scene make_building(std::uint64_t seed);
[[nodiscard]] Scene make_tree(std::uint64_t seed);
[[nodiscard]] Scene make_forest(std::uint64_t seed);
[[nodiscard]] Scene make_terrain(std::uint64_t seed);
[[nodiscard]] Scene make_field(std::uint64_t seed);

}  // namespace ray
