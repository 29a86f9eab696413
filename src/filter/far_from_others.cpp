#include "far_from_others.h"

#include <raycloud/core/error.h>
#include <raycloud/exec/parallel.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cmath>
#include <limits>
#include <utility>

namespace ray {
namespace {

using CellIndex = std::array<std::int64_t, 3>;

constexpr double kMostCells = 0x1p40;  // from the origin: there a cell is still divided into 2^13
constexpr int kBlockBits = 4;          // a block has 16 by 16 by 16 cells
constexpr std::int64_t kInBlock = (1 << kBlockBits) - 1;
constexpr int kReach = 2;  // cells on each side that may hold a point within the distance
constexpr std::size_t kWays = 2 * kReach + 1;
constexpr std::size_t kHashedAtOnce = 64;  // points whose buckets are fetched together
constexpr std::size_t kAhead = 24;         // places from which a point is fetched
constexpr std::size_t kPlaces = 1 << 14;   // of one piece of work

/// The cells around one, nearest first.
std::array<std::array<std::int8_t, 3>, kWays * kWays * kWays - 1> cells_around() {
  std::array<std::array<std::int8_t, 3>, kWays * kWays * kWays - 1> around{};
  std::size_t count = 0;
  for (std::int8_t x = -kReach; x <= kReach; ++x)
    for (std::int8_t y = -kReach; y <= kReach; ++y)
      for (std::int8_t z = -kReach; z <= kReach; ++z)
        if (x != 0 || y != 0 || z != 0) around[count++] = {x, y, z};
  const auto distance2 = [](const auto& c) { return c[0] * c[0] + c[1] * c[1] + c[2] * c[2]; };
  std::stable_sort(around.begin(), around.end(),
                   [&](const auto& a, const auto& b) { return distance2(a) < distance2(b); });
  return around;
}

/// Points in buckets by the hash of their cell. Points in one cell are always near each other, those near
/// each other never more than kReach cells apart. A bucket may hold points of several cells, in any order:
/// what is asked of it does not depend on that.
class CellBuckets {
 public:
  CellBuckets(const Context& context, std::span<const Eigen::Vector3d> points, double distance)
      : points_(points),
        cells_per_metre_(std::sqrt(3.0) / (0.999 * distance)),
        distance2_(distance * distance),
        bucket_mask_(std::bit_floor(points.size()) - 1),
        ends_(bucket_mask_ + 2),
        order_(points.size()) {
    // Counts go one bucket further, become beginnings as they are summed, and ends as the buckets are filled.
    each_bucket(context, [&](std::size_t, const Bucket& bucket) {
      std::atomic_ref(ends_[bucket.number + 1]).fetch_add(1, std::memory_order_relaxed);
    });
    std::uint32_t sum = 0;
    for (std::uint32_t& end : ends_)
      end = std::exchange(sum, sum + end);
    each_bucket(context, [&](std::size_t i, const Bucket& bucket) {
      const auto place = std::atomic_ref(ends_[bucket.number + 1]).fetch_add(1, std::memory_order_relaxed);
      order_[place] = {static_cast<std::uint32_t>(i), bucket.mark};
    });
  }

  /// The point at a place in the order of the buckets.
  [[nodiscard]] std::uint32_t at(std::size_t place) const {
    if (place + kAhead < order_.size()) __builtin_prefetch(&points_[order_[place + kAhead].point]);
    return order_[place].point;
  }

  /// Whether at least `wanted` others are near the point.
  [[nodiscard]] bool has_near(std::uint32_t i, std::uint64_t wanted) const {
    const CellIndex cell = cell_of(points_[i]);
    std::uint64_t found = near_in(cell, bucket_of(cell), i, wanted);
    if (found >= wanted) return true;

    // For each step along an axis: what it adds to the squared distance of a cell (in cells), whether it
    // leads into the other of the two blocks that it may reach, and its part of the bucket.
    struct Step {
      double gap2 = 0.0;
      std::uint8_t block = 0;
      std::uint32_t part = 0;
    };
    std::array<std::array<Step, kWays>, 3> steps{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double within =
          points_[i][static_cast<Eigen::Index>(axis)] * cells_per_metre_ - static_cast<double>(cell[axis]);
      const std::int64_t first_block = (cell[axis] - kReach) >> kBlockBits;
      for (int way = -kReach; way <= kReach; ++way) {
        const double gap = way > 0 ? way - within : way < 0 ? within - way - 1.0 : 0.0;
        const std::int64_t other = cell[axis] + way;
        steps[axis][static_cast<std::size_t>(way + kReach)] = {
            gap > 0.0 ? gap * gap : 0.0,
            static_cast<std::uint8_t>(((other >> kBlockBits) - first_block) << (2 - axis)),
            static_cast<std::uint32_t>((other & kInBlock) << (kBlockBits * (2 - axis)))};
      }
    }
    std::array<std::uint64_t, 8> hashes{};
    for (std::size_t b = 0; b < 8; ++b) {
      const auto block = [&](std::size_t axis) {
        return ((cell[axis] - kReach) >> kBlockBits) + static_cast<std::int64_t>((b >> (2 - axis)) & 1);
      };
      hashes[b] = block_hash(block(0), block(1), block(2));
    }
    constexpr double kNear2 = 3.0 * 1.01;  // a little more than the distance, for rounding
    static const auto kAround = cells_around();
    for (const auto& [x, y, z] : kAround) {
      const auto step = [&](std::size_t axis, int way) -> const Step& {
        return steps[axis][static_cast<std::size_t>(way + kReach)];
      };
      const Step &along_x = step(0, x), &along_y = step(1, y), &along_z = step(2, z);
      if (along_x.gap2 + along_y.gap2 + along_z.gap2 > kNear2) continue;
      const Bucket bucket = bucket_in(hashes[along_x.block | along_y.block | along_z.block],
                                      along_x.part | along_y.part | along_z.part);
      found += near_in({cell[0] + x, cell[1] + y, cell[2] + z}, bucket, i, wanted - found);
      if (found >= wanted) return true;
    }
    return false;
  }

 private:
  /// std::floor is a function call on the baseline instruction set.
  static std::int64_t rounded_down(double value) {
    const auto whole = static_cast<std::int64_t>(value);
    return whole - (value < static_cast<double>(whole) ? 1 : 0);
  }

  [[nodiscard]] CellIndex cell_of(const Eigen::Vector3d& point) const {
    return {rounded_down(point.x() * cells_per_metre_), rounded_down(point.y() * cells_per_metre_),
            rounded_down(point.z() * cells_per_metre_)};
  }

  /// Where a cell is, and what its block is marked with there.
  struct Bucket {
    std::size_t number = 0;
    std::uint32_t mark = 0;
  };
  struct Entry {
    std::uint32_t point = 0;
    std::uint32_t mark = 0;
  };

  static std::uint64_t block_hash(std::int64_t x, std::int64_t y, std::int64_t z) {
    const std::uint64_t sum = static_cast<std::uint64_t>(x) * 0x9e3779b97f4a7c15u +
                              static_cast<std::uint64_t>(y) * 0xc2b2ae3d27d4eb4fu +
                              static_cast<std::uint64_t>(z) * 0x165667b19e3779f9u;
    return (sum ^ (sum >> 29)) * 0xbf58476d1ce4e5b9u;
  }

  /// Cells of a block lie beside each other.
  [[nodiscard]] Bucket bucket_in(std::uint64_t hash, std::uint64_t part) const {
    return {static_cast<std::size_t>(((hash >> 32) << (3 * kBlockBits)) | part) & bucket_mask_,
            static_cast<std::uint32_t>(hash)};
  }

  [[nodiscard]] Bucket bucket_of(const CellIndex& cell) const {
    const auto block = [&](std::size_t axis) { return cell[axis] >> kBlockBits; };
    const auto part = [&](std::size_t axis) { return static_cast<std::uint64_t>(cell[axis] & kInBlock); };
    return bucket_in(block_hash(block(0), block(1), block(2)),
                     part(0) << (2 * kBlockBits) | part(1) << kBlockBits | part(2));
  }

  /// Calls `body(point, bucket)` for all points, at the same time.
  template <class Body>
  void each_bucket(const Context& context, const Body& body) {
    parallel_for(context, points_.size(), kPlaces, [&](std::size_t begin, std::size_t end) {
      std::array<Bucket, kHashedAtOnce> buckets{};
      for (; begin < end; begin += kHashedAtOnce) {
        const std::size_t count = std::min(kHashedAtOnce, end - begin);
        for (std::size_t k = 0; k < count; ++k) {
          buckets[k] = bucket_of(cell_of(checked(points_[begin + k])));
          __builtin_prefetch(&ends_[buckets[k].number + 1], 1);
        }
        for (std::size_t k = 0; k < count; ++k)
          body(begin + k, buckets[k]);
      }
    });
  }

  const Eigen::Vector3d& checked(const Eigen::Vector3d& point) const {
    const double furthest = std::max({std::abs(point.x()), std::abs(point.y()), std::abs(point.z())});
    if (!(furthest * cells_per_metre_ < kMostCells))
      throw Error(ErrorCode::out_of_range, "the cloud is too large for so small a distance: at most " +
                                               std::to_string(kMostCells / cells_per_metre_ / 1000.0) +
                                               " km from the origin");
    return point;
  }

  /// How many other points of the cell are near point i; no more than wanted.
  [[nodiscard]] std::uint64_t near_in(const CellIndex& cell, const Bucket& bucket, std::uint32_t i,
                                      std::uint64_t wanted) const {
    const Eigen::Vector3d& point = points_[i];
    std::uint64_t found = 0;
    for (std::uint32_t place = ends_[bucket.number]; place < ends_[bucket.number + 1] && found < wanted;
         ++place) {
      if (order_[place].mark != bucket.mark || order_[place].point == i) continue;
      const Eigen::Vector3d& other = points_[order_[place].point];
      const double dx = other.x() - point.x(), dy = other.y() - point.y(), dz = other.z() - point.z();
      if (dx * dx + dy * dy + dz * dz <= distance2_ && cell_of(other) == cell) ++found;
    }
    return found;
  }

  std::span<const Eigen::Vector3d> points_;
  double cells_per_metre_;
  double distance2_;
  std::size_t bucket_mask_;
  std::vector<std::uint32_t> ends_;  ///< of bucket b at b + 1
  std::vector<Entry> order_;         ///< the points, bucket after bucket
};

}  // namespace

std::vector<std::uint8_t> far_from_others(const Context& context, std::span<const Eigen::Vector3d> points,
                                          double distance, unsigned min_neighbours) {
  if (points.size() > std::numeric_limits<std::uint32_t>::max())
    throw Error(ErrorCode::out_of_range, "more than 4 294 967 295 points");
  if (points.size() <= min_neighbours) return std::vector<std::uint8_t>(points.size(), 1);
  std::vector<std::uint8_t> far(points.size());
  if (min_neighbours == 0) return far;
  const CellBuckets buckets(context, points, distance);
  parallel_for(context, points.size(), kPlaces, [&](std::size_t begin, std::size_t end) {
    for (std::size_t place = begin; place < end; ++place) {
      const std::uint32_t i = buckets.at(place);
      if (!buckets.has_near(i, min_neighbours)) far[i] = 1;
    }
  });
  return far;
}

}  // namespace ray
