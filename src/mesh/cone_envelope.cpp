#include <raycloud/exec/parallel.h>
#include <raycloud/mesh/cone_envelope.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>
#include <vector>

namespace ray {
namespace {

/// Points in a tree of plan cells that halve in turn along x and y, with the lowest of each.
class LowestTree {
 public:
  LowestTree(const Context& context, std::span<const Eigen::Vector3d> points)
      : points_(points), order_(points.size()) {
    std::iota(order_.begin(), order_.end(), 0u);
    add(0, static_cast<std::uint32_t>(order_.size()));
    for (std::size_t level = 0; level < nodes_.size();) {
      const std::size_t below = nodes_.size();
      parallel_for(context, below - level, (below - level) / kShares + 1,
                   [&](std::size_t first, std::size_t last) {
                     for (std::size_t i = first; i < last; ++i)
                       measure_and_halve(nodes_[level + i]);
                   });
      for (; level < below; ++level)
        add_halves(level);
    }
  }

  /// Says 1 of each point that has none below its cone, 0 of the others. All points of a leaf look together
  /// for the nodes that may have one.
  [[nodiscard]] std::vector<std::uint8_t> without_below(const Context& context, double gradient) const {
    std::vector<std::uint8_t> is_without(points_.size(), 1);
    parallel_for(context, nodes_.size(), 256, [&](std::size_t first, std::size_t last) {
      for (std::size_t i = first; i < last; ++i)
        if (nodes_[i].is_leaf()) judge(nodes_[i], gradient, is_without);
    });
    return is_without;
  }

 private:
  static constexpr std::uint32_t kLeaf = 16;
  static constexpr std::size_t kShares = 64;  // of the nodes of a level, for threads
  struct Node {
    Eigen::Vector2d low, high;
    double lowest = std::numeric_limits<double>::infinity();
    std::uint32_t begin = 0, end = 0;
    std::uint32_t first = 0, second = 0;
    [[nodiscard]] bool is_leaf() const { return end - begin <= kLeaf; }
  };

  /// Whether a point of a node may be below the cone of one at the height, so far away in plan. Rounding must
  /// not hide one.
  static bool may_be_below(const Node& node, double height, double squared, double gradient) {
    const double room = height - node.lowest + 1e-14 * (std::abs(height) + std::abs(node.lowest));
    return room >= 0.0 && gradient * gradient * squared * (1.0 - 1e-14) <= room * room;
  }

  bool has_below(const Node& node, const Eigen::Vector3d& p, double gradient) const {
    const Eigen::Vector2d place = p.head<2>();
    const double squared = (node.low - place).cwiseMax(place - node.high).cwiseMax(0.0).squaredNorm();
    if (!may_be_below(node, p.z(), squared, gradient)) return false;
    for (std::uint32_t i = node.begin; i < node.end; ++i) {
      const Eigen::Vector3d& q = points_[order_[i]];
      if (q.z() < p.z() && q.z() + gradient * (q - p).head<2>().norm() < p.z()) return true;
    }
    return false;
  }

  void judge(const Node& own, double gradient, std::vector<std::uint8_t>& is_without) const {
    std::array<std::uint32_t, kLeaf> open{};
    std::size_t open_count = own.end - own.begin;
    std::copy_n(order_.begin() + own.begin, open_count, open.begin());
    double highest = -std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < open_count; ++i)
      highest = std::max(highest, points_[open[i]].z());
    const Eigen::Vector2d place = 0.5 * (own.low + own.high);
    std::uint32_t waiting[64];
    std::size_t count = 0;
    waiting[count++] = 0;
    while (count > 0 && open_count > 0) {
      const Node& node = nodes_[waiting[--count]];
      const double squared = (node.low - own.high).cwiseMax(own.low - node.high).cwiseMax(0.0).squaredNorm();
      if (!may_be_below(node, highest, squared, gradient)) continue;
      if (!node.is_leaf()) {
        // The half that is nearer is looked at first.
        const Node& first = nodes_[node.first];
        const bool in_first =
            (place.array() >= first.low.array()).all() && (place.array() <= first.high.array()).all();
        waiting[count++] = in_first ? node.second : node.first;
        waiting[count++] = in_first ? node.first : node.second;
        continue;
      }
      for (std::size_t i = 0; i < open_count;) {
        if (has_below(node, points_[open[i]], gradient)) {
          is_without[open[i]] = 0;
          open[i] = open[--open_count];
        } else {
          ++i;
        }
      }
    }
  }

  std::uint32_t add(std::uint32_t begin, std::uint32_t end) {
    Node& node = nodes_.emplace_back();
    node.begin = begin;
    node.end = end;
    return static_cast<std::uint32_t>(nodes_.size() - 1);
  }

  void add_halves(std::size_t place) {
    const auto [begin, end] = std::pair(nodes_[place].begin, nodes_[place].end);
    if (nodes_[place].is_leaf()) return;
    const std::uint32_t middle = begin + (end - begin) / 2;
    const std::uint32_t first = add(begin, middle);
    const std::uint32_t second = add(middle, end);
    nodes_[place].first = first;
    nodes_[place].second = second;
  }

  /// Sorts the points of each half to one side.
  void measure_and_halve(Node& node) {
    node.low.setConstant(std::numeric_limits<double>::infinity());
    node.high = -node.low;
    for (std::uint32_t i = node.begin; i < node.end; ++i) {
      const Eigen::Vector3d& point = points_[order_[i]];
      node.low = node.low.cwiseMin(point.head<2>());
      node.high = node.high.cwiseMax(point.head<2>());
      node.lowest = std::min(node.lowest, point.z());
    }
    if (node.is_leaf()) return;
    const int axis = node.high.x() - node.low.x() >= node.high.y() - node.low.y() ? 0 : 1;
    const auto at = [&](std::uint32_t i) { return order_.begin() + static_cast<std::ptrdiff_t>(i); };
    std::nth_element(at(node.begin), at(node.begin + (node.end - node.begin) / 2), at(node.end),
                     [&](std::uint32_t a, std::uint32_t b) { return points_[a][axis] < points_[b][axis]; });
  }

  std::span<const Eigen::Vector3d> points_;
  std::vector<std::uint32_t> order_;
  std::vector<Node> nodes_;
};

}  // namespace

std::vector<std::uint8_t> cone_envelope(const Context& context, std::span<const Eigen::Vector3d> points,
                                        double gradient) {
  if (points.empty()) return {};
  return LowestTree(context, points).without_below(context, gradient);
}

}  // namespace ray
