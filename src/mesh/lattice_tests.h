#pragma once
/// Questions about points of a lattice whose answers are exact: in double where that is certain, in whole
/// numbers where not.

#include <array>
#include <cstdint>

namespace ray {

/// In whole steps, each in [0, 2^30).
using LatticePoint = std::array<std::int32_t, 3>;
inline constexpr std::int32_t kLatticeSteps = std::int32_t{1} << 30;

/// 1 if d is in front of a, b, c (which run anticlockwise as seen from there), -1 behind, 0 in their plane.
[[nodiscard]] int side_of_plane(const LatticePoint& a, const LatticePoint& b, const LatticePoint& c,
                                const LatticePoint& d);

/// 1 if p is inside of the sphere through a, b, c and d, -1 outside. Where it is on the sphere the ranks of
/// the five points decide (no two the same): each point is taken to be raised above the paraboloid of
/// Delaunay by an amount too small to matter otherwise, and the more the higher its rank (after Devillers
/// and Teillaud, "Perturbations for Delaunay and weighted Delaunay 3D triangulations", 2011). So the
/// triangulation of Delaunay is one, whatever lies on circles and lattices. Precondition: d is in front of
/// a, b, c.
[[nodiscard]] int side_of_sphere(const std::array<LatticePoint, 4>& corners,
                                 const std::array<std::uint32_t, 4>& ranks, const LatticePoint& p,
                                 std::uint32_t rank);

struct Sphere {
  std::array<double, 3> centre;  ///< from the first of its corners
  double squared_radius;
};

/// The sphere through the four, in steps, correct to some 1e-15 of the radius. Precondition: they are not in
/// a plane.
[[nodiscard]] Sphere sphere_of(const std::array<LatticePoint, 4>& corners);

/// Across the plane of a, b and c, towards where they run anticlockwise as seen from.
[[nodiscard]] std::array<double, 3> normal_of(const LatticePoint& a, const LatticePoint& b,
                                              const LatticePoint& c);

}  // namespace ray
