#pragma once
/// Space cut into parts that hold about as many points each.

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace ray {

/// Cut in two by a plane across an axis, each half again, and so on, at the medians of a sample of the
/// points. Every point of space is in one part.
class SpaceCuts {
 public:
  /// At least `parts` parts, by the next power of two, or one where the sample is empty.
  SpaceCuts(std::vector<Eigen::Vector3d> sample, std::size_t parts);

  [[nodiscard]] std::size_t parts() const { return cuts_.size(); }
  /// About 1 ns for each halving.
  [[nodiscard]] std::size_t part_of(const Eigen::Vector3d& point) const {
    std::size_t node = 1;
    while (node < cuts_.size())
      node = 2 * node + (point[cuts_[node].axis] < cuts_[node].at ? 0 : 1);
    return node - cuts_.size();
  }
  /// The box of a part, without end where it has no neighbour.
  [[nodiscard]] Eigen::AlignedBox3d box_of(std::size_t part) const;
  /// Replaces `found` by the parts that may hold a point within `reach` of this one, its own among them.
  void parts_near(const Eigen::Vector3d& point, double reach, std::vector<std::uint32_t>& found) const;

 private:
  struct Cut {
    Eigen::Index axis = 0;
    double at = 0.0;  ///< points from here on are in the second half
  };
  void cut(std::size_t node, std::span<Eigen::Vector3d> sample);
  void find_near(std::size_t node, const Eigen::Vector3d& point, double reach,
                 std::vector<std::uint32_t>& found) const;

  std::vector<Cut> cuts_;  ///< the halves of number i are 2i and 2i + 1
};

}  // namespace ray
