#pragma once
/// The convex hull of points in space. Exact.

#include "hull_complex.h"

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

namespace ray {

/// In whole steps, within ±2^36.
using SpacePoint = std::array<std::int64_t, 3>;
inline constexpr std::int64_t kSpaceSteps = std::int64_t{1} << 36;

/// See HullComplex. Knows a place that is inside of the hull; sides are passed on the way around it.
class SpaceGeometry {
 public:
  static constexpr bool kInfinite = false;
  explicit SpaceGeometry(const std::vector<SpacePoint>& points) : points_(points) {}
  /// Four times the place inside: the sum of four points.
  void set_inside(const SpacePoint& four_times) { inside_ = four_times; }

  [[nodiscard]] bool sees(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t p) const {
    return volume(a, b, c, p) > 0;
  }
  [[nodiscard]] bool passes(std::uint32_t a, std::uint32_t b, std::uint32_t p) const {
    return determinant(from_inside(a), from_inside(b), from_inside(p)) < 0;
  }
  /// Of the tetrahedron, six times, above 0 if p is outside of a, b, c.
  [[nodiscard]] int volume(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t p) const {
    return determinant(between(a, b), between(a, c), between(a, p));
  }
  [[nodiscard]] Eigen::Vector3d inside() const {
    return 0.25 * Eigen::Vector3d(static_cast<double>(inside_[0]), static_cast<double>(inside_[1]),
                                  static_cast<double>(inside_[2]));
  }

 private:
  [[nodiscard]] SpacePoint between(std::uint32_t a, std::uint32_t b) const {
    const SpacePoint& from = points_[a];
    const SpacePoint& to = points_[b];
    return {to[0] - from[0], to[1] - from[1], to[2] - from[2]};
  }
  [[nodiscard]] SpacePoint from_inside(std::uint32_t p) const {
    const SpacePoint& to = points_[p];
    return {4 * to[0] - inside_[0], 4 * to[1] - inside_[1], 4 * to[2] - inside_[2]};
  }
  /// Its sign. Coordinates within ±2^40: 2^40 * 2^81 * 3 has 123 bits.
  static int determinant(const SpacePoint& a, const SpacePoint& b, const SpacePoint& c) {
    __extension__ using Wide = __int128;
    const auto minor = [&](std::size_t i, std::size_t j) { return Wide{a[i]} * b[j] - Wide{a[j]} * b[i]; };
    const Wide sum = minor(1, 2) * c[0] + minor(2, 0) * c[1] + minor(0, 1) * c[2];
    return sum > 0 ? 1 : sum < 0 ? -1 : 0;
  }

  const std::vector<SpacePoint>& points_;
  SpacePoint inside_{};
};

class SpaceHull {
 public:
  using Index = HullComplex<SpaceGeometry>::Index;

  /// The hull of all points. Nothing if they are in a plane. About 2 µs a point.
  [[nodiscard]] static std::unique_ptr<SpaceHull> make(std::vector<SpacePoint> points);
  SpaceHull(const SpaceHull&) = delete;
  SpaceHull& operator=(const SpaceHull&) = delete;

  [[nodiscard]] const HullComplex<SpaceGeometry>& complex() const { return *complex_; }
  /// Strictly inside.
  [[nodiscard]] bool holds(const SpacePoint& place);
  /// A place well inside, in steps.
  [[nodiscard]] Eigen::Vector3d inside() const { return geometry_.inside(); }
  /// By how much `direction`, of about 2^34 steps, from the place inside must be divided to end on the hull:
  /// its gauge function. Not thread-safe; quick near the direction asked for last.
  [[nodiscard]] double gauge(const Eigen::Vector3d& direction);

 private:
  explicit SpaceHull(std::vector<SpacePoint> points) : points_(std::move(points)) {}
  [[nodiscard]] std::optional<std::array<Index, 4>> find_first(const std::vector<std::uint32_t>& order) const;

  std::vector<SpacePoint> points_;  ///< one more than were given, for the direction asked for
  SpaceGeometry geometry_{points_};
  std::optional<HullComplex<SpaceGeometry>> complex_;
  Index asked_ = 0;
};

}  // namespace ray
