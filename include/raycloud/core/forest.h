#pragma once
/// Trees as tapering cylinders.

#include <Eigen/Core>
#include <cstddef>
#include <limits>
#include <string>
#include <vector>

namespace ray {

/// A segment runs from the position of its parent to its own; the first segment of a tree is its foot and has
/// no parent and no length.
struct TreeSegment {
  static constexpr std::size_t kNoParent = std::numeric_limits<std::size_t>::max();
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< m, of the upper end
  double radius = 0.0;                                 ///< m
  std::size_t parent = kNoParent;                      ///< index into the segments of its tree, below its own
  std::vector<double> attributes;                      ///< one for each Forest::segment_attributes
};

struct Tree {
  std::vector<double> attributes;  ///< one for each Forest::tree_attributes
  std::vector<TreeSegment> segments;
};

/// The content of a tree file. A tree of which only place and size are known has one segment.
struct Forest {
  std::vector<std::string> comments;
  std::vector<std::string> tree_attributes;     ///< names, without spaces and commas
  std::vector<std::string> segment_attributes;  ///< names besides x, y, z, radius, parent_id
  std::vector<Tree> trees;
};

}  // namespace ray
