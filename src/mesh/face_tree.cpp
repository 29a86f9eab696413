#include "face_tree.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace ray {

/// What a node's child is.
struct FaceTree::Part {
  Bounds bounds;
  std::uint32_t child = 0;
  std::uint32_t first = 0;
  std::uint32_t count = 0;
};

FaceTree::Box FaceTree::boxed(const Bounds& bounds) const {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  Box box;
  for (int axis = 0; axis < 3; ++axis) {
    const auto i = static_cast<std::size_t>(axis);
    box.low[i] = std::nextafter(static_cast<float>(bounds.min[axis] - centre_[axis]), -kInfinity);
    box.high[i] = std::nextafter(static_cast<float>(bounds.max[axis] - centre_[axis]), kInfinity);
  }
  return box;
}

double FaceTree::squared_distance(const Box& box, const Eigen::Vector3d& local) {
  double sum = 0.0;
  for (std::size_t i = 0; i < 3; ++i) {
    const double at = local[static_cast<Eigen::Index>(i)];
    const double away = std::max({double{box.low[i]} - at, at - double{box.high[i]}, 0.0});
    sum += away * away;
  }
  return sum;
}

FaceTree::FaceTree(const Mesh& mesh) {
  Bounds all;
  std::vector<Eigen::Vector3d> centres;
  for (std::uint32_t f = 0; f < mesh.faces.size(); ++f) {
    Leaf& leaf = leaves_.emplace_back();
    leaf.face = f;
    leaf.corners.vertices = mesh.faces[f];
    Bounds box;
    for (std::size_t i = 0; i < 3; ++i)
      box.add(leaf.corners.at[i] = mesh.vertices[mesh.faces[f][i]]);
    all.add(box);
    centres.emplace_back(box.min + box.max);
  }
  centre_ = 0.5 * (all.min + all.max);
  slack_ = 1e-18 * all.extent().squaredNorm();
  const Part root = build(0, static_cast<std::uint32_t>(leaves_.size()), centres);
  if (root.count > 0) {  // a mesh of few faces: a node with one child that is empty
    Node& node = nodes_.emplace_back();
    node.boxes[0] = boxed(root.bounds);
    node.boxes[1].low.fill(std::numeric_limits<float>::infinity());
    node.boxes[1].high.fill(-std::numeric_limits<float>::infinity());
    node.count[0] = root.count;
  }
  for (std::uint32_t i = 0; i < leaves_.size(); ++i)
    boxes_.push_back(boxed(bounds_of(i, i + 1)));
  places_.resize(leaves_.size());
  for (std::uint32_t i = 0; i < leaves_.size(); ++i)
    places_[leaves_[i].face] = i;
}

Bounds FaceTree::bounds_of(std::uint32_t begin, std::uint32_t end) const {
  Bounds box;
  for (std::uint32_t i = begin; i < end; ++i) {
    for (const Eigen::Vector3d& corner : leaves_[i].corners.at)
      box.add(corner);
  }
  return box;
}

FaceTree::Part FaceTree::build(std::uint32_t begin, std::uint32_t end,
                               const std::vector<Eigen::Vector3d>& centres) {
  if (end - begin <= kLeafFaces) return {bounds_of(begin, end), 0, begin, end - begin};
  Bounds spread;
  for (std::uint32_t i = begin; i < end; ++i)
    spread.add(centres[leaves_[i].face]);
  Eigen::Index axis = 0;
  spread.extent().maxCoeff(&axis);
  // Leaves are full but for the last, so that half the boxes are not wasted.
  const std::uint32_t half = ((end - begin) / 2 + kLeafFaces - 1) / kLeafFaces * kLeafFaces;
  const auto at = [&](std::uint32_t i) { return leaves_.begin() + static_cast<std::ptrdiff_t>(i); };
  std::nth_element(at(begin), at(begin + half), at(end), [&](const Leaf& a, const Leaf& b) {
    const double of_a = centres[a.face][axis];
    const double of_b = centres[b.face][axis];
    return of_a < of_b || (of_a == of_b && a.face < b.face);
  });
  const auto place = static_cast<std::uint32_t>(nodes_.size());
  nodes_.emplace_back();
  const Part parts[2] = {build(begin, begin + half, centres), build(begin + half, end, centres)};
  Bounds box;
  for (std::size_t i = 0; i < 2; ++i) {
    nodes_[place].boxes[i] = boxed(parts[i].bounds);
    nodes_[place].child[i] = parts[i].child;
    nodes_[place].first[i] = parts[i].first;
    nodes_[place].count[i] = parts[i].count;
    box.add(parts[i].bounds);
  }
  return {box, place, 0, 0};
}

NearestFace FaceTree::find(const Eigen::Vector3d& point, std::uint32_t near, double enough) const {
  NearestFace best{
      nearest_on_face(point, leaves_[places_[near]].corners, std::numeric_limits<double>::infinity()), near};
  const Eigen::Vector3d local = point - centre_;
  const auto bound = [&] { return best.nearest.squared * (1.0 + 1e-12) + slack_; };
  double reach = bound();
  const auto look_at = [&](std::uint32_t first, std::uint32_t count) {
    for (std::uint32_t i = first; i < first + count; ++i) {
      if (squared_distance(boxes_[i], local) > reach) continue;
      const NearestPlace found = nearest_on_face(point, leaves_[i].corners, bound());
      const bool wins = found.squared < best.nearest.squared ||
                        (found.squared == best.nearest.squared && leaves_[i].face < best.face);
      if (!wins) continue;
      best = {found, leaves_[i].face};
      reach = bound();
    }
  };
  struct Waiting {
    std::uint32_t node;
    double squared;
  };
  std::array<Waiting, 64> waiting;  // the tree is balanced, so 2^32 faces are 31 deep
  std::size_t count = 0;
  std::uint32_t at = 0;
  while (best.nearest.squared >= enough) {
    const Node& node = nodes_[at];
    const double squared[2] = {squared_distance(node.boxes[0], local),
                               squared_distance(node.boxes[1], local)};
    const std::size_t nearer = squared[1] < squared[0] ? 1 : 0;
    bool down = false;
    for (const std::size_t i : {1 - nearer, nearer}) {  // the nearer one comes last and is gone into next
      if (node.count[i] > 0 || !(squared[i] <= bound())) continue;
      waiting[count++] = {node.child[i], squared[i]};
    }
    for (const std::size_t i : {nearer, 1 - nearer})
      if (node.count[i] > 0 && squared[i] <= bound()) look_at(node.first[i], node.count[i]);
    while (count > 0 && !down) {
      --count;
      down = waiting[count].squared <= bound();
    }
    if (!down) break;
    at = waiting[count].node;
  }
  return best;
}

}  // namespace ray
