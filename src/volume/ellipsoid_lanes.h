#pragma once
/// Which of eight boxes or ellipsoids a line may meet: the inner loops of EllipsoidTree.

#include <array>
#include <cstdint>

namespace ray {

inline constexpr std::size_t kEightLanes = 8;
using EightFloats = std::array<float, kEightLanes>;

/// A line from `from` on, and how far it goes, m.
struct LineInBoxes {
  std::array<float, 3> from{};
  std::array<float, 3> inverse{};  ///< 1 / its direction
  float reach = 0.0F;
};
/// A bit for each box that the line touches.
[[nodiscard]] std::uint32_t boxes_on_line(const std::array<EightFloats, 3>& min,
                                          const std::array<EightFloats, 3>& max, const LineInBoxes& line);

/// A line by a point of it near the ellipsoids, and where it begins, is late and ends, m from there.
struct LineAtEllipsoids {
  std::array<float, 3> at{};
  std::array<float, 3> direction{};  ///< unit
  float start = 0.0F;
  float late = 0.0F;
  float end = 0.0F;
};
/// A bit for each ellipsoid.
struct CrossedLanes {
  std::uint32_t perhaps = 0;  ///< the line may cross it
  std::uint32_t late = 0;     ///< and surely crosses it, and leaves it surely later than `late`
};
/// Of ellipsoids as a pack has them: shapes are xx, xy, xz, yy, yz, zz.
[[nodiscard]] CrossedLanes ellipsoids_on_line(const std::array<EightFloats, 3>& centre,
                                              const std::array<EightFloats, 6>& shape,
                                              const LineAtEllipsoids& line);

/// The same, without what only some processors have: what the others do where they must, and a test's oracle.
namespace plain {
[[nodiscard]] std::uint32_t boxes_on_line(const std::array<EightFloats, 3>& min,
                                          const std::array<EightFloats, 3>& max, const LineInBoxes& line);
[[nodiscard]] CrossedLanes ellipsoids_on_line(const std::array<EightFloats, 3>& centre,
                                              const std::array<EightFloats, 6>& shape,
                                              const LineAtEllipsoids& line);
}  // namespace plain

/// A form in single precision is wrong by so much of the largest product in it, which is at most the trace of
/// the shape times the squared lengths.
inline constexpr float kFormRounding = 1e-6F;
/// Of the longest chord, and of the squared one: what the rounding of places may do, with room.
inline constexpr float kChordRoom = 0.01F;

}  // namespace ray
