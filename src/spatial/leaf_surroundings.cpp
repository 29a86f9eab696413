#include "leaf_surroundings.h"

#include <Eigen/Core>
#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#ifdef __SSE2__
#include <emmintrin.h>
#endif

namespace ray {
namespace {

constexpr float kFar = std::numeric_limits<float>::infinity();
constexpr std::size_t kStep = 32;  // points for one word of bits

/// A bit for each of 32 values that is no more than the bound.
inline std::uint32_t bits_within(const float* values, float bound) {
  std::uint32_t bits = 0;
#ifdef __SSE2__
  const __m128 most = _mm_set1_ps(bound);
  const auto within = [&](std::size_t i) {
    return _mm_castps_si128(_mm_cmple_ps(_mm_load_ps(values + i), most));
  };
  for (std::size_t i = 0; i < kStep; i += 16) {
    const __m128i low = _mm_packs_epi32(within(i), within(i + 4));
    const __m128i high = _mm_packs_epi32(within(i + 8), within(i + 12));
    bits |= static_cast<std::uint32_t>(_mm_movemask_epi8(_mm_packs_epi16(low, high))) << i;
  }
#else
  for (std::size_t i = 0; i < kStep; ++i)
    bits |= std::uint32_t{values[i] <= bound} << i;
#endif
  return bits;
}

/// The values less the middle, in single precision. Reads and writes up to three more.
inline void relative(const double* values, std::size_t count, double middle, float* result) {
#ifdef __SSE2__
  const __m128d from = _mm_set1_pd(middle);
  for (std::size_t i = 0; i < count; i += 4) {
    const __m128 low = _mm_cvtpd_ps(_mm_sub_pd(_mm_loadu_pd(values + i), from));
    const __m128 high = _mm_cvtpd_ps(_mm_sub_pd(_mm_loadu_pd(values + i + 2), from));
    _mm_store_ps(result + i, _mm_movelh_ps(low, high));
  }
#else
  for (std::size_t i = 0; i < count; ++i)
    result[i] = static_cast<float>(values[i] - middle);
#endif
}

std::size_t rounded_up(std::size_t count) {
  return (count + kStep - 1) / kStep * kStep;
}

}  // namespace

bool LeafSurroundings::gather(const TreeWalk& walk, double reach) {
  forget();
  const TreeWalk::Leaf& leaf = walk.leaf();
  const PointTree::Pair& own = tree_.pairs_[leaf.node / 2];
  const std::size_t side = leaf.node % 2;
  double furthest = reach;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double half = 0.5 * (own.max[axis][side] - own.min[axis][side]);
    middle_[axis] = own.min[axis][side] + half;
    half_[axis] = static_cast<float>(half * (1.0 + 1e-6));
    furthest = std::max(furthest, half + reach);
  }
  // Beyond, squares of what is rounded off are no floats.
  if (!(furthest > 1e-9 && furthest < 1e9)) return false;
  // Each coordinate is rounded to 2^-24 of the furthest; the rest is rounding of the arithmetic.
  slack_ = static_cast<float>(furthest * 0x1p-20);
  reach_ = reach;
  size_ = 0;
  const auto within = static_cast<float>(reach) + 4.0F * slack_;
  const float within2 = within * within * 1.00001F;
  if (!gather_leaf(leaf, kFar)) return false;
  std::array<std::uint32_t, 96> open;
  for (const TreeWalk::Beside& beside : walk.beside()) {
    if (beside.from_leaf > static_cast<double>(within2)) continue;
    open[0] = beside.node;
    for (std::size_t count = 1; count > 0;) {
      const std::uint32_t node = open[--count];
      const PointTree::Pair& pair = tree_.pairs_[node / 2];
      const std::size_t at = node % 2;
      const std::uint32_t parts = pair.parts[at];
      if (parts == 0) {
        if (!gather_leaf({pair.first[at], pair.count[at], node}, within2)) return false;
        continue;
      }
      Eigen::Array2d apart2 = Eigen::Array2d::Zero();
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const Eigen::Map<const Eigen::Array2d> min(tree_.pairs_[parts].min[axis].data());
        const Eigen::Map<const Eigen::Array2d> max(tree_.pairs_[parts].max[axis].data());
        apart2 += (min - own.max[axis][side]).max(own.min[axis][side] - max).max(0.0).square();
      }
      for (std::uint32_t part = 0; part < 2; ++part)
        if (apart2[part] <= static_cast<double>(within2)) open[count++] = 2 * parts + part;
    }
  }
  for (std::size_t i = size_; i < rounded_up(size_); ++i)
    x_[i] = y_[i] = z_[i] = kFar;
  solved_count_ = 0;
  leaf_ = leaf;
  return true;
}

/// Adds the points of a leaf that are near enough to the box. False if there is no room.
bool LeafSurroundings::gather_leaf(const TreeWalk::Leaf& leaf, float within2) {
  if (size_ + kLeaf > kRoom) return false;
  using Values = Eigen::Array<float, kLeaf, 1>;
  Values x = Values::Zero(), y = Values::Zero(), z = Values::Zero();
  relative(tree_.x_.data() + leaf.first, leaf.count, middle_[0], x.data());
  relative(tree_.y_.data() + leaf.first, leaf.count, middle_[1], y.data());
  relative(tree_.z_.data() + leaf.first, leaf.count, middle_[2], z.data());
  const Values distance2 = (x.abs() - half_[0]).max(0.0F).square() + (y.abs() - half_[1]).max(0.0F).square() +
                           (z.abs() - half_[2]).max(0.0F).square();
  std::uint32_t near = within2 < kFar ? bits_within(distance2.data(), within2) : ~std::uint32_t{0};
  if (leaf.count < kLeaf) near &= (std::uint32_t{1} << leaf.count) - 1;
  for (; near != 0; near &= near - 1) {
    const auto i = static_cast<std::uint32_t>(std::countr_zero(near));
    x_[size_] = x[i];
    y_[size_] = y[i];
    z_[size_] = z[i];
    place_[size_++] = leaf.first + i;
  }
  return true;
}

/// The squared distances of all that was gathered from one of its points.
void LeafSurroundings::measure(std::size_t self) {
  const float x = x_[self], y = y_[self], z = z_[self];
  const std::size_t end = rounded_up(size_);
  for (std::size_t i = 0; i < end; ++i) {
    const float dx = x_[i] - x, dy = y_[i] - y, dz = z_[i] - z;
    distance2_[i] = dx * dx + dy * dy + dz * dz;
  }
  distance2_[self] = kFar;
}

/// How far the nearest are at most: no further than those of another point, and that point.
float LeafSurroundings::bound_by_others(std::size_t count) const {
  if (solved_count_ != count) return kFar;
  float least = kFar;
#ifdef __SSE2__
  __m128 least4 = _mm_set1_ps(kFar);
  for (std::size_t i = 0; i < kLeaf; i += 4)
    least4 =
        _mm_min_ps(least4, _mm_add_ps(_mm_sqrt_ps(_mm_load_ps(&distance2_[i])), _mm_load_ps(&solved_[i])));
  alignas(16) std::array<float, 4> lanes;
  _mm_store_ps(lanes.data(), least4);
  least = std::min(std::min(lanes[0], lanes[1]), std::min(lanes[2], lanes[3]));
#else
  for (std::size_t i = 0; i < kLeaf; ++i)
    least = std::min(least, std::sqrt(distance2_[i]) + solved_[i]);
#endif
  return least * 1.00001F + 2.0F * slack_;
}

void LeafSurroundings::collect(float within, const Eigen::Vector3d* side) {
  const float within2 = within * within * 1.00001F;
  const std::size_t end = rounded_up(size_);
  std::size_t count = 0;
  for (std::size_t begin = 0; begin < end; begin += kStep)
    for (std::uint32_t near = bits_within(&distance2_[begin], within2); near != 0; near &= near - 1) {
      const std::size_t i = begin + static_cast<std::size_t>(std::countr_zero(near));
      found2_[count] = distance2_[i];
      found_place_[count] = place_[i];
      count += is_of_side(side, tree_.to_sensor_[place_[i]]) ? 1 : 0;
    }
  found_count_ = count;
}

/// How many of those found are no further than that.
std::size_t LeafSurroundings::count_within(float distance2) const {
  std::int32_t count = 0;
  const std::size_t end = (found_count_ + 3) / 4 * 4;
  for (std::size_t i = 0; i < end; ++i)
    count += found2_[i] <= distance2 ? 1 : 0;
  return static_cast<std::size_t>(count);
}

/// A squared distance within which there are `count` of those found, and few more. The number of points on a
/// surface grows with the squared distance, so that a guess by proportion is soon right.
float LeafSurroundings::distance2_of_nearest(std::size_t count, float within2) {
  constexpr int kGuesses = 12;
  for (std::size_t i = found_count_; i < found_count_ + 4; ++i)
    found2_[i] = kFar;
  float low = 0.0F, high = within2;
  std::size_t low_count = 0, high_count = found_count_;
  for (int guess = 0; guess < kGuesses && high_count != count; ++guess) {
    const float part =
        (static_cast<float>(count - low_count) + 0.5F) / (static_cast<float>(high_count - low_count) + 1.0F);
    const float at = low + (high - low) * part;
    const std::size_t within = count_within(at);
    if (within >= count) {
      high = at;
      high_count = within;
    } else {
      low = at;
      low_count = within;
    }
  }
  return high;
}

/// The nearest of those found, by their distances in double.
std::span<const Neighbour> LeafSurroundings::exact(std::size_t place, std::size_t count, double reach2) {
  const double x = tree_.x_[place], y = tree_.y_[place], z = tree_.z_[place];
  std::size_t kept = 0;
  for (std::size_t i = 0; i < found_count_; ++i) {
    const std::uint32_t other = found_place_[i];
    const double dx = tree_.x_[other] - x, dy = tree_.y_[other] - y, dz = tree_.z_[other] - z;
    const double distance2 = dx * dx + dy * dy + dz * dz;
    found_[kept] = {distance2, other};
    kept += distance2 <= reach2 ? 1 : 0;
  }
  if (kept > count) {
    std::sort(found_.begin(), found_.begin() + static_cast<std::ptrdiff_t>(kept), nearer_first(tree_));
    kept = count;
  }
  return {found_.data(), kept};
}

std::optional<std::span<const Neighbour>> LeafSurroundings::nearest(std::size_t place, std::size_t count,
                                                                    double reach,
                                                                    const Eigen::Vector3d* side) {
  const std::size_t self = place - leaf_.first;
  measure(self);
  const bool reach_is_known = reach <= reach_;
  const float whole = static_cast<float>(std::min(reach, reach_)) * 1.000001F + 2.0F * slack_;
  const float within = std::min(whole, side == nullptr ? bound_by_others(count) : kFar);
  collect(within, side);
  if (found_count_ < count && !reach_is_known) {
    find_bound(count, side);
    return {};
  }
  if (found_count_ > count) drop_further(count, within);
  const std::span<const Neighbour> result = exact(place, count, reach * reach);
  if (result.size() < count) return result;
  double furthest2 = 0.0;
  for (const Neighbour& neighbour : result)
    furthest2 = std::max(furthest2, neighbour.distance2);
  if (!reach_is_known && !(furthest2 <= reach_ * reach_)) {
    bound2_ = furthest2;
    return {};
  }
  if (side == nullptr) {
    if (solved_count_ != count) solved_.fill(kFar);
    solved_count_ = count;
    solved_[self] = static_cast<float>(std::sqrt(furthest2)) * 1.00001F;
  }
  return result;
}

/// Of those found, a little more than the nearest stay: those that may be.
void LeafSurroundings::drop_further(std::size_t count, float within) {
  const float nearest =
      std::sqrt(distance2_of_nearest(count, within * within * 1.00001F)) * 1.00001F + 2.0F * slack_;
  const float nearest2 = nearest * nearest * 1.00001F;
  std::size_t kept = 0;
  for (std::size_t i = 0; i < found_count_; ++i) {
    const float d = found2_[i];
    found_place_[kept] = found_place_[i];
    kept += d <= nearest2 ? 1 : 0;
  }
  found_count_ = kept;
}

/// From all that was gathered, how far the nearest are at most.
void LeafSurroundings::find_bound(std::size_t count, const Eigen::Vector3d* side) {
  bound2_ = std::numeric_limits<double>::infinity();
  collect(1e9F, side);
  if (found_count_ < count) return;
  float furthest2 = 0.0F;
  for (std::size_t i = 0; i < found_count_; ++i)
    furthest2 = std::max(furthest2, found2_[i]);
  const double bound = std::sqrt(static_cast<double>(distance2_of_nearest(count, furthest2))) * 1.00001 +
                       2.0 * static_cast<double>(slack_);
  bound2_ = bound * bound;
}

}  // namespace ray
