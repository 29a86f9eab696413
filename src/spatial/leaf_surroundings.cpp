#include "leaf_surroundings.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>

namespace ray {
namespace {

constexpr float kFar = std::numeric_limits<float>::infinity();

}  // namespace

bool LeafSurroundings::gather(const TreeWalk& walk, double reach) {
  forget();
  const TreeWalk::Leaf& leaf = walk.leaf();
  const PointTree::Pair& own = tree_.pairs_[leaf.node / 2];
  const std::size_t side = leaf.node % 2;
  SieveBox box;
  double furthest = reach;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double half = 0.5 * (own.max[axis][side] - own.min[axis][side]);
    box.middle[axis] = own.min[axis][side] + half;
    box.half[axis] = static_cast<float>(half * (1.0 + 1e-6));
    furthest = std::max(furthest, half + reach);
  }
  // Beyond, squares of what is rounded off are no floats.
  if (!(furthest > 1e-9 && furthest < 1e9)) return false;
  // Each coordinate is rounded to 2^-24 of the furthest; the rest is rounding of the arithmetic.
  slack_ = static_cast<float>(furthest * 0x1p-20);
  reach_ = reach;
  points_.size = 0;
  has_sides_ = false;
  box.within2 = kFar;
  if (!gather_leaf(leaf, box)) return false;
  const float within = static_cast<float>(reach) + 4.0F * slack_;
  const float within2 = within * within * 1.00001F;
  box.within2 = within2;
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
        if (!gather_leaf({pair.first[at], pair.count[at], node}, box)) return false;
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
  points_.pad();
  box_ = box;
  solved_count_ = 0;
  leaf_ = leaf;
  return true;
}

/// Adds the points of a leaf that are near enough to the box. False if there is no room.
bool LeafSurroundings::gather_leaf(const TreeWalk::Leaf& leaf, const SieveBox& box) {
  if (points_.size + kLeaf > kSieveRoom) return false;
  sieve_box({{tree_.x_.data(), tree_.y_.data(), tree_.z_.data()}, leaf.first, leaf.count}, box, points_);
  return true;
}

void LeafSurroundings::gather_directions() {
  for (std::size_t i = 0; i < points_.size; ++i) {
    const PackedDirection& to_sensor = tree_.to_sensor_[points_.place[i]];
    points_.to_sensor_x[i] = to_sensor[0];
    points_.to_sensor_y[i] = to_sensor[1];
    points_.to_sensor_z[i] = to_sensor[2];
  }
  has_sides_ = true;
}

/// How far the nearest are at most: no further than those of another point, and that point.
float LeafSurroundings::bound_by_others(std::size_t self, std::size_t count) const {
  if (solved_count_ != count) return kFar;
  return sieve_least_sum(points_, middle_of(self), solved_.data(), kLeaf) * 1.00001F + 2.0F * slack_;
}

/// The points no further, and of the side.
void LeafSurroundings::collect(std::size_t place, float within, const Eigen::Vector3d* side) {
  SieveSphere sphere{.middle = middle_of(place - leaf_.first),
                     .within2 = within * within * 1.00001F,
                     .self = static_cast<std::uint32_t>(place)};
  if (side != nullptr) {
    if (!has_sides_) gather_directions();
    sphere.has_side = true;
    sphere.side = {static_cast<float>(side->x()), static_cast<float>(side->y()),
                   static_cast<float>(side->z())};
    // Three products with 16 bits are rounded to 2^-24 of them, and summed.
    sphere.doubt = 0.05F * static_cast<float>(side->cwiseAbs().maxCoeff()) + 1e-30F;
  }
  if (!sieve_sphere(points_, sphere, near_)) return;
  std::size_t kept = 0;
  for (std::size_t i = 0; i < near_.size; ++i) {
    near_.distance2[kept] = near_.distance2[i];
    near_.place[kept] = near_.place[i];
    kept += is_of_side(side, tree_.to_sensor_[near_.place[i]]) ? 1 : 0;
  }
  near_.size = kept;
  std::fill_n(near_.distance2.begin() + static_cast<std::ptrdiff_t>(kept), kSieveLanes, kFar);
}

/// A squared distance within which there are `count` of those found, and few more. The number of points on a
/// surface grows with the squared distance, so that a guess by proportion is soon right.
float LeafSurroundings::distance2_of_nearest(std::size_t count, float within2) const {
  constexpr int kGuesses = 12;
  float low = 0.0F, high = within2;
  std::size_t low_count = 0, high_count = near_.size;
  for (int guess = 0; guess < kGuesses && high_count != count; ++guess) {
    const float part =
        (static_cast<float>(count - low_count) + 0.5F) / (static_cast<float>(high_count - low_count) + 1.0F);
    const float at = low + (high - low) * part;
    const std::size_t within = sieve_count(near_, at);
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
LeafSurroundings::Nearest LeafSurroundings::exact(std::size_t place, std::size_t count, double reach2,
                                                  Neighbourhood* into) {
  if (into != nullptr && near_.size <= count) {
    into->fill(tree_, place, std::span<const std::uint32_t>(near_.place.data(), near_.size));
    if (into->furthest2() <= reach2) return {{}, near_.size, into->furthest2()};
  }
  const double x = tree_.x_[place], y = tree_.y_[place], z = tree_.z_[place];
  std::size_t kept = 0;
  for (std::size_t i = 0; i < near_.size; ++i) {
    const std::uint32_t other = near_.place[i];
    const double dx = tree_.x_[other] - x, dy = tree_.y_[other] - y, dz = tree_.z_[other] - z;
    const double distance2 = dx * dx + dy * dy + dz * dz;
    found_[kept] = {distance2, other};
    kept += distance2 <= reach2 ? 1 : 0;
  }
  if (kept > count) {
    std::sort(found_.begin(), found_.begin() + static_cast<std::ptrdiff_t>(kept), nearer_first(tree_));
    kept = count;
  }
  Nearest result{{found_.data(), kept}, kept};
  for (const Neighbour& neighbour : result.list)
    result.furthest2 = std::max(result.furthest2, neighbour.distance2);
  if (into != nullptr) into->fill(tree_, place, result.list);
  return result;
}

std::optional<LeafSurroundings::Nearest> LeafSurroundings::nearest(std::size_t place, std::size_t count,
                                                                   double reach, const Eigen::Vector3d* side,
                                                                   Neighbourhood* into) {
  const std::size_t self = place - leaf_.first;
  const bool reach_is_known = reach <= reach_;
  const float whole = static_cast<float>(std::min(reach, reach_)) * 1.000001F + 2.0F * slack_;
  const float within = std::min(whole, side == nullptr ? bound_by_others(self, count) : kFar);
  collect(place, within, side);
  if (near_.size < count && !reach_is_known) {
    find_bound(place, count, side);
    return {};
  }
  if (near_.size > count) drop_further(count, within);
  const Nearest result = exact(place, count, reach * reach, into);
  if (result.size < count) return result;
  if (!reach_is_known && !(result.furthest2 <= reach_ * reach_)) {
    bound2_ = result.furthest2;
    return {};
  }
  if (side == nullptr) {
    if (solved_count_ != count) solved_.fill(kFar);
    solved_count_ = count;
    solved_[self] = static_cast<float>(std::sqrt(result.furthest2)) * 1.00001F;
  }
  return result;
}

std::optional<std::span<const std::uint32_t>> LeafSurroundings::within(std::size_t place, std::size_t most,
                                                                       double reach,
                                                                       const Eigen::Vector3d& side) {
  if (!(reach <= reach_)) return {};
  const float nearly = static_cast<float>(reach), whole = nearly * 1.000001F + 2.0F * slack_;
  collect(place, whole, &side);
  const float sure = std::max(nearly * 0.999999F - 2.0F * slack_, 0.0F), sure2 = sure * sure * 0.99999F;
  const std::size_t surely = sieve_count(near_, sure2);
  const bool is_told = surely == near_.size || surely > most;  // by single precision, who is within reach
  if (is_told && near_.size > most) drop_further(most, whole);
  if (is_told && near_.size <= most) return std::span<const std::uint32_t>{near_.place.data(), near_.size};
  const Nearest nearest = exact(place, most, reach * reach, nullptr);
  for (std::size_t i = 0; i < nearest.size; ++i)
    inside_[i] = nearest.list[i].place;
  return std::span<const std::uint32_t>{inside_.data(), nearest.size};
}

double LeafSurroundings::furthest(const Eigen::Vector3d& middle, const Eigen::Vector3d& half) const {
  double furthest2 = 0.0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<Eigen::Index>(axis);
    const double beyond =
        std::abs(middle[a] - box_.middle[axis]) + half[a] - static_cast<double>(box_.half[axis]);
    furthest2 += std::max(beyond, 0.0) * std::max(beyond, 0.0);
  }
  return std::sqrt(furthest2) * (1.0 + 1e-6);
}

PlacesInside LeafSurroundings::inside(const SearchedBody& body) {
  constexpr float kRounding = 1e-6F;  // of the largest product, at most the trace times the squared distance
  SieveBody sought;
  for (std::size_t axis = 0; axis < 3; ++axis)
    sought.centre[axis] =
        static_cast<float>(body.centre[static_cast<Eigen::Index>(axis)] - box_.middle[axis]);
  std::size_t entry = 0;
  for (int row = 0; row < 3; ++row)
    for (int column = row; column < 3; ++column)
      sought.shape[entry++] = static_cast<float>(body.shape(row, column));
  const auto trace = static_cast<float>(body.shape.trace());
  sought.rounding = kRounding * trace;
  // A point that is rounded by so much of the body's least extent.
  const float moved = slack_ * std::sqrt(trace);
  const float doubt = kRounding + 2.5F * moved + moved * moved;
  sought.most = 1.0F + doubt;
  sieve_body(points_, sought, near_);
  std::size_t surely = 0, perhaps = inside_.size();
  for (std::size_t i = 0; i < near_.size; ++i)
    inside_[near_.distance2[i] < 1.0F - doubt ? surely++ : --perhaps] = near_.place[i];
  return {{inside_.data(), surely}, {inside_.data() + perhaps, inside_.size() - perhaps}};
}

/// Of those found, a little more than the nearest stay: those that may be.
void LeafSurroundings::drop_further(std::size_t count, float within) {
  const float nearest =
      std::sqrt(distance2_of_nearest(count, within * within * 1.00001F)) * 1.00001F + 2.0F * slack_;
  sieve_further(near_, nearest * nearest * 1.00001F);
}

/// From all that was gathered, how far the nearest are at most.
void LeafSurroundings::find_bound(std::size_t place, std::size_t count, const Eigen::Vector3d* side) {
  bound2_ = std::numeric_limits<double>::infinity();
  collect(place, 1e9F, side);
  if (near_.size < count) return;
  float furthest2 = 0.0F;
  for (std::size_t i = 0; i < near_.size; ++i)
    furthest2 = std::max(furthest2, near_.distance2[i]);
  const double bound = std::sqrt(static_cast<double>(distance2_of_nearest(count, furthest2))) * 1.00001 +
                       2.0 * static_cast<double>(slack_);
  bound2_ = bound * bound;
}

}  // namespace ray
