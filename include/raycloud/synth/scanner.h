#pragma once
/// Lidars: which way they look, and when. A scanner knows nothing of surfaces.

#include <raycloud/core/trajectory.h>

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace ray {

/// A spinning multi-beam lidar that is carried along the scene's path. Its beams fan out by 45 degrees around
/// the plane of the spin (9.6 turns a second), whose axis leans by 75 degrees and itself turns slowly (0.31
/// turns a second), so that everything around comes into view, the sky and the ground included.
struct SpinningScanner {
  int beams = 32;  ///< 1 to 1024
};

/// A terrestrial scanner that stands at the scene's stations one after the other and looks all around in a
/// raster of equal angles, but for a cone of 30 degrees about the nadir, where its tripod is.
struct StandingScanner {};

/// One ray before it meets anything.
struct Shot {
  double time = 0.0;                                     ///< s
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();      ///< m
  Eigen::Vector3d direction = Eigen::Vector3d::UnitX();  ///< of unit length
};

/// The shots of a whole scan, by number. Times grow with the number and cover the path's, whatever the count:
/// a longer scan is a denser one. On a path of one node all rays have its time and the scanner still looks
/// all around. Made of + - * / and square roots only: the same bits on every machine.
class ScanPlan {
 public:
  /// Precondition: the path is not empty. Throws Error(usage) for beams out of range.
  ScanPlan(const SpinningScanner& scanner, const Trajectory& path, std::uint64_t count);
  /// The stations share the path's time equally. Preconditions: neither is empty.
  ScanPlan(const StandingScanner& scanner, const Trajectory& path, std::vector<Eigen::Vector3d> stations,
           std::uint64_t count);

  [[nodiscard]] std::uint64_t count() const { return count_; }

  /// Precondition: `number < count()`. `hint` is the node of the path for a shot nearby; 0 will do. O(1).
  [[nodiscard]] Shot shot(std::uint64_t number, std::size_t hint = 0) const;
  /// The node of the path at that shot, to be a hint.
  [[nodiscard]] std::size_t node(std::uint64_t number) const;

 private:
  [[nodiscard]] double time(std::uint64_t number) const;
  [[nodiscard]] Shot spinning_shot(std::uint64_t number, std::size_t hint) const;
  [[nodiscard]] Shot standing_shot(std::uint64_t number) const;

  Trajectory path_;
  std::uint64_t count_ = 0;
  std::vector<Eigen::Vector2d> beams_;  ///< (cosine, sine) of the elevations; empty for a standing scanner
  std::vector<Eigen::Vector3d> stations_;
};

}  // namespace ray
