#include "face_contact.h"

#include <raycloud/core/bounds.h>
#include <raycloud/mesh/topology.h>

#include <algorithm>
#include <utility>

namespace ray {
namespace {

using FacePair = std::array<std::uint32_t, 2>;

/// A tree of boxes around faces, each half as many as in the one above, that is met with itself.
class BoxTree {
 public:
  explicit BoxTree(const Mesh& mesh) {
    for (std::uint32_t f = 0; f < mesh.faces.size(); ++f) {
      Leaf leaf{
          {mesh.vertices[mesh.faces[f][0]], mesh.vertices[mesh.faces[f][1]], mesh.vertices[mesh.faces[f][2]]},
          {},
          f};
      if (!has_exact_area(leaf.corners)) continue;
      for (const Eigen::Vector3d& corner : leaf.corners)
        leaf.bounds.add(corner);
      leaves_.push_back(leaf);
    }
    if (!leaves_.empty()) root_ = build(0, static_cast<std::uint32_t>(leaves_.size()));
  }

  [[nodiscard]] std::vector<FacePair> pairs() {
    if (!leaves_.empty()) meet_itself(root_);
    std::sort(pairs_.begin(), pairs_.end());
    return std::move(pairs_);
  }

 private:
  struct Leaf {
    TriangleCorners corners;
    Bounds bounds;
    std::uint32_t face = 0;
  };
  struct Node {
    Bounds bounds;
    std::uint32_t first = 0, last = 0;  ///< leaves
    std::uint32_t parts[2] = {0, 0};    ///< none if it has one leaf
  };

  std::uint32_t build(std::uint32_t first, std::uint32_t last) {
    Bounds bounds;
    for (std::uint32_t i = first; i < last; ++i)
      bounds.add(leaves_[i].bounds);
    const auto place = static_cast<std::uint32_t>(nodes_.size());
    nodes_.push_back({bounds, first, last, {0, 0}});
    if (last - first == 1) return place;
    Eigen::Index axis = 0;
    bounds.extent().maxCoeff(&axis);
    const std::uint32_t middle = first + (last - first) / 2;
    std::nth_element(leaves_.begin() + first, leaves_.begin() + middle, leaves_.begin() + last,
                     [&](const Leaf& a, const Leaf& b) {
                       return a.bounds.min[axis] + a.bounds.max[axis] <
                              b.bounds.min[axis] + b.bounds.max[axis];
                     });
    const std::uint32_t left = build(first, middle), right = build(middle, last);
    nodes_[place].parts[0] = left;
    nodes_[place].parts[1] = right;
    return place;
  }

  void meet_itself(std::uint32_t own) {
    if (is_leaf(own)) return;
    const auto [left, right] = nodes_[own].parts;
    meet_itself(left);
    meet_itself(right);
    meet(left, right);
  }

  void meet(std::uint32_t a, std::uint32_t b) {
    if (!overlap(nodes_[a].bounds, nodes_[b].bounds)) return;
    if (is_leaf(a) && is_leaf(b)) {
      const Leaf& left = leaves_[nodes_[a].first];
      const Leaf& right = leaves_[nodes_[b].first];
      if (meet_beyond_shared(left.corners, right.corners))
        pairs_.push_back({std::min(left.face, right.face), std::max(left.face, right.face)});
      return;
    }
    if (is_leaf(a) || nodes_[b].last - nodes_[b].first > nodes_[a].last - nodes_[a].first) std::swap(a, b);
    for (const std::uint32_t part : nodes_[a].parts)
      meet(part, b);
  }

  [[nodiscard]] bool is_leaf(std::uint32_t node) const { return nodes_[node].last - nodes_[node].first == 1; }
  static bool overlap(const Bounds& a, const Bounds& b) {
    return (a.min.array() <= b.max.array()).all() && (b.min.array() <= a.max.array()).all();
  }

  std::vector<Leaf> leaves_;
  std::vector<Node> nodes_;
  std::uint32_t root_ = 0;
  std::vector<FacePair> pairs_;
};

}  // namespace

std::vector<std::array<std::uint32_t, 2>> self_intersections(const Mesh& mesh) {
  return BoxTree(mesh).pairs();
}

}  // namespace ray
