#include <raycloud/core/error.h>
#include <raycloud/exec/parallel.h>
#include <raycloud/exec/space_cuts.h>
#include <raycloud/spatial/point_tree.h>

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <optional>
#include <utility>

#ifdef __SSE2__
#include <emmintrin.h>
#endif

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

/// Cuts the points at their median across the box; of points on the cut, the earlier ones come first.
std::size_t cut(std::span<IndexedPoint> points, std::size_t axis) {
  const std::size_t middle = points.size() / 2;
  std::nth_element(points.begin(), points.begin() + static_cast<std::ptrdiff_t>(middle), points.end(),
                   [axis](const IndexedPoint& a, const IndexedPoint& b) {
                     return a.at[axis] != b.at[axis] ? a.at[axis] < b.at[axis] : a.index < b.index;
                   });
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
      column->resize(count + 1);  // leaves are read two points at a time
    tree_.to_sensor_.resize(count);
    tree_.index_.resize(count);
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
    std::vector<std::uint32_t> bucket(buckets_ > 1 ? points_.size() : 0);
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
    order_.resize(points_.size());
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
    tree_.pairs_.resize(total / 2);
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

void NeighbourSearch::go_to_leaf(std::size_t place) {
  beside_.clear();
  const std::vector<PointTree::Pair>& pairs = tree_.pairs_;
  std::uint32_t node = 1;
  while (const std::uint32_t parts = pairs[node / 2].parts[node % 2]) {
    const bool is_left = place < pairs[parts].first[0] + pairs[parts].count[0];
    beside_.push_back({2 * parts + (is_left ? 1 : 0), 0.0});
    node = 2 * parts + (is_left ? 0 : 1);
  }
  const PointTree::Pair& own = pairs[node / 2];
  const std::size_t side = node % 2;
  leaf_ = {own.first[side], own.count[side]};
  for (Beside& beside : beside_) {
    const PointTree::Pair& other = pairs[beside.node / 2];
    const std::size_t there = beside.node % 2;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double apart = std::max(
          {other.min[axis][there] - own.max[axis][side], own.min[axis][side] - other.max[axis][there], 0.0});
      beside.from_leaf += apart * apart;
    }
  }
}

/// The squared distances of the point to the boxes of a pair.
inline std::array<double, 2> NeighbourSearch::distances(const PointTree::Pair& pair) const {
  std::array<double, 2> result;
#ifdef __SSE2__
  __m128d sum = _mm_setzero_pd();
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const __m128d at = _mm_set1_pd(at_[axis]);
    const __m128d below = _mm_sub_pd(_mm_loadu_pd(pair.min[axis].data()), at);
    const __m128d above = _mm_sub_pd(at, _mm_loadu_pd(pair.max[axis].data()));
    const __m128d apart = _mm_max_pd(_mm_max_pd(below, above), _mm_setzero_pd());
    sum = _mm_add_pd(sum, _mm_mul_pd(apart, apart));
  }
  _mm_storeu_pd(result.data(), sum);
#else
  for (std::size_t side = 0; side < 2; ++side) {
    result[side] = 0.0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double apart =
          std::max(std::max(pair.min[axis][side] - at_[axis], at_[axis] - pair.max[axis][side]), 0.0);
      result[side] += apart * apart;
    }
  }
#endif
  return result;
}

/// How many of the points found are no further than that.
inline std::size_t NeighbourSearch::count_within(double distance2) {
#ifdef __SSE2__
  distance2_[count_] = PointTree::kInfinity;
  __m128i sum = _mm_setzero_si128();
  const __m128d at = _mm_set1_pd(distance2);
  for (std::size_t i = 0; i < count_; i += 2)
    sum = _mm_sub_epi64(sum, _mm_castpd_si128(_mm_cmple_pd(_mm_loadu_pd(&distance2_[i]), at)));
  sum = _mm_add_epi64(sum, _mm_unpackhi_epi64(sum, sum));
  return static_cast<std::size_t>(_mm_cvtsi128_si64(sum));
#else
  std::size_t count = 0;
  for (std::size_t i = 0; i < count_; ++i)
    count += distance2_[i] <= distance2 ? 1 : 0;
  return count;
#endif
}

/// A bit for each point of the leaf that is no further than the bound.
inline std::uint32_t NeighbourSearch::near_points(Leaf leaf, double* distance2) const {
  const double* x = tree_.x_.data() + leaf.first;
  const double* y = tree_.y_.data() + leaf.first;
  const double* z = tree_.z_.data() + leaf.first;
  std::uint32_t near = 0;
#ifdef __SSE2__
  const __m128d at_x = _mm_set1_pd(at_[0]), at_y = _mm_set1_pd(at_[1]), at_z = _mm_set1_pd(at_[2]);
  const __m128d bound = _mm_set1_pd(bound_);
  for (std::uint32_t i = 0; i < leaf.count; i += 2) {
    const __m128d dx = _mm_sub_pd(_mm_loadu_pd(x + i), at_x);
    const __m128d dy = _mm_sub_pd(_mm_loadu_pd(y + i), at_y);
    const __m128d dz = _mm_sub_pd(_mm_loadu_pd(z + i), at_z);
    const __m128d d = _mm_add_pd(_mm_add_pd(_mm_mul_pd(dx, dx), _mm_mul_pd(dy, dy)), _mm_mul_pd(dz, dz));
    _mm_storeu_pd(distance2 + i, d);
    near |= static_cast<std::uint32_t>(_mm_movemask_pd(_mm_cmple_pd(d, bound))) << i;
  }
  if (leaf.count < 32) near &= (std::uint32_t{1} << leaf.count) - 1;
#else
  for (std::uint32_t i = 0; i < leaf.count; ++i) {
    const double dx = x[i] - at_[0], dy = y[i] - at_[1], dz = z[i] - at_[2];
    distance2[i] = dx * dx + dy * dy + dz * dz;
    near |= std::uint32_t{distance2[i] <= bound_} << i;
  }
#endif
  return near;
}

/// Adds the points of a leaf that may be among the nearest, in no order.
template <class Accept>
inline void NeighbourSearch::scan(Leaf leaf, const Accept& accept) {
  alignas(16) std::array<double, PointTree::kLeafPoints> distance2;
  std::uint32_t near = near_points(leaf, distance2.data());
  if (self_ - leaf.first < leaf.count) near &= ~(std::uint32_t{1} << (self_ - leaf.first));
  std::size_t count = count_;
  for (; near != 0; near &= near - 1) {
    const auto i = static_cast<std::uint32_t>(std::countr_zero(near));
    distance2_[count] = distance2[i];
    place_[count] = leaf.first + i;
    count += accept(leaf.first + i) ? 1 : 0;
  }
  count_ = count;
  if (count > kRoom - PointTree::kLeafPoints) keep_nearest();
}

/// Leaves the nearest `most_` of the points found and lowers the bound to the furthest of them. The number of
/// points on a surface grows with the squared distance, so that a guess by proportion is soon right.
inline void NeighbourSearch::keep_nearest() {
  if (count_ < most_) return;
  constexpr int kGuesses = 12;
  double low = 0.0, high = bound_;
  std::size_t low_count = 0, high_count = count_;
  if (!(high < PointTree::kInfinity))
    high = *std::max_element(distance2_.begin(), distance2_.begin() + static_cast<std::ptrdiff_t>(count_));
  for (int guess = 0; guess < kGuesses && high_count != most_; ++guess) {
    const double part =
        (static_cast<double>(most_ - low_count) + 0.5) / (static_cast<double>(high_count - low_count) + 1.0);
    const double at = low + (high - low) * part;
    const std::size_t count = count_within(at);
    if (count >= most_) {
      high = at;
      high_count = count;
    } else {
      low = at;
      low_count = count;
    }
  }
  if (high_count == most_) {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < count_; ++i) {
      const double d = distance2_[i];
      distance2_[kept] = d;
      place_[kept] = place_[i];
      kept += d <= high ? 1 : 0;
    }
    count_ = kept;
    bound_ = high;
    bound_index_ = 0xffffffff;
    return;
  }
  sort_nearest();
}

/// As keep_nearest, where equal distances have to be told apart.
void NeighbourSearch::sort_nearest() {
  std::array<Neighbour, kRoom> sorted;
  for (std::size_t i = 0; i < count_; ++i)
    sorted[i] = {distance2_[i], place_[i]};
  std::sort(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(count_),
            [&](const Neighbour& a, const Neighbour& b) {
              return a.distance2 != b.distance2 ? a.distance2 < b.distance2
                                                : tree_.index_[a.place] < tree_.index_[b.place];
            });
  count_ = std::min(count_, most_);
  for (std::size_t i = 0; i < count_; ++i) {
    distance2_[i] = sorted[i].distance2;
    place_[i] = sorted[i].place;
  }
  bound_ = distance2_[count_ - 1];
  bound_index_ = tree_.index_[place_[count_ - 1]];
}

template <class Accept>
inline std::span<const Neighbour> NeighbourSearch::search(std::size_t place, std::size_t count, double reach,
                                                          double known, const Accept& accept) {
  assert(count <= kMost && place < tree_.size());
  if (count == 0) return {};
  if (beside_.empty() || place < leaf_.first || place >= leaf_.first + leaf_.count) go_to_leaf(place);
  self_ = static_cast<std::uint32_t>(place);
  most_ = count;
  count_ = 0;
  bound_ = std::min(reach * reach, known);
  bound_index_ = 0xffffffff;
  const std::vector<PointTree::Pair>& pairs = tree_.pairs_;
  const auto may_help = [&](std::uint32_t node, double d) {
    return d < bound_ || (d == bound_ && pairs[node / 2].least_index[node % 2] < bound_index_);
  };
  scan(leaf_, accept);
  bool lowered = false;
  for (std::size_t level = beside_.size(); level-- > 0;) {
    if (!lowered && count_ > most_ + most_ / 4) {
      keep_nearest();
      lowered = true;
    }
    const Beside& beside = beside_[level];
    if (beside.from_leaf > bound_) continue;
    open_[0] = {beside.node, distances(pairs[beside.node / 2])[beside.node % 2]};
    for (std::size_t open = 1; open > 0;) {
      const auto [node, d] = open_[--open];
      if (!may_help(node, d)) continue;
      const PointTree::Pair& pair = pairs[node / 2];
      const std::uint32_t parts = pair.parts[node % 2];
      if (parts == 0) {
        scan({pair.first[node % 2], pair.count[node % 2]}, accept);
        continue;
      }
      const std::array<double, 2> apart = distances(pairs[parts]);
      const std::array<std::uint32_t, 2>& least = pairs[parts].least_index;
      const std::uint32_t nearer =
          apart[0] != apart[1] ? (apart[1] < apart[0] ? 1 : 0) : (least[1] < least[0] ? 1 : 0);
      open_[open++] = {2 * parts + 1 - nearer, apart[1 - nearer]};
      open_[open++] = {2 * parts + nearer, apart[nearer]};
    }
  }
  keep_nearest();
  for (std::size_t i = 0; i < count_; ++i)
    found_[i] = {distance2_[i], place_[i]};
  return {found_.data(), count_};
}

std::span<const Neighbour> NeighbourSearch::nearest(std::size_t place, std::size_t count, double reach) {
  // The neighbours of the last point, and that point, are no further than this.
  const std::array<double, 3> last = at_;
  at_ = {tree_.x_[place], tree_.y_[place], tree_.z_[place]};
  double known = PointTree::kInfinity;
  if (last_count_ == count && count > 0) {
    const double dx = at_[0] - last[0], dy = at_[1] - last[1], dz = at_[2] - last[2];
    const double most = std::sqrt(dx * dx + dy * dy + dz * dz) + std::sqrt(last_furthest2_);
    known = most * most * (1.0 + 1e-9);
  }
  const auto found = search(place, count, reach, known, [](std::uint32_t) { return true; });
  last_count_ = found.size() == count ? count : 0;
  last_furthest2_ = bound_;
  return found;
}

std::span<const Neighbour> NeighbourSearch::nearest_facing(std::size_t place, std::size_t count, double reach,
                                                           const Eigen::Vector3d& normal) {
  last_count_ = 0;
  at_ = {tree_.x_[place], tree_.y_[place], tree_.z_[place]};
  return search(place, count, reach, PointTree::kInfinity, [&](std::uint32_t other) {
    const PackedDirection& d = tree_.to_sensor_[other];
    return normal.x() * d[0] + normal.y() * d[1] + normal.z() * d[2] >= 0.0;
  });
}

}  // namespace ray
