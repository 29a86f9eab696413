#include "on_wire.h"

#include <raycloud/core/lanes.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace ray {
namespace {

constexpr std::size_t kAroundWire = 64;  // others that are looked at
constexpr double kRangeSigma = 0.6;      // spacings: of a range
constexpr double kAsideSigma = 0.2;      // spacings: of a point of a wire as seen from the sensor
constexpr double kDeviations2 = 9.0;     // squared: three standard deviations
constexpr double kWidthBeside = 3.0;     // of the strip around a wire that is empty, in widths of its own
constexpr double kWireAslant = 0.95;     // most cosine between a wire and the ray that ends on it
constexpr double kExtrapolated = 2.0;    // times the distance of the point that gives the direction

struct NearWire {
  Eigen::Vector3d offset;  // m, from the point in question
  Eigen::Vector3d ray;     // to the sensor
};

/// What is around a point that may be on a wire, nearest first: sums depend on their order.
std::vector<NearWire> around(NeighbourSearch& search, std::size_t place, double reach) {
  const PointTree& tree = search.tree();
  const auto found = search.nearest(place, kAroundWire, reach);
  std::vector<Neighbour> sorted(found.begin(), found.end());
  std::sort(sorted.begin(), sorted.end(), nearer_first(tree));
  std::vector<NearWire> result;
  for (const Neighbour& near : sorted)
    result.push_back(
        {tree.point(near.place) - tree.point(place), unpack_direction(tree.to_sensor(near.place))});
  return result;
}

/// How many of those on a line have to be on it, besides the one that gives the direction.
constexpr std::size_t kFewestOn = 2, kPartOn = 16;
bool are_enough(std::size_t others, std::size_t around) {
  return others >= kFewestOn && others * kPartOn >= around;
}

/// Most of what is seen along a wire is on it, and there is little beside it.
template <class Count>
bool are_of_wire(Count others, Count seen, Count beside) {
  return 3 * beside <= others && 3 * others >= 2 * seen;
}

using Floats = std::array<float, kAroundWire>;

/// Points around, in columns; those that are not taken are all at the point itself.
struct WireColumns {
  alignas(32) Floats x{}, y{}, z{}, ray_x{}, ray_y{}, ray_z{};  // spacings
};

/// A line, in spacings: across it to the side and in depth, and what the rays of its two points are there.
struct WireLine {
  Eigen::Vector3f along, side, depth;
  float other_side, other_depth, own_depth;
};

/// Of what WireTrial::add counts: no fewer that are on the line, no more that are seen along it or beside it.
struct WireCounts {
  std::int32_t on = 0, seen = 0, beside = 0;
};

/// What WireTrial::add asks, of many at once.
[[gnu::always_inline]] inline WireCounts count_on_line(const WireColumns& points, const WireLine& line) {
  constexpr auto kRange2 = static_cast<float>(kRangeSigma * kRangeSigma);
  constexpr auto kAside2 = static_cast<float>(kAsideSigma * kAsideSigma);
  constexpr auto kMostPart2 = static_cast<float>(kExtrapolated * kExtrapolated);
  constexpr auto kMost2 = static_cast<float>(kDeviations2);
  constexpr auto kMostBeside2 = static_cast<float>(kWidthBeside * kWidthBeside * kDeviations2);
  // What is rounded off is below a thousandth of each of the terms of a square.
  constexpr float kLess = 0.999F, kMore = 1.001F;
  const float along_x = line.along.x(), along_y = line.along.y(), along_z = line.along.z();
  const float side_x = line.side.x(), side_y = line.side.y(), side_z = line.side.z();
  const float depth_x = line.depth.x(), depth_y = line.depth.y(), depth_z = line.depth.z();
  const float other_side = line.other_side, other_depth = line.other_depth, own = line.own_depth;
  Floats on, seen, beside;  // below 0 where it is
  for (std::size_t i = 0; i < kAroundWire; ++i) {
    const float x = points.x[i], y = points.y[i], z = points.z[i];
    const float ray_x = points.ray_x[i], ray_y = points.ray_y[i], ray_z = points.ray_z[i];
    const float part = along_x * x + along_y * y + along_z * z;
    const float off = side_x * x + side_y * y + side_z * z;
    const float off_depth = depth_x * x + depth_y * y + depth_z * z;
    const float own_side = side_x * ray_x + side_y * ray_y + side_z * ray_z;
    const float near_depth = depth_x * ray_x + depth_y * ray_y + depth_z * ray_z;
    const float part2 = part * part, of_own = (1.0F - part) * own;
    const float to_side = kRange2 * (part2 * other_side * other_side + own_side * own_side) + kAside2;
    const float in_depth =
        kRange2 * (of_own * of_own + part2 * other_depth * other_depth + near_depth * near_depth) + kAside2;
    const float both = kRange2 * (part2 * other_side * other_depth + own_side * near_depth);
    const float aside2 = off * off, depth2 = off_depth * off_depth;
    const float square = in_depth * (kLess * aside2 - kMore * kMost2 * to_side) + kLess * to_side * depth2 +
                         both * (kMost2 * both - 2.0F * off * off_depth);
    on[i] = std::max(square, kLess * part2 - kMostPart2);
    const float surely_far = kMore * part2 - kMostPart2;
    seen[i] = std::max(kMore * aside2 - kMost2 * to_side, surely_far);
    beside[i] = std::max(std::max(kMost2 * to_side - kLess * aside2, kMore * aside2 - kMostBeside2 * to_side),
                         std::max(kMore * depth2 - kMost2 * in_depth, surely_far));
  }
  WireCounts counts;
  for (std::size_t i = 0; i < kAroundWire; ++i) {
    counts.on += on[i] <= 0.0F ? 1 : 0;
    counts.seen += seen[i] < 0.0F ? 1 : 0;
    counts.beside += beside[i] < 0.0F ? 1 : 0;
  }
  return counts;
}

WireCounts count_on_plain(const WireColumns& points, const WireLine& line) {
  return count_on_line(points, line);
}
#ifdef RAY_HAS_LANES
RAY_AVX2 WireCounts count_on_avx2(const WireColumns& points, const WireLine& line) {
  return count_on_line(points, line);
}
#endif
WireCounts count_on_fast(const WireColumns& points, const WireLine& line) {
#ifdef RAY_HAS_LANES
  if (lanes_in_use != LaneSet::kPlain) return count_on_avx2(points, line);
#endif
  return count_on_plain(points, line);
}

/// Whether it is worth trying a line: by single precision, in which many points go at once. Never false where
/// a trial would find a wire.
class WireGuess {
 public:
  WireGuess(std::span<const NearWire> others, double spacing) : count_(others.size()), scale_(1.0 / spacing) {
    for (std::size_t i = 0; i < count_; ++i) {
      const Eigen::Vector3f offset = (scale_ * others[i].offset).cast<float>();
      const Eigen::Vector3f ray = others[i].ray.cast<float>();
      points_.x[i] = offset.x(), points_.y[i] = offset.y(), points_.z[i] = offset.z();
      points_.ray_x[i] = ray.x(), points_.ray_y[i] = ray.y(), points_.ray_z[i] = ray.z();
    }
  }

  /// The line towards `other`, one of them, as seen along `ray`.
  [[nodiscard]] bool may_be_wire(const NearWire& other, const Eigen::Vector3d& ray) const {
    const Eigen::Vector3d way = other.offset.normalized();
    const Eigen::Vector3d across = way.cross(ray).normalized(), away = across.cross(way);
    const WireCounts counts =
        count_on_fast(points_, {.along = (way / (scale_ * other.offset.norm())).cast<float>(),
                                .side = across.cast<float>(),
                                .depth = away.cast<float>(),
                                .other_side = static_cast<float>(across.dot(other.ray)),
                                .other_depth = static_cast<float>(away.dot(other.ray)),
                                .own_depth = static_cast<float>(away.dot(ray))});
    // The places that are not taken are on the line, and so is the point that gives its direction.
    const auto none = static_cast<std::int32_t>(kAroundWire - count_);
    const std::int32_t others = counts.on - none - 1, seen = counts.seen - none - 1;
    return others > 0 && are_enough(static_cast<std::size_t>(others), count_) &&
           are_of_wire(others, seen, counts.beside);
  }

 private:
  std::size_t count_;
  double scale_;
  WireColumns points_;
};

/// One line through the point in question, and what lies on it.
class WireTrial {
 public:
  /// Towards `other`, as seen along `ray`. `range2` and `aside2`: variances, m².
  WireTrial(const NearWire& other, const Eigen::Vector3d& ray, double range2, double aside2)
      : length_(other.offset.norm()),
        direction_(other.offset / length_),
        side_(direction_.cross(ray).normalized()),
        depth_(side_.cross(direction_)),
        own_(across(ray)),
        other_(across(other.ray)),
        range2_(range2),
        aside2_(aside2) {
    put(other);
  }

  void add(const NearWire& near) {
    const double part = near.offset.dot(direction_) / length_;
    if (std::abs(part) > kExtrapolated) return;
    const Eigen::Vector2d off = across(near.offset);
    const Eigen::Vector2d ray = across(near.ray);
    // Of the offset from the line: the ranges of all three points are noisy, each along its ray. That of the
    // point in question has no part to the side.
    const double of_other = part * part;
    const double to_side = range2_ * (of_other * other_.x() * other_.x() + ray.x() * ray.x()) + aside2_;
    const double aside2 = off.x() * off.x();
    if (aside2 > kWidthBeside * kWidthBeside * kDeviations2 * to_side) return;
    const double of_own = (1.0 - part) * (1.0 - part);
    const double in_depth =
        range2_ * (of_own * own_.y() * own_.y() + of_other * other_.y() * other_.y() + ray.y() * ray.y()) +
        aside2_;
    if (aside2 > kDeviations2 * to_side) {
      if (off.y() * off.y() <= kDeviations2 * in_depth) ++beside_;
      return;
    }
    ++seen_;
    const double both = range2_ * (of_other * other_.x() * other_.y() + ray.x() * ray.y());
    const double square = in_depth * aside2 - 2.0 * both * off.x() * off.y() + to_side * off.y() * off.y();
    if (square <= kDeviations2 * (to_side * in_depth - both * both)) put(near);
  }

  /// Of so many points around.
  [[nodiscard]] bool is_wire(std::size_t around) const {
    const std::size_t others = on_ - 1;  // without the one that the line goes through anyway
    return are_enough(others, around) && are_of_wire(others, seen_, beside_) && is_on_it();
  }

 private:
  /// To the side, and in depth.
  [[nodiscard]] Eigen::Vector2d across(const Eigen::Vector3d& vector) const {
    return {side_.dot(vector), depth_.dot(vector)};
  }

  void put(const NearWire& near) {
    const double along = near.offset.dot(direction_), depth = near.offset.dot(depth_);
    ++on_;
    along_ += along, depth_sum_ += depth;
    along_along_ += along * along, along_depth_ += along * depth;
  }

  /// Whether the point itself is within the noise of the line through the others, in depth.
  [[nodiscard]] bool is_on_it() const {
    const auto count = static_cast<double>(on_);
    const double along = along_ / count, depth = depth_sum_ / count;
    const double spread = along_along_ / count - along * along;
    if (!(spread > 0.0)) return false;
    const double off = depth - along * (along_depth_ / count - along * depth) / spread;
    const double leverage = (1.0 + along * along / spread) / count;
    return off * off <= kDeviations2 * range2_ * own_.y() * own_.y() * (1.0 + leverage);
  }

  double length_;
  Eigen::Vector3d direction_, side_, depth_;
  Eigen::Vector2d own_, other_;  // rays
  double range2_, aside2_;
  std::size_t on_ = 0, seen_ = 0, beside_ = 0;
  double along_ = 0.0, depth_sum_ = 0.0, along_along_ = 0.0, along_depth_ = 0.0;
};

}  // namespace

bool is_on_wire(NeighbourSearch& search, std::size_t place, double spacing, double reach) {
  const Eigen::Vector3d ray = unpack_direction(search.tree().to_sensor(place)).normalized();
  const std::vector<NearWire> others = around(search, place, reach);
  const auto squared = [](double value) { return value * value; };
  if (others.size() <= kFewestOn) return false;
  const auto is_wire = [&](const NearWire& other) {
    WireTrial trial(other, ray, squared(kRangeSigma * spacing), squared(kAsideSigma * spacing));
    for (const NearWire& near : others)
      if (&near != &other) trial.add(near);
    return trial.is_wire(others.size());
  };
  const WireGuess guess(others, spacing);
  for (const NearWire& other : others) {
    const double length = other.offset.norm();
    if (!(length > spacing) || std::abs(other.offset.dot(ray)) > kWireAslant * length) continue;
    if (!guess.may_be_wire(other, ray))
      assert(!is_wire(other));
    else if (is_wire(other))
      return true;
  }
  return false;
}

}  // namespace ray
