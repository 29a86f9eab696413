#pragma once
/// By how much one cloud must rise to lie on another, where turn and horizontal shift are given.

#include "coarse.h"
#include "patches.h"

#include <Eigen/Core>
#include <span>
#include <vector>

namespace ray::align {

/// The heights of level surfaces, by where they are.
class LevelHeights {
 public:
  LevelHeights(const std::vector<Patch>& patches, double width);

  /// The most frequent differences (m) between a level surface of the reference and one of the cloud that is
  /// seen from the same side, above or below each other: at most `most`, the most frequent first.
  [[nodiscard]] std::vector<double> rises(std::span<const Patch> cloud, const Candidate& candidate,
                                          std::size_t most) const;

 private:
  struct Height {
    std::uint64_t column;
    float height;
    bool up;
  };
  [[nodiscard]] std::uint64_t column_of(const Eigen::Vector2d& place) const;

  double width_;
  std::vector<Height> heights_;  // by column
};

/// Those patches that have a height to compare: level ones, or all where there are few.
[[nodiscard]] std::vector<Patch> level_patches(const std::vector<Patch>& patches, std::size_t most);

}  // namespace ray::align
