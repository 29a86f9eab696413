#pragma once
/// Points that rays pass closely by, on their way to something behind: what was hit there may be no thing.

#include <raycloud/spatial/key_table.h>

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace ray {

/// Points with balls of one radius around them, and how many rays went through each of the balls.
///
/// A ray goes through if it comes nearer to the point than the radius, and its end is more than the radius
/// further on than where it does: what hits the surface on which the point lies, and what hits one beside it,
/// does not.
///
/// Memory: 28 bytes a point, 8 for each of the up to 8 cubes that its ball touches, and some 150 for
/// each brick of 8³ cubes.
class SeenThrough {
 public:
  /// Preconditions: radius > 0 if there are points, and there are less than 2^29.
  SeenThrough(std::vector<Eigen::Vector3d> points, double radius);

  /// Counts a ray. Thread-safe. It visits the bricks on its way (Amanatides and Woo 1987) and, in those with
  /// points, the cubes.
  void add(const Eigen::Vector3d& start, const Eigen::Vector3d& end, bool bounded);

  [[nodiscard]] std::size_t size() const { return points_.size(); }
  /// How many of the rays went through the ball of a point.
  [[nodiscard]] std::uint32_t passes(std::size_t point) const { return passes_[point]; }

 private:
  /// Which of its cubes have points, a word for each layer, and the number of the first one's list.
  struct Brick {
    std::array<std::uint64_t, 8> cubes{};
    std::array<std::uint32_t, 8> first{};
  };
  /// A cube by its brick and its place in that.
  struct Cube {
    std::size_t brick;
    std::size_t layer;
    std::uint64_t bit;
  };
  template <class Visit>
  void each_cube_of_ball(const Eigen::Vector3d& point, const Visit& visit);
  [[nodiscard]] std::uint32_t list_of(const Cube& cube) const;
  void mark_bricks();
  [[nodiscard]] bool may_have(const VoxelIndex& number) const {
    const std::uint64_t hash = hash_of(number) & (64 * maybe_.size() - 1);
    return (maybe_[hash / 64] >> (hash % 64) & 1) != 0;
  }
  static std::uint64_t hash_of(const VoxelIndex& number);
  void visit_brick(const VoxelIndex& number, const Eigen::Vector3d& start, const Eigen::Vector3d& direction,
                   double in, double out);

  std::vector<Eigen::Vector3d> points_;
  std::vector<std::uint32_t> passes_;
  double radius_;
  double width_;                               // of a cube
  VoxelTable<std::uint32_t> numbers_;          // of bricks, from 1
  std::vector<VoxelIndex> numbers_of_bricks_;  // while they are made
  std::vector<std::uint64_t> maybe_;           // bits by the hash of a brick: 0 where there is none
  std::vector<Brick> bricks_;                  // by number
  std::vector<std::uint32_t> list_begins_;     // in listed_, of each cube with points
  std::vector<std::uint32_t> listed_;          // points, in as many lists as their balls touch cubes
};

}  // namespace ray
