#include "far_from_others.h"

#include <raycloud/core/error.h>
#include <raycloud/exec/parallel.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>

#ifdef __SSE2__
#include <emmintrin.h>
#endif

namespace ray {
namespace {

using CellIndex = std::array<std::int64_t, 3>;

constexpr double kMostCells = 0x1p40;  // from the origin: there a cell is still divided into 2^13
constexpr int kBrickBits = 2;          // a brick has 4 by 4 by 4 cells
constexpr int kBlockBits = 4;          // a block has 4 by 4 by 4 bricks
constexpr std::int64_t kInBrick = (1 << kBrickBits) - 1;
constexpr int kReach = 2;                  // cells on each side that may hold a point within the distance
constexpr std::size_t kHashedAtOnce = 64;  // points whose buckets are fetched together
constexpr std::size_t kAskedAtOnce = 32;   // points whose surroundings are fetched together
constexpr std::size_t kAhead = 40;         // places from which a point is fetched
constexpr std::size_t kPlaces = 1 << 14;   // of one piece of work

/// The number of a cell in its brick, or of a brick in its block.
constexpr std::uint32_t part_of(std::int64_t x, std::int64_t y, std::int64_t z) {
  return static_cast<std::uint32_t>((x & kInBrick) << (2 * kBrickBits) | (y & kInBrick) << kBrickBits |
                                    (z & kInBrick));
}

/// For each cell of a brick and each of the eight bricks that hold the cells around it, two along each axis:
/// a bit for each of their cells that is around.
auto cells_around() {
  std::array<std::array<std::uint64_t, 8>, 64> bits{};
  for (int at = 0; at < 64; ++at)
    for (int x = -kReach; x <= kReach; ++x)
      for (int y = -kReach; y <= kReach; ++y)
        for (int z = -kReach; z <= kReach; ++z) {
          const std::array<int, 3> from{at >> 4, at >> 2 & 3, at & 3};
          const std::array<int, 3> to{from[0] + x, from[1] + y, from[2] + z};
          int brick = 0;
          for (std::size_t axis = 0; axis < 3; ++axis)
            brick = 2 * brick + ((to[axis] >> kBrickBits) - ((from[axis] - kReach) >> kBrickBits));
          bits[static_cast<std::size_t>(at)][static_cast<std::size_t>(brick)] |=
              std::uint64_t{1} << part_of(to[0], to[1], to[2]);
        }
  return bits;
}
const auto kCellsAround = cells_around();  // too many steps for a compiler

/// Points in buckets by the hash of their brick, sorted by cell. Points in one cell are always near each
/// other, those near each other never more than kReach cells apart. A bucket may hold points of several
/// bricks, in any order: what is asked of it does not depend on that.
class BrickBuckets {
 public:
  BrickBuckets(const Context& context, std::span<const Eigen::Vector3d> points, double distance)
      : points_(points),
        cells_per_metre_(std::sqrt(3.0) / (0.999 * distance)),
        distance2_(distance * distance),
        bucket_mask_(static_cast<std::uint32_t>(std::bit_floor(points.size()) - 1)),
        ends_(std::size_t{bucket_mask_} + 2),
        order_(std::make_unique_for_overwrite<Entry[]>(points.size() + kScanned)) {
    std::fill_n(order_.get() + points.size(), kScanned, Entry{});
    // Counts go one bucket further, become beginnings as they are summed, and ends as the buckets are filled.
    each_bucket(context, [&](std::size_t, const Bucket& bucket, std::uint32_t) {
      std::atomic_ref(ends_[bucket.number + 1]).fetch_add(1, std::memory_order_relaxed);
    });
    std::uint32_t sum = 0;
    for (std::uint32_t& end : ends_)
      end = std::exchange(sum, sum + end);
    each_bucket(context, [&](std::size_t i, const Bucket& bucket, std::uint32_t cell) {
      const auto place = std::atomic_ref(ends_[bucket.number + 1]).fetch_add(1, std::memory_order_relaxed);
      order_[place] = {static_cast<std::uint32_t>(i), bucket.tag << kTagAt | cell << kCellAt};
    });
  }

  /// 1 for each point with fewer than `wanted` others near it.
  std::vector<std::uint8_t> without_near(const Context& context, std::uint64_t wanted) {
    constexpr std::size_t kBuckets = kPlaces / 2;
    parallel_for(context, std::size_t{bucket_mask_} + 1, kBuckets, [&](std::size_t begin, std::size_t end) {
      for (std::size_t bucket = begin; bucket < end; ++bucket)
        settle_in_cells(ends_[bucket], ends_[bucket + 1], wanted);
    });
    std::vector<std::uint8_t> without(points_.size());
    parallel_for(context, points_.size(), kPlaces, [&](std::size_t begin, std::size_t end) {
      std::array<Query, kAskedAtOnce> queries;
      std::size_t count = 0;
      for (std::size_t place = begin; place < end; ++place) {
        fetch(place + kAhead);
        if ((order_[place].mark & kSettled) != 0) continue;
        queries[count++].point = order_[place].point;
        if (count < kAskedAtOnce) continue;
        answer(queries, wanted, without);
        count = 0;
      }
      answer(std::span(queries).first(count), wanted, without);
    });
    return without;
  }

 private:
  // What an entry knows of its point: whether it is known to have others near it, its cell in the brick, and
  // 25 bits of the hash of the block.
  static constexpr std::uint32_t kSettled = 1;
  static constexpr int kCellAt = 1;
  static constexpr int kTagAt = 7;
  static constexpr std::uint32_t kMostTag = (1U << (32 - kTagAt)) - 1;
  static constexpr std::uint32_t kScanned = 8;  // entries that are looked at together

  /// Where a brick is, and what its points are marked with there.
  struct Bucket {
    std::uint32_t number = 0;
    std::uint32_t tag = 0;
  };
  struct Entry {
    std::uint32_t point;
    std::uint32_t mark;

    [[nodiscard]] bool is_in(std::uint64_t cells) const { return (cells >> (mark >> kCellAt & 63) & 1) != 0; }
  };
  struct Candidate {
    std::uint32_t point;
    std::uint32_t brick;  ///< of the eight
  };

  void fetch(std::size_t place) const {
    if (place < points_.size() && (order_[place].mark & kSettled) == 0)
      __builtin_prefetch(&points_[order_[place].point]);
  }

  /// Sorts a bucket and settles the points that have enough company in their own cell.
  void settle_in_cells(std::size_t begin, std::size_t end, std::uint64_t wanted) {
    sort_entries({order_.get() + begin, end - begin});
    for (std::size_t next = begin; begin < end; begin = next) {
      while (next < end && order_[next].mark >> kCellAt == order_[begin].mark >> kCellAt)
        ++next;
      if (next - begin <= wanted) continue;
      for (std::size_t place = begin; place < next; ++place) {
        std::uint64_t found = 0;
        for (std::size_t other = begin; other < next && found < wanted; ++other)
          if (other != place && are_near(order_[place].point, order_[other].point)) ++found;
        if (found >= wanted) order_[place].mark |= kSettled;
      }
    }
  }

  static void sort_entries(std::span<Entry> entries) {
    constexpr std::size_t kFew = 24;
    if (entries.size() > kFew) {
      std::sort(entries.begin(), entries.end(),
                [](const Entry& a, const Entry& b) { return a.mark < b.mark; });
      return;
    }
    for (std::size_t i = 1; i < entries.size(); ++i) {
      const Entry entry = entries[i];
      std::size_t to = i;
      for (; to > 0 && entry.mark < entries[to - 1].mark; --to)
        entries[to] = entries[to - 1];
      entries[to] = entry;
    }
  }

  [[nodiscard]] bool are_near(std::uint32_t a, std::uint32_t b) const {
    const double dx = points_[b].x() - points_[a].x(), dy = points_[b].y() - points_[a].y(),
                 dz = points_[b].z() - points_[a].z();
    return dx * dx + dy * dy + dz * dz <= distance2_;
  }

  /// A point that asks, the bricks that hold the cells around it, and the points in these cells.
  struct Query {
    std::uint32_t point = 0;
    std::uint32_t in_brick = 0;
    CellIndex first{};
    std::array<Bucket, 8> buckets;
    std::array<std::uint32_t, 8> begins;  ///< of the buckets
    bool is_crowded = false;  ///< a bucket has more than kScanned entries: no candidates are listed
    std::uint32_t count = 0;
    std::array<Candidate, std::size_t{8} * kScanned + 1> candidates;
  };

  /// Marks those of the points with fewer than `wanted` others near them. Step by step for all, so that what
  /// one step needs is on its way while the others are at the step before.
  void answer(std::span<Query> queries, std::uint64_t wanted, std::vector<std::uint8_t>& without) const {
    for (Query& query : queries)
      find_buckets(query);
    for (const Query& query : queries)
      for (const Bucket& bucket : query.buckets)
        __builtin_prefetch(&order_[ends_[bucket.number]]);
    for (Query& query : queries)
      find_candidates(query);
    for (const Query& query : queries)
      if (!has_near(query, wanted)) without[query.point] = 1;
  }

  void find_buckets(Query& query) const {
    const CellIndex cell = cell_of(points_[query.point]);
    query.in_brick = part_of(cell[0], cell[1], cell[2]);
    query.first = brick_of({cell[0] - kReach, cell[1] - kReach, cell[2] - kReach});
    for (std::size_t b = 0; b < 8; ++b) {
      query.buckets[b] = bucket_of(brick_at(query.first, b));
      __builtin_prefetch(&ends_[query.buckets[b].number]);
    }
  }

  /// Without a branch that could not be foreseen: which buckets hold points of their brick is chance.
  void find_candidates(Query& query) const {
    std::uint64_t alike = 0;  // a byte for each brick
    std::uint32_t most = 0;
    for (std::size_t b = 0; b < 8; ++b) {
      const Bucket& bucket = query.buckets[b];
      const std::uint32_t begin = ends_[bucket.number], count = ends_[bucket.number + 1] - begin;
      query.begins[b] = begin;
      most = std::max(most, count);
      const std::uint32_t in_bucket = (1U << (count & 15)) - 1;
      alike |= std::uint64_t{alike_from(begin, bucket.tag) & in_bucket} << (8 * b);
    }
    query.is_crowded = most > kScanned;
    if (query.is_crowded) return;
    query.count = 0;
    for (; alike != 0; alike &= alike - 1) {
      const auto bit = static_cast<std::uint32_t>(std::countr_zero(alike));
      const Entry& entry = order_[query.begins[bit / 8] + bit % 8];
      query.candidates[query.count] = {entry.point, bit / 8};
      __builtin_prefetch(&points_[entry.point]);
      query.count += entry.is_in(kCellsAround[query.in_brick][bit / 8]) ? 1 : 0;
    }
  }

  /// A bit for each of kScanned entries that has the tag.
  [[nodiscard]] std::uint32_t alike_from(std::uint32_t begin, std::uint32_t tag) const {
    const Entry* entries = order_.get() + begin;
#ifdef __SSE2__
    const __m128i wanted = _mm_set1_epi32(static_cast<int>(tag));
    const auto equal = [&](const Entry* four) {
      const __m128 low = _mm_loadu_ps(reinterpret_cast<const float*>(four));
      const __m128 high = _mm_loadu_ps(reinterpret_cast<const float*>(four + 2));
      const __m128i marks = _mm_castps_si128(_mm_shuffle_ps(low, high, 0xdd));
      return _mm_cmpeq_epi32(_mm_srli_epi32(marks, kTagAt), wanted);
    };
    const __m128i both = _mm_packs_epi32(equal(entries), equal(entries + 4));
    return static_cast<std::uint32_t>(_mm_movemask_epi8(_mm_packs_epi16(both, _mm_setzero_si128())));
#else
    std::uint32_t alike = 0;
    for (std::uint32_t k = 0; k < kScanned; ++k)
      alike |= std::uint32_t{entries[k].mark >> kTagAt == tag} << k;
    return alike;
#endif
  }

  [[nodiscard]] bool has_near(const Query& query, std::uint64_t wanted) const {
    std::uint64_t found = 0;
    if (!query.is_crowded) {
      for (const Candidate& candidate : std::span(query.candidates).first(query.count))
        if (candidate.point != query.point && is_near_in(query, candidate) && ++found >= wanted) return true;
      return false;
    }
    for (std::uint32_t b = 0; b < 8; ++b)
      for (const Entry& entry : entries_of(query.buckets[b]))
        if (entry.is_in(kCellsAround[query.in_brick][b]) && entry.point != query.point &&
            is_near_in(query, {entry.point, b}) && ++found >= wanted)
          return true;
    return false;
  }

  /// Near, and really in that brick, so that none counts twice.
  [[nodiscard]] bool is_near_in(const Query& query, const Candidate& candidate) const {
    return are_near(query.point, candidate.point) &&
           brick_of(cell_of(points_[candidate.point])) == brick_at(query.first, candidate.brick);
  }

  static CellIndex brick_at(const CellIndex& first, std::size_t number) {
    return {first[0] + static_cast<std::int64_t>(number >> 2),
            first[1] + static_cast<std::int64_t>(number >> 1 & 1),
            first[2] + static_cast<std::int64_t>(number & 1)};
  }

  /// Those of the bucket that have its tag.
  [[nodiscard]] std::span<const Entry> entries_of(const Bucket& bucket) const {
    const Entry* const entries = order_.get();
    const Entry* const end = entries + ends_[bucket.number + 1];
    const Entry* const begin =
        std::lower_bound(entries + ends_[bucket.number], end, bucket.tag,
                         [](const Entry& e, std::uint32_t tag) { return e.mark >> kTagAt < tag; });
    return {begin, std::upper_bound(begin, end, bucket.tag, [](std::uint32_t tag, const Entry& e) {
              return tag < e.mark >> kTagAt;
            })};
  }

  /// std::floor is a function call on the baseline instruction set.
  static std::int64_t rounded_down(double value) {
    const auto whole = static_cast<std::int64_t>(value);
    return whole - (value < static_cast<double>(whole) ? 1 : 0);
  }

  [[nodiscard]] CellIndex cell_of(const Eigen::Vector3d& point) const {
    return {rounded_down(point.x() * cells_per_metre_), rounded_down(point.y() * cells_per_metre_),
            rounded_down(point.z() * cells_per_metre_)};
  }

  static CellIndex brick_of(const CellIndex& cell) {
    return {cell[0] >> kBrickBits, cell[1] >> kBrickBits, cell[2] >> kBrickBits};
  }

  /// Bricks of a block lie beside each other.
  [[nodiscard]] Bucket bucket_of(const CellIndex& brick) const {
    constexpr int kInBlock = kBlockBits - kBrickBits;
    const auto block = [&](std::size_t axis) { return static_cast<std::uint64_t>(brick[axis] >> kInBlock); };
    const std::uint64_t sum =
        block(0) * 0x9e3779b97f4a7c15u + block(1) * 0xc2b2ae3d27d4eb4fu + block(2) * 0x165667b19e3779f9u;
    const std::uint64_t hash = (sum ^ (sum >> 29)) * 0xbf58476d1ce4e5b9u;
    return {
        static_cast<std::uint32_t>((hash >> 32) << (3 * kInBlock) | part_of(brick[0], brick[1], brick[2])) &
            bucket_mask_,
        static_cast<std::uint32_t>(hash) & kMostTag};
  }

  /// Calls `body(point, bucket, cell in the brick)` for all points, at the same time.
  template <class Body>
  void each_bucket(const Context& context, const Body& body) {
    struct Found {
      Bucket bucket;
      std::uint32_t cell;
    };
    parallel_for(context, points_.size(), kPlaces, [&](std::size_t begin, std::size_t end) {
      std::array<Found, kHashedAtOnce> found{};
      for (; begin < end; begin += kHashedAtOnce) {
        const std::size_t count = std::min(kHashedAtOnce, end - begin);
        for (std::size_t k = 0; k < count; ++k) {
          const CellIndex cell = cell_of(checked(points_[begin + k]));
          found[k] = {bucket_of(brick_of(cell)), part_of(cell[0], cell[1], cell[2])};
          __builtin_prefetch(&ends_[found[k].bucket.number + 1], 1);
        }
        for (std::size_t k = 0; k < count; ++k)
          body(begin + k, found[k].bucket, found[k].cell);
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

  std::span<const Eigen::Vector3d> points_;
  double cells_per_metre_;
  double distance2_;
  std::uint32_t bucket_mask_;
  std::vector<std::uint32_t> ends_;  ///< of bucket b at b + 1
  std::unique_ptr<Entry[]> order_;   ///< the points, bucket after bucket, and kScanned more
};

}  // namespace

std::vector<std::uint8_t> far_from_others(const Context& context, std::span<const Eigen::Vector3d> points,
                                          double distance, unsigned min_neighbours) {
  if (points.size() > std::numeric_limits<std::uint32_t>::max())
    throw Error(ErrorCode::out_of_range, "more than 4 294 967 295 points");
  if (points.size() <= min_neighbours) return std::vector<std::uint8_t>(points.size(), 1);
  if (min_neighbours == 0) return std::vector<std::uint8_t>(points.size());
  return BrickBuckets(context, points, distance).without_near(context, min_neighbours);
}

}  // namespace ray
