#pragma once
/// Which cubes of a brick a ray can cross on its way from one cube to another.

#include <array>
#include <cstddef>
#include <cstdint>

namespace ray {

/// The cubes of a brick whose number along an axis is from `low` to `high`.
constexpr std::uint64_t cubes_in_range(std::size_t axis, int low, int high) {
  std::uint64_t cubes = 0;
  for (int bit = 0; bit < 64; bit++) {
    const int number = bit >> 2 * axis & 3;
    if (number >= low && number <= high) cubes |= std::uint64_t{1} << bit;
  }
  return cubes;
}

/// For a way of 4 cubes or less along an axis, from one brick to the same or the next, the cubes of those two
/// bricks that are not beside it. Where the way could be 4 up as well as 4 down: all.
struct CubesBetween {
  std::array<std::uint64_t, 64> first{};
  std::array<std::uint64_t, 64> last{};

  /// By the lowest three bits of the numbers of both cubes: those tell whether the bricks differ.
  static std::size_t index(std::int32_t from, std::int32_t to) {
    return static_cast<std::size_t>((from & 7) | (to & 7) << 3);
  }

  constexpr explicit CubesBetween(std::size_t axis) {
    for (int i = 0; i < 64; i++) {
      const int from = i & 3, to = i >> 3 & 3, up = ((i >> 3) - i) & 7;
      const bool is_one_brick = (i >> 2 & 1) == i >> 5;
      const auto at = static_cast<std::size_t>(i);
      if (is_one_brick)
        first[at] = last[at] = cubes_in_range(axis, from < to ? from : to, from < to ? to : from);
      else if (up == 4)
        first[at] = last[at] = ~std::uint64_t{0};
      else {
        first[at] = up < 4 ? cubes_in_range(axis, from, 3) : cubes_in_range(axis, 0, from);
        last[at] = up < 4 ? cubes_in_range(axis, 0, to) : cubes_in_range(axis, to, 3);
      }
    }
  }
};

inline constexpr std::array<CubesBetween, 3> kCubesBetween{CubesBetween(0), CubesBetween(1), CubesBetween(2)};

}  // namespace ray
