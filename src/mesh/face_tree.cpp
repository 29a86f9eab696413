#include "face_tree.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace ray {
namespace {

constexpr double kSingleStep = 2.4e-7;  // of a coordinate, after its rounding and a few operations
constexpr float kNowhere = std::numeric_limits<float>::max();

}  // namespace

FaceTree::FaceTree(const Mesh& mesh) {
  Bounds all;
  std::vector<Eigen::Vector3d> centres;
  faces_.reserve(mesh.faces.size());
  centres.reserve(mesh.faces.size());
  for (std::uint32_t f = 0; f < mesh.faces.size(); ++f) {
    Leaf& leaf = faces_.emplace_back();
    leaf.face = f;
    leaf.corners.vertices = mesh.faces[f];
    Bounds box;
    for (std::size_t i = 0; i < 3; ++i)
      box.add(leaf.corners.at[i] = mesh.vertices[mesh.faces[f][i]]);
    for (std::size_t i = 0; i < 3; ++i) {
      const Eigen::Vector3d side = leaf.corners.at[(i + 1) % 3] - leaf.corners.at[i];
      leaf.spread = std::max(leaf.spread, side.squaredNorm() / 3.0);
    }
    all.add(box);
    centres.emplace_back(box.min + box.max);
  }
  centre_ = 0.5 * (all.min + all.max);
  half_size_ = 0.5 * all.extent().norm();
  Bounds bounds;
  build(0, static_cast<std::uint32_t>(faces_.size()), centres, bounds);
  places_.resize(faces_.size());
  for (std::uint32_t i = 0; i < faces_.size(); ++i)
    places_[faces_[i].face] = i;
}

/// In two halves along the longest side of their centres; returns where the second begins.
std::uint32_t FaceTree::split(std::uint32_t begin, std::uint32_t end,
                              const std::vector<Eigen::Vector3d>& centres) {
  Bounds spread;
  for (std::uint32_t i = begin; i < end; ++i)
    spread.add(centres[faces_[i].face]);
  Eigen::Index axis = 0;
  spread.extent().maxCoeff(&axis);
  const std::uint32_t middle = begin + (end - begin) / 2;
  const auto at = [&](std::uint32_t i) { return faces_.begin() + static_cast<std::ptrdiff_t>(i); };
  std::nth_element(at(begin), at(middle), at(end), [&](const Leaf& a, const Leaf& b) {
    const double of_a = centres[a.face][axis];
    const double of_b = centres[b.face][axis];
    return of_a < of_b || (of_a == of_b && a.face < b.face);
  });
  return middle;
}

void FaceTree::set_child(Node& node, std::uint32_t child, const Bounds& bounds) const {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  const std::size_t i = node.count++;
  node.child[i] = child;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<Eigen::Index>(axis);
    node.low[axis][i] = std::nextafter(static_cast<float>(bounds.min[a] - centre_[a]), -kInfinity);
    node.high[axis][i] = std::nextafter(static_cast<float>(bounds.max[a] - centre_[a]), kInfinity);
  }
}

std::uint32_t FaceTree::build(std::uint32_t begin, std::uint32_t end,
                              const std::vector<Eigen::Vector3d>& centres, Bounds& bounds) {
  std::array<std::uint32_t, kWide + 1> cuts{begin, begin, begin, end, end};
  if (end - begin <= kWide) {
    for (std::uint32_t i = 0; i <= kWide; ++i)
      cuts[i] = std::min(begin + i, end);
  } else {
    cuts[2] = split(begin, end, centres);
    cuts[1] = split(begin, cuts[2], centres);
    cuts[3] = split(cuts[2], end, centres);
  }
  const auto place = static_cast<std::uint32_t>(nodes_.size());
  nodes_.emplace_back();
  Node node;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    node.low[axis].fill(kNowhere);
    node.high[axis].fill(kNowhere);
  }
  for (std::size_t part = 0; part < kWide; ++part) {
    const std::uint32_t first = cuts[part];
    const std::uint32_t last = cuts[part + 1];
    if (first == last) continue;
    Bounds own;
    std::uint32_t child = first | kFaceBit;
    if (last - first > 1) {
      child = build(first, last, centres, own);
    } else {
      for (const Eigen::Vector3d& corner : faces_[first].corners.at)
        own.add(corner);
    }
    set_child(node, child, own);
    bounds.add(own);
  }
  nodes_[place] = node;
  return place;
}

/// One point's search: the best so far, and how near in single precision a box must be to matter.
struct FaceTree::Search {
  Search(const FaceTree& tree, const Eigen::Vector3d& at, double most)
      : point(at), local((at - tree.centre_).cast<float>()) {
    const double largest = (at - tree.centre_).cwiseAbs().maxCoeff() + tree.half_size_;
    slack = kSingleStep * largest;
    best.nearest.squared = most;
    best.face = kNoFace;
    set_reach();
  }

  void set_reach() {
    const double distance = std::sqrt(best.nearest.squared) + slack;
    reach = static_cast<float>(std::min(distance * distance * (1.0 + 1e-6), 1e38));
  }

  void look_at(const Leaf& leaf) {
    const double bound = best.nearest.squared * (1.0 + 1e-12) + slack * slack;
    // For a place of the face with weights w of its corners, |p - place|² = Σ w_i |p - corner_i|² -
    // Σ w_i w_j side_ij², so from afar no place is much nearer than the nearest corner.
    double corner = std::numeric_limits<double>::infinity();
    for (const Eigen::Vector3d& at : leaf.corners.at)
      corner = std::min(corner, (point - at).squaredNorm());
    if (corner - leaf.spread > bound) return;
    const NearestPlace found = nearest_on_face(point, leaf.corners, bound);
    if (found.squared > best.nearest.squared) return;
    if (found.squared == best.nearest.squared && leaf.face >= best.face) return;
    best = {found, leaf.face};
    set_reach();
  }

  [[nodiscard]] Wide squared_distances(const Node& node) const {
    Wide sum{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const float at = local[static_cast<Eigen::Index>(axis)];
      for (std::size_t i = 0; i < kWide; ++i) {
        const float below = node.low[axis][i] - at;
        const float above = at - node.high[axis][i];
        const float away = below > above ? below : above;
        const float outside = away > 0.0f ? away : 0.0f;
        sum[i] += outside * outside;
      }
    }
    return sum;
  }

  const Eigen::Vector3d& point;
  Eigen::Vector3f local;
  double slack = 0.0;  ///< m; what single precision may do to a distance
  float reach = 0.0f;  ///< m²
  NearestFace best;
};

NearestFace FaceTree::find(const Eigen::Vector3d& point, std::uint32_t near) const {
  Search search(*this, point, std::numeric_limits<double>::infinity());
  search.look_at(faces_[places_[near]]);
  run(search, -1.0);
  return search.best;
}

NearestFace FaceTree::find_within(const Eigen::Vector3d& point, std::uint32_t near, double most,
                                  double enough) const {
  Search search(*this, point, most);
  if (near != kNoFace) search.look_at(faces_[places_[near]]);
  run(search, enough);
  return search.best;
}

void FaceTree::run(Search& search, double enough) const {
  struct Waiting {
    std::uint32_t child = 0;
    float squared = 0.0f;
  };
  std::array<Waiting, 64> waiting;  // three of each level stay, and 2^31 faces are 16 levels
  std::size_t count = 0;
  waiting[count++] = {0, 0.0f};
  while (count > 0 && !(search.best.face != kNoFace && search.best.nearest.squared < enough)) {
    const Waiting next = waiting[--count];
    if (!(next.squared <= search.reach)) continue;
    if ((next.child & kFaceBit) != 0) {
      search.look_at(faces_[next.child ^ kFaceBit]);
      continue;
    }
    const Node& node = nodes_[next.child];
    const Wide squared = search.squared_distances(node);
    const std::size_t first = count;
    for (std::size_t i = 0; i < node.count; ++i) {
      if (!(squared[i] <= search.reach)) continue;
      std::size_t at = count++;  // the nearest goes on top
      for (; at > first && waiting[at - 1].squared < squared[i]; --at)
        waiting[at] = waiting[at - 1];
      waiting[at] = {node.child[i], squared[i]};
    }
  }
}

}  // namespace ray
