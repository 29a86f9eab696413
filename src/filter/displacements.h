#pragma once
/// How rays move along with the kept rays around them, where these moved in different ways.

#include "ray_groups.h"
#include "rigid_fit.h"

#include <cstdint>
#include <span>
#include <vector>

namespace ray {

/// The move of each kept ray relative to a pose, continued smoothly in between. Memory: 72 bytes a group.
class Displacements {
 public:
  Displacements(std::size_t groups, const Pose& pose);
  /// Where the kept ray of a group was and is.
  void set(std::uint32_t group, const Lines& was, std::size_t from, const Lines& is, std::size_t to);

  /// Moves rays that were given groups by `groups`, the first of which is number `row`: by the pose, and then
  /// by the mean of the moves around, exactly as its group's ray where it is that ray. With cubes, of the
  /// kept rays of the 27 cubes around the end, weighted by ((2 w - d) / d)² for a distance d < 2 w of the
  /// ends (Shepard's method in the form of Franke and Nielson 1980); else of its group's ray and the next
  /// group's, by row number. Rays of removed groups stay. Thread-safe.
  void move(RayCloud& rays, const RayGroups& groups, std::span<const std::uint32_t> group,
            std::uint64_t row) const;

 private:
  struct Move {
    Eigen::Vector3d start = Eigen::Vector3d::Zero();
    Eigen::Vector3d end = Eigen::Vector3d::Zero();
  };
  [[nodiscard]] bool has(std::uint32_t group) const { return group < known_.size() && known_[group] != 0; }
  [[nodiscard]] Move around(const Eigen::Vector3d& end, std::uint32_t group, const RayGroups& groups) const;
  [[nodiscard]] Move between(std::uint64_t row, std::uint32_t group, std::uint64_t every) const;

  Pose pose_;
  std::vector<std::uint8_t> known_;
  std::vector<Eigen::Vector3d> ends_;  // of the original rays
  std::vector<Move> moves_;
};

}  // namespace ray
