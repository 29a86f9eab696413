#include <raycloud/core/error.h>
#include <raycloud/exec/fresh_memory.h>
#include <raycloud/exec/parallel.h>
#include <raycloud/exec/space_cuts.h>
#include <raycloud/spatial/point_tree.h>

#include <algorithm>
#include <optional>
#include <utility>

namespace ray {
namespace {

constexpr std::size_t kBucketPoints = 1 << 14;
constexpr std::size_t kSampled = 64;  // points for each bucket that decide where space is cut
constexpr std::size_t kChunk = 1 << 16;

using Coordinates = std::array<double, 3>;

struct IndexedPoint {
  Coordinates at;
  std::uint32_t index;
};

Coordinates coordinates_of(const SeenPoint& point) {
  return {point.end.x(), point.end.y(), point.end.z()};
}

template <class Box>
std::size_t widest_axis(const Box& box) {
  std::size_t widest = 0;
  for (std::size_t axis = 1; axis < 3; ++axis)
    if (box.max[axis] - box.min[axis] > box.max[widest] - box.min[widest]) widest = axis;
  return widest;
}

template <class Box>
void extend(Box& box, const Coordinates& low, const Coordinates& high) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    box.min[axis] = std::min(box.min[axis], low[axis]);
    box.max[axis] = std::max(box.max[axis], high[axis]);
  }
}

/// Those below a value come first; returns how many. Every point moves whichever side it is of, as guessing
/// the side of half of them wrongly would take longer.
std::size_t divide_at(std::span<IndexedPoint> points, std::size_t axis, double value) {
  std::size_t below = 0;
  for (IndexedPoint& point : points) {
    const IndexedPoint moved = point;
    point = points[below];
    points[below] = moved;
    below += moved.at[axis] < value ? 1 : 0;
  }
  return below;
}

/// Cuts the points across the box, near their median: at that of a sample, if it leaves a quarter of them on
/// either side.
std::size_t cut(std::span<IndexedPoint> points, std::size_t axis) {
  constexpr std::size_t kSample = 25, kMany = 2 * kSample;
  const std::size_t size = points.size();
  if (size > kMany) {
    std::array<double, kSample> sample;
    for (std::size_t i = 0; i < kSample; ++i)
      sample[i] = points[(2 * i + 1) * size / (2 * kSample)].at[axis];
    std::nth_element(sample.begin(), sample.begin() + kSample / 2, sample.end());
    const std::size_t below = divide_at(points, axis, sample[kSample / 2]);
    if (below >= size / 4 && below <= size - size / 4) return below;
  }
  const std::size_t middle = size / 2;
  std::nth_element(points.begin(), points.begin() + static_cast<std::ptrdiff_t>(middle), points.end(),
                   [axis](const IndexedPoint& a, const IndexedPoint& b) { return a.at[axis] < b.at[axis]; });
  return middle;
}

}  // namespace

/// Space is first cut into buckets by a sample of the points, so that the buckets can be filled and then
/// divided further by all threads, each within its cache.
class PointTree::Builder {
 public:
  Builder(const Context& context, std::span<const SeenPoint> points, PointTree& tree)
      : context_(context), points_(points), tree_(tree) {}

  void build() {
    plan_buckets();
    fill_buckets();
    const std::size_t count = points_.size();
    for (std::vector<double>* column : {&tree_.x_, &tree_.y_, &tree_.z_})
      *column = touched_vector<double>(context_, count + 7);  // leaves are read eight points at a time
    tree_.to_sensor_ =
        touched_vector<PackedDirection>(context_, count + 1);  // of which four numbers are read
    tree_.index_ = touched_vector<std::uint32_t>(context_, count);
    below_.resize(buckets_);
    nodes_.resize(2 * buckets_);
    parallel_for(context_, buckets_, 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t bucket = begin; bucket < end; ++bucket)
        divide_bucket(bucket);
    });
    join();
  }

 private:
  struct Box {
    std::array<double, 3> min{kInfinity, kInfinity, kInfinity};
    std::array<double, 3> max{-kInfinity, -kInfinity, -kInfinity};
  };
  struct Node {
    Box box;
    std::uint32_t first = 0;
    std::uint32_t count = 0;
    std::uint32_t parts = 0;  // number of the first, 0 for a leaf
    std::uint32_t least_index = 0xffffffff;
  };
  void plan_buckets() {
    const std::size_t wanted = (points_.size() + kBucketPoints - 1) / kBucketPoints;
    std::vector<Eigen::Vector3d> sample;
    if (wanted > 1) {
      sample.resize(wanted * kSampled);
      for (std::size_t i = 0; i < sample.size(); ++i)
        sample[i] = points_[points_.size() * i / sample.size()].end;
    }
    cuts_.emplace(std::move(sample), wanted);
    buckets_ = cuts_->parts();
  }

  /// A counting sort, stable, chunk by chunk.
  void fill_buckets() {
    const std::size_t chunks = (points_.size() + kChunk - 1) / kChunk;
    std::vector<std::uint32_t> next(chunks * buckets_);
    auto bucket = touched_vector<std::uint32_t>(context_, buckets_ > 1 ? points_.size() : 0);
    if (buckets_ > 1) {
      parallel_for(context_, points_.size(), kChunk, [&](std::size_t begin, std::size_t end) {
        std::uint32_t* counts = next.data() + begin / kChunk * buckets_;
        for (std::size_t i = begin; i < end; ++i) {
          bucket[i] = static_cast<std::uint32_t>(cuts_->part_of(points_[i].end));
          ++counts[bucket[i]];
        }
      });
    } else {
      for (std::size_t chunk = 0; chunk < chunks; ++chunk)
        next[chunk] = static_cast<std::uint32_t>(std::min(kChunk, points_.size() - chunk * kChunk));
    }
    begins_.resize(buckets_ + 1);
    std::uint32_t sum = 0;
    for (std::size_t b = 0; b < buckets_; ++b) {
      begins_[b] = sum;
      for (std::size_t chunk = 0; chunk < chunks; ++chunk)
        sum += std::exchange(next[chunk * buckets_ + b], sum);
    }
    begins_[buckets_] = sum;
    order_ = touched_vector<std::uint32_t>(context_, points_.size());
    parallel_for(context_, points_.size(), kChunk, [&](std::size_t begin, std::size_t end) {
      std::uint32_t* places = next.data() + begin / kChunk * buckets_;
      for (std::size_t i = begin; i < end; ++i)
        order_[places[buckets_ > 1 ? bucket[i] : 0]++] = static_cast<std::uint32_t>(i);
    });
  }

  void divide_bucket(std::size_t bucket) {
    const std::size_t first = begins_[bucket];
    std::vector<IndexedPoint> local(begins_[bucket + 1] - first);
    for (std::size_t i = 0; i < local.size(); ++i)
      local[i] = {coordinates_of(points_[order_[first + i]]), order_[first + i]};
    divide(local, first, nodes_[buckets_ + bucket], below_[bucket]);
  }

  /// `below` gets the nodes below `node`, numbered from 2 on.
  void divide(std::span<IndexedPoint> points, std::size_t first, Node& node, std::vector<Node>& below) {
    Node made;
    made.first = static_cast<std::uint32_t>(first);
    made.count = static_cast<std::uint32_t>(points.size());
    for (const IndexedPoint& point : points) {
      extend(made.box, point.at, point.at);
      made.least_index = std::min(made.least_index, point.index);
    }
    if (points.size() <= kLeafPoints) {
      node = made;
      for (std::size_t i = 0; i < points.size(); ++i) {
        tree_.x_[first + i] = points[i].at[0];
        tree_.y_[first + i] = points[i].at[1];
        tree_.z_[first + i] = points[i].at[2];
        tree_.index_[first + i] = points[i].index;
        tree_.to_sensor_[first + i] = points_[points[i].index].to_sensor;
      }
      return;
    }
    const std::size_t middle = cut(points, widest_axis(made.box));
    made.parts = static_cast<std::uint32_t>(below.size() + 2);
    node = made;
    const std::size_t child = below.size();
    below.resize(child + 2);
    Node left, right;
    divide(points.first(middle), first, left, below);
    divide(points.subspan(middle), first + middle, right, below);
    below[child] = left;
    below[child + 1] = right;
  }

  /// The nodes of all buckets in one list of pairs, behind those of the tree of buckets above them.
  void join() {
    std::vector<std::size_t> base(buckets_);
    std::size_t total = 2 * buckets_;
    for (std::size_t bucket = 0; bucket < buckets_; ++bucket) {
      base[bucket] = total;
      total += below_[bucket].size();
    }
    tree_.pairs_ = touched_vector<Pair>(context_, total / 2);
    parallel_for(context_, buckets_, 1, [&](std::size_t bucket, std::size_t) {
      const auto moved = [&](Node node) {
        if (node.parts != 0) node.parts += static_cast<std::uint32_t>(base[bucket]) - 2;
        return node;
      };
      nodes_[buckets_ + bucket] = moved(nodes_[buckets_ + bucket]);
      for (std::size_t i = 0; i < below_[bucket].size(); ++i)
        put(base[bucket] + i, moved(below_[bucket][i]));
      below_[bucket] = std::vector<Node>();
    });
    for (std::size_t node = buckets_ - 1; node > 0; --node) {
      const Node& left = nodes_[2 * node];
      const Node& right = nodes_[2 * node + 1];
      Node& made = nodes_[node];
      made.first = left.first;
      made.count = left.count + right.count;
      made.parts = static_cast<std::uint32_t>(2 * node);
      made.least_index = std::min(left.least_index, right.least_index);
      extend(made.box, left.box.min, left.box.max);
      extend(made.box, right.box.min, right.box.max);
    }
    for (std::size_t node = 1; node < 2 * buckets_; ++node)
      put(node, nodes_[node]);
  }

  void put(std::size_t number, const Node& node) {
    Pair& pair = tree_.pairs_[number / 2];
    const std::size_t side = number % 2;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      pair.min[axis][side] = node.box.min[axis];
      pair.max[axis][side] = node.box.max[axis];
    }
    pair.first[side] = node.first;
    pair.count[side] = node.count;
    pair.parts[side] = node.parts / 2;
    pair.least_index[side] = node.least_index;
  }

  const Context& context_;
  std::span<const SeenPoint> points_;
  PointTree& tree_;
  std::size_t buckets_ = 1;
  std::optional<SpaceCuts> cuts_;
  std::vector<std::uint32_t> begins_;  // of the buckets, in order_
  std::vector<std::uint32_t> order_;
  std::vector<Node> nodes_;               // of the tree of buckets, the last ones being the buckets
  std::vector<std::vector<Node>> below_;  // of each bucket
};

PointTree::PointTree(const Context& context, std::span<const SeenPoint> points) {
  if (points.size() >= 0xffffffff)
    throw Error(ErrorCode::out_of_range, "more than 2^32 points in one piece: give it less memory");
  Builder(context, points, *this).build();
}

}  // namespace ray
