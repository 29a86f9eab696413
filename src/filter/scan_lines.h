#pragma once
/// Which beam was next to which when the sensor turned.

#include <raycloud/exec/context.h>

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

namespace ray {

/// Rays that hit something, in the order in which they were measured.
struct Beams {
  std::vector<Eigen::Vector3d> starts;  ///< m
  std::vector<Eigen::Vector3d> ends;    ///< m
  std::vector<std::uint32_t> rings;     ///< the laser of each, where the cloud knows it; else empty

  [[nodiscard]] std::size_t size() const { return ends.size(); }
};

/// For each beam the one before and the one after it on its line: of the beams measured shortly before and
/// after, those nearest in angle. For a sensor with many lasers that fire in turn these are of the same laser
/// wherever its lines are further apart than the beams on them.
struct ScanLines {
  static constexpr std::uint32_t kNone = 0xffffffff;
  std::vector<std::uint32_t> before, after;  ///< kNone: no beam was near enough
  std::size_t window = 0;                    ///< how far apart neighbours on a line are at most, in beams
  double step = 0.0;                         ///< the usual angle between them (rad)
  bool in_scan_order = false;                ///< whether there are lines at all; else the rest is empty
};

/// Time: O(n · lasers), about 12 ns for each. Memory: 8 bytes a beam.
[[nodiscard]] ScanLines find_scan_lines(const Context& context, const Beams& beams);

/// The ends `a` and `b` of two beams as seen from `start`: the tangent of the angle between them; infinite
/// for a right angle and more.
[[nodiscard]] double tangent_between(const Eigen::Vector3d& start, const Eigen::Vector3d& a,
                                     const Eigen::Vector3d& b);

}  // namespace ray
