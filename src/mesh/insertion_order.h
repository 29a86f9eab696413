#pragma once
/// In which order points are added to a hull or a triangulation: in rounds, each of about twice as many as
/// all before, so that few faces are made in vain, and within a round along a curve that fills the space, so
/// that each lies near the one before (Amenta, Choi and Rote, "Incremental constructions con BRIO", 2003).

#include <array>
#include <cstdint>
#include <vector>

namespace ray {

/// A permutation of the points, whose coordinates are in [0, 2^31). The same on every machine.
[[nodiscard]] std::vector<std::uint32_t> insertion_order(
    const std::vector<std::array<std::uint32_t, 2>>& points);
[[nodiscard]] std::vector<std::uint32_t> insertion_order(
    const std::vector<std::array<std::uint32_t, 3>>& points);

/// How far along the curve a point of such coordinates lies, which is told in steps of 2^11 along each axis.
/// In the plane it has kPlaneCurveBits; the upper ones alone are the place in larger steps.
inline constexpr int kPlaneCurveBits = 40;
[[nodiscard]] std::uint64_t place_on_curve(const std::array<std::uint32_t, 2>& point);
[[nodiscard]] std::uint64_t place_on_curve(const std::array<std::uint32_t, 3>& point);

/// Of points that follow the curve already: by round only.
[[nodiscard]] std::vector<std::uint32_t> insertion_order_along_curve(std::size_t points);

}  // namespace ray
