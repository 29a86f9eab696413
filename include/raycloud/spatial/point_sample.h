#pragma once
/// An even sample of a stream of points, in bounded memory.

#include <Eigen/Core>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace ray {

/// At most `capacity` of the points added, chosen by a hash of their coordinates: all points at first, then
/// one in 2, 4, 8 … as they become too many. Which points are chosen depends on the points alone, not on
/// their order, the threads or the chunks. Points at the same place are chosen or left out together.
class PointSample {
 public:
  explicit PointSample(std::size_t capacity) : capacity_(capacity) {}

  /// The points of rows with mask[i] != 0 that may still be chosen, for add(). Thread-safe, also against
  /// add(). About 2 ns a point.
  [[nodiscard]] std::vector<Eigen::Vector3d> candidates(std::span<const Eigen::Vector3d> points,
                                                        std::span<const std::uint8_t> mask) const;
  /// One thread at a time; the order of calls decides the order of points().
  void add(std::span<const Eigen::Vector3d> candidates);
  [[nodiscard]] const std::vector<Eigen::Vector3d>& points() const { return points_; }

 private:
  [[nodiscard]] static bool chosen(const Eigen::Vector3d& point, int level);

  std::size_t capacity_;
  std::atomic<int> level_ = 0;  // one in 2^level is kept
  std::vector<Eigen::Vector3d> points_;
};

}  // namespace ray
