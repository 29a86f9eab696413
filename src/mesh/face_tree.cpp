#include "face_tree.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace ray {
namespace {

double squared_distance(const Bounds& box, const Eigen::Vector3d& point) {
  return (box.min - point).cwiseMax(point - box.max).cwiseMax(0.0).squaredNorm();
}

/// About the middle of the box.
template <class Ball>
Ball ball_of(const Corners& corners) {
  Bounds box;
  for (const Eigen::Vector3d& corner : corners.at)
    box.add(corner);
  Ball ball{0.5 * (box.min + box.max), 0.0};
  for (const Eigen::Vector3d& corner : corners.at)
    ball.radius = std::max(ball.radius, (1.0 + 1e-12) * (corner - ball.centre).norm());
  return ball;
}

}  // namespace

/// What a node's child is.
struct FaceTree::Part {
  Bounds box;
  std::uint32_t child = 0;
  std::uint32_t first = 0;
  std::uint32_t count = 0;
};

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
  slack_ = 1e-18 * all.extent().squaredNorm();
  const Part root = build(0, static_cast<std::uint32_t>(leaves_.size()), centres);
  if (root.count > 0) {  // a mesh of few faces: a node with one child that is empty
    Node& node = nodes_.emplace_back();
    node.boxes[0] = root.box;
    node.count[0] = root.count;
  }
  for (const Leaf& leaf : leaves_)
    balls_.push_back(ball_of<Ball>(leaf.corners));
  places_.resize(leaves_.size());
  for (std::uint32_t i = 0; i < leaves_.size(); ++i)
    places_[leaves_[i].face] = i;
}

Bounds FaceTree::box_of(std::uint32_t begin, std::uint32_t end) const {
  Bounds box;
  for (std::uint32_t i = begin; i < end; ++i) {
    for (const Eigen::Vector3d& corner : leaves_[i].corners.at)
      box.add(corner);
  }
  return box;
}

FaceTree::Part FaceTree::build(std::uint32_t begin, std::uint32_t end,
                               const std::vector<Eigen::Vector3d>& centres) {
  if (end - begin <= kLeafFaces) return {box_of(begin, end), 0, begin, end - begin};
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
    nodes_[place].boxes[i] = parts[i].box;
    nodes_[place].child[i] = parts[i].child;
    nodes_[place].first[i] = parts[i].first;
    nodes_[place].count[i] = parts[i].count;
    box.add(parts[i].box);
  }
  return {box, place, 0, 0};
}

NearestFace FaceTree::find(const Eigen::Vector3d& point, std::uint32_t near, double enough) const {
  NearestFace best{
      nearest_on_face(point, leaves_[places_[near]].corners, std::numeric_limits<double>::infinity()), near};
  const auto bound = [&] { return best.nearest.squared * (1.0 + 1e-12) + slack_; };
  double reach = std::sqrt(bound());
  const auto look_at = [&](std::uint32_t first, std::uint32_t count) {
    for (std::uint32_t i = first; i < first + count; ++i) {
      const double touching = reach + balls_[i].radius;
      if ((point - balls_[i].centre).squaredNorm() > touching * touching) continue;
      const NearestPlace found = nearest_on_face(point, leaves_[i].corners, bound());
      const bool wins = found.squared < best.nearest.squared ||
                        (found.squared == best.nearest.squared && leaves_[i].face < best.face);
      if (!wins) continue;
      best = {found, leaves_[i].face};
      reach = std::sqrt(bound());
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
    const double squared[2] = {squared_distance(node.boxes[0], point),
                               squared_distance(node.boxes[1], point)};
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
