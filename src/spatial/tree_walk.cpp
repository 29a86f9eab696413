#include "tree_walk.h"

#include <raycloud/core/lanes.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

#ifdef __SSE2__
#include <immintrin.h>
#endif

namespace ray {

bool TreeWalk::go_to(std::size_t place) {
  if (place - leaf_.first < leaf_.count) return false;
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
  leaf_ = {own.first[side], own.count[side], node};
  for (Beside& beside : beside_) {
    const PointTree::Pair& other = pairs[beside.node / 2];
    const std::size_t there = beside.node % 2;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double apart = std::max(
          {other.min[axis][there] - own.max[axis][side], own.min[axis][side] - other.max[axis][there], 0.0});
      beside.from_leaf += apart * apart;
    }
  }
  return true;
}

/// The squared distances of the point to the boxes of a pair.
inline std::array<double, 2> TreeWalk::distances(const PointTree::Pair& pair) const {
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

#ifdef RAY_HAS_LANES
/// The inner loops by eight points, where the processor can.
struct TreeWalk::Avx512 {
  /// Of eight, those that are there.
  static __mmask8 first(std::size_t count) {
    return static_cast<__mmask8>(count < kLanes ? (1U << count) - 1 : 0xffU);
  }
  RAY_AVX512 static void append(TreeWalk& walk, __mmask8 some, __m512d distance2, __m512i places) {
    _mm512_storeu_pd(&walk.distance2_[walk.count_], _mm512_maskz_compress_pd(some, distance2));
    _mm256_storeu_si256(reinterpret_cast<__m256i*>(&walk.place_[walk.count_]),
                        _mm512_castsi512_si256(_mm512_maskz_compress_epi32(some, places)));
    walk.count_ += static_cast<std::size_t>(_mm_popcnt_u32(some));
  }
  /// Coordinate `axis` of the directions of eight, which lie one after the other.
  RAY_AVX512 static __m512d coordinate(__m512i directions, int axis) {
    const __m512i first = _mm512_castsi128_si512(_mm_setr_epi16(0, 3, 6, 9, 12, 15, 18, 21));
    const __m512i numbers = _mm512_add_epi16(first, _mm512_set1_epi16(static_cast<short>(axis)));
    const __m128i eight = _mm512_castsi512_si128(_mm512_permutexvar_epi16(numbers, directions));
    return _mm512_cvtepi32_pd(_mm256_cvtepi16_epi32(eight));
  }
  /// As is_of_side, of those of eight that are asked for.
  RAY_AVX512 static __mmask8 of_side(const Eigen::Vector3d& side, const PackedDirection* eight,
                                     __mmask8 asked, std::size_t there) {
    const auto numbers = static_cast<__mmask32>((1U << 3 * std::min(there, kLanes)) - 1);
    const __m512i directions = _mm512_maskz_loadu_epi16(numbers, eight);
    const __m512d along =
        _mm512_add_pd(_mm512_add_pd(_mm512_mul_pd(_mm512_set1_pd(side.x()), coordinate(directions, 0)),
                                    _mm512_mul_pd(_mm512_set1_pd(side.y()), coordinate(directions, 1))),
                      _mm512_mul_pd(_mm512_set1_pd(side.z()), coordinate(directions, 2)));
    return _mm512_mask_cmp_pd_mask(asked, along, _mm512_setzero_pd(), _CMP_GE_OQ);
  }
  RAY_AVX512 static void add_near(TreeWalk& walk, const Leaf& leaf, const Eigen::Vector3d* side) {
    const PointTree& tree = walk.tree_;
    const __m512d at_x = _mm512_set1_pd(walk.at_[0]), at_y = _mm512_set1_pd(walk.at_[1]),
                  at_z = _mm512_set1_pd(walk.at_[2]), bound = _mm512_set1_pd(walk.bound_);
    const __m512i self = _mm512_set1_epi32(static_cast<int>(walk.self_));
    const __m512i lane = _mm512_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7, 0, 0, 0, 0, 0, 0, 0, 0);
    for (std::uint32_t i = 0; i < leaf.count; i += kLanes) {
      const std::size_t at = leaf.first + i;
      const __mmask8 some = first(leaf.count - i);
      const __m512d dx = _mm512_sub_pd(_mm512_maskz_loadu_pd(some, tree.x_.data() + at), at_x),
                    dy = _mm512_sub_pd(_mm512_maskz_loadu_pd(some, tree.y_.data() + at), at_y),
                    dz = _mm512_sub_pd(_mm512_maskz_loadu_pd(some, tree.z_.data() + at), at_z);
      const __m512d distance2 =
          _mm512_add_pd(_mm512_add_pd(_mm512_mul_pd(dx, dx), _mm512_mul_pd(dy, dy)), _mm512_mul_pd(dz, dz));
      const __m512i places = _mm512_add_epi32(_mm512_set1_epi32(static_cast<int>(at)), lane);
      const auto others = static_cast<__mmask8>(_mm512_cmpneq_epi32_mask(places, self) & some);
      __mmask8 near = _mm512_mask_cmp_pd_mask(others, distance2, bound, _CMP_LE_OQ);
      if (side != nullptr && near != 0) near = of_side(*side, &tree.to_sensor_[at], near, leaf.count - i);
      append(walk, near, distance2, places);
    }
  }
  RAY_AVX512 static std::size_t count_within(const TreeWalk& walk, double distance2) {
    const __m512d most = _mm512_set1_pd(distance2);
    std::size_t count = 0;
    for (std::size_t i = 0; i < walk.count_; i += kLanes) {
      const __m512d d = _mm512_loadu_pd(&walk.distance2_[i]);
      count += static_cast<std::size_t>(
          _mm_popcnt_u32(_mm512_mask_cmp_pd_mask(first(walk.count_ - i), d, most, _CMP_LE_OQ)));
    }
    return count;
  }
  RAY_AVX512 static void drop_further(TreeWalk& walk, double distance2) {
    const __m512d most = _mm512_set1_pd(distance2);
    const std::size_t count = std::exchange(walk.count_, 0);
    for (std::size_t i = 0; i < count; i += kLanes) {
      const __m512d d = _mm512_loadu_pd(&walk.distance2_[i]);
      const __m256i places = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(&walk.place_[i]));
      append(walk, _mm512_mask_cmp_pd_mask(first(count - i), d, most, _CMP_LE_OQ), d,
             _mm512_castsi256_si512(places));
    }
  }
};
#endif

/// How many of the points found are no further than that.
inline std::size_t TreeWalk::count_within(double distance2) {
#ifdef RAY_HAS_LANES
  if (lanes_in_use == LaneSet::kAvx512) return Avx512::count_within(*this, distance2);
#endif
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
inline std::uint32_t TreeWalk::near_points(const Leaf& leaf, double* distance2) const {
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

/// Adds the points of a leaf that are no further than the bound, and of the side.
inline void TreeWalk::add_near(const Leaf& leaf, const Eigen::Vector3d* side) {
#ifdef RAY_HAS_LANES
  if (lanes_in_use == LaneSet::kAvx512) return Avx512::add_near(*this, leaf, side);
#endif
  alignas(16) std::array<double, PointTree::kLeafPoints> distance2;
  std::uint32_t near = near_points(leaf, distance2.data());
  if (self_ - leaf.first < leaf.count) near &= ~(std::uint32_t{1} << (self_ - leaf.first));
  for (; near != 0; near &= near - 1) {
    const auto i = static_cast<std::uint32_t>(std::countr_zero(near));
    distance2_[count_] = distance2[i];
    place_[count_] = leaf.first + i;
    count_ += is_of_side(side, tree_.to_sensor_[leaf.first + i]) ? 1 : 0;
  }
}

/// Adds the points of a leaf that may be among the nearest, in no order.
inline void TreeWalk::scan(const Leaf& leaf, const Eigen::Vector3d* side) {
  add_near(leaf, side);
  if (count_ > kRoom - PointTree::kLeafPoints) keep_nearest();
}

inline void TreeWalk::drop_further(double distance2) {
#ifdef RAY_HAS_LANES
  if (lanes_in_use == LaneSet::kAvx512) return Avx512::drop_further(*this, distance2);
#endif
  std::size_t kept = 0;
  for (std::size_t i = 0; i < count_; ++i) {
    const double d = distance2_[i];
    distance2_[kept] = d;
    place_[kept] = place_[i];
    kept += d <= distance2 ? 1 : 0;
  }
  count_ = kept;
}

/// Leaves the nearest `most_` of the points found and lowers the bound to the furthest of them. The number of
/// points on a surface grows with the squared distance, so that a guess by proportion is soon right.
inline void TreeWalk::keep_nearest() {
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
    drop_further(high);
    bound_ = high;
    bound_index_ = 0xffffffff;
    return;
  }
  sort_nearest();
}

/// As keep_nearest, where equal distances have to be told apart.
void TreeWalk::sort_nearest() {
  std::array<Neighbour, kRoom> sorted;
  for (std::size_t i = 0; i < count_; ++i)
    sorted[i] = {distance2_[i], place_[i]};
  std::sort(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(count_), nearer_first(tree_));
  count_ = std::min(count_, most_);
  for (std::size_t i = 0; i < count_; ++i) {
    distance2_[i] = sorted[i].distance2;
    place_[i] = sorted[i].place;
  }
  bound_ = distance2_[count_ - 1];
  bound_index_ = tree_.index_[place_[count_ - 1]];
}

std::span<const Neighbour> TreeWalk::nearest(std::size_t place, std::size_t count, double within2,
                                             const Eigen::Vector3d* side) {
  self_ = static_cast<std::uint32_t>(place);
  most_ = count;
  count_ = 0;
  bound_ = within2;
  at_ = {tree_.x_[place], tree_.y_[place], tree_.z_[place]};
  bound_index_ = 0xffffffff;
  const std::vector<PointTree::Pair>& pairs = tree_.pairs_;
  const auto may_help = [&](std::uint32_t node, double d) {
    return d < bound_ || (d == bound_ && pairs[node / 2].least_index[node % 2] < bound_index_);
  };
  scan(leaf_, side);
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
        scan({pair.first[node % 2], pair.count[node % 2], node}, side);
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

void TreeWalk::in_box(const Eigen::Vector3d& min, const Eigen::Vector3d& max,
                      std::vector<std::uint32_t>& places) {
  places.clear();
  const auto is_apart = [&](const PointTree::Pair& pair, std::size_t side) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto a = static_cast<Eigen::Index>(axis);
      if (pair.min[axis][side] > max[a] || pair.max[axis][side] < min[a]) return true;
    }
    return false;
  };
  open_[0] = {1, 0.0};
  for (std::size_t open = 1; open > 0;) {
    const std::uint32_t node = open_[--open].node;
    const PointTree::Pair& pair = tree_.pairs_[node / 2];
    const std::size_t side = node % 2;
    if (is_apart(pair, side)) continue;
    if (const std::uint32_t parts = pair.parts[side]; parts != 0) {
      open_[open++] = {2 * parts, 0.0};
      open_[open++] = {2 * parts + 1, 0.0};
      continue;
    }
    for (std::uint32_t place = pair.first[side]; place < pair.first[side] + pair.count[side]; ++place) {
      const Eigen::Array3d point = tree_.point(place);
      if ((point >= min.array()).all() && (point <= max.array()).all()) places.push_back(place);
    }
  }
}

}  // namespace ray
