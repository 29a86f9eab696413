#include "far_from_others.h"

#include "cell_bricks.h"

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

constexpr std::size_t kHashedAtOnce = 64;  // points whose buckets are fetched together
constexpr std::size_t kAskedAtOnce = 32;   // points whose surroundings are fetched together
constexpr std::size_t kAhead = 40;         // places from which a point is fetched
constexpr std::size_t kPlaces = 1 << 14;   // of one piece of work

/// Points in buckets by the hash of their brick, sorted by cell. A bucket may hold points of several bricks,
/// in any order: what is asked of it does not depend on that.
class BrickBuckets {
 public:
  BrickBuckets(const Context& context, std::span<const Eigen::Vector3d> points, double distance)
      : points_(points),
        bricks_(distance, std::bit_floor(points.size())),
        distance2_(distance * distance),
        ends_(bricks_.buckets() + 1),
        settled_(points.size()),
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
      order_[place] = {static_cast<std::uint32_t>(i), bucket.tag << CellBricks::kCellBits | cell};
    });
  }

  /// 1 for each point with fewer than `wanted` others near it.
  std::vector<std::uint8_t> without_near(const Context& context, std::uint64_t wanted) {
    constexpr std::size_t kBuckets = kPlaces / 2;
    parallel_for(context, bricks_.buckets(), kBuckets, [&](std::size_t begin, std::size_t end) {
      for (std::size_t bucket = begin; bucket < end; ++bucket)
        settle_in_cells(ends_[bucket], ends_[bucket + 1], wanted);
    });
    std::vector<std::uint8_t> without(points_.size());
    parallel_for(context, points_.size(), kPlaces, [&](std::size_t begin, std::size_t end) {
      std::array<Query, kAskedAtOnce> queries;
      std::size_t count = 0;
      for (std::size_t place = begin; place < end; ++place) {
        fetch(place + kAhead);
        if (is_settled(place)) continue;
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
  using Bucket = CellBricks::Bucket;
  static constexpr std::uint32_t kScanned = 8;       // entries that are looked at together
  static constexpr std::uint32_t kMostScanned = 64;  // of a bucket, one after the other
  static constexpr std::uint32_t kMostCandidates = 64;

  /// What is noted of a point: its cell in the brick, and above that the tag of its bucket.
  struct Entry {
    std::uint32_t point;
    std::uint32_t mark;

    [[nodiscard]] std::uint32_t tag() const { return mark >> CellBricks::kCellBits; }
    [[nodiscard]] bool is_in(std::uint64_t cells) const {
      return (cells >> (mark % CellBricks::kCells) & 1) != 0;
    }
  };
  struct Candidate {
    std::uint32_t point;
    std::uint32_t place;
    std::uint32_t brick;  ///< of the eight
  };

  void fetch(std::size_t place) {
    if (place < points_.size() && !is_settled(place)) __builtin_prefetch(&points_[order_[place].point]);
  }

  [[nodiscard]] bool is_settled(std::size_t place) {
    return std::atomic_ref(settled_[place]).load(std::memory_order_relaxed) != 0;
  }

  /// Sorts a bucket and settles the points that have enough company in their own cell.
  void settle_in_cells(std::size_t begin, std::size_t end, std::uint64_t wanted) {
    sort_entries({order_.get() + begin, end - begin});
    if (wanted == 1) return settle_pairs(begin, end);
    for (std::size_t next = begin; begin < end; begin = next) {
      while (next < end && order_[next].mark == order_[begin].mark)
        ++next;
      if (next - begin <= wanted) continue;
      for (std::size_t place = begin; place < next; ++place) {
        std::uint64_t found = 0;
        for (std::size_t other = begin; other < next && found < wanted; ++other)
          if (other != place && are_near(order_[place].point, order_[other].point)) ++found;
        if (found >= wanted) settled_[place] = 1;
      }
    }
  }

  /// Where one other is enough, those next to each other in a brick settle both.
  void settle_pairs(std::size_t begin, std::size_t end) {
    constexpr std::size_t kNext = 6;
    for (std::size_t place = begin; place + 1 < end; ++place)
      for (std::size_t other = place + 1; other < std::min(end, place + kNext + 1); ++other) {
        if (order_[other].tag() != order_[place].tag()) break;
        if ((settled_[place] & settled_[other]) != 0) continue;
        if (are_near(order_[place].point, order_[other].point)) settled_[place] = settled_[other] = 1;
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
    CellBricks::Index first{};
    std::array<Bucket, 8> buckets;
    std::array<std::uint32_t, 8> begins;  ///< of the buckets
    bool is_crowded = false;              ///< too many to list candidates
    std::uint32_t count = 0;
    std::array<Candidate, kMostCandidates + 1> candidates;
  };

  /// Marks those of the points with fewer than `wanted` others near them. Step by step for all, so that what
  /// one step needs is on its way while the others are at the step before.
  void answer(std::span<Query> queries, std::uint64_t wanted, std::vector<std::uint8_t>& without) {
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
    const CellBricks::Index cell = bricks_.cell_of(points_[query.point]);
    query.in_brick = CellBricks::in_brick(cell);
    query.first = CellBricks::first_around(cell);
    query.buckets = bricks_.buckets_around(query.first);
    for (const Bucket& bucket : query.buckets)
      __builtin_prefetch(&ends_[bucket.number]);
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
      const std::uint32_t in_bucket = (1U << std::min(count, kScanned)) - 1;
      alike |= std::uint64_t{alike_from(begin, bucket.tag) & in_bucket} << (8 * b);
    }
    query.count = 0;
    query.is_crowded = most > kMostScanned;
    if (query.is_crowded) return;
    list_candidates(query, alike, 0);
    if (most <= kScanned) return;
    for (std::uint32_t scanned = kScanned; scanned < most && !query.is_crowded; scanned += kScanned) {
      alike = 0;
      for (std::size_t b = 0; b < 8; ++b) {
        const Bucket& bucket = query.buckets[b];
        const std::uint32_t begin = query.begins[b], count = ends_[bucket.number + 1] - begin;
        if (count <= scanned) continue;
        const std::uint32_t in_bucket = (1U << std::min(count - scanned, kScanned)) - 1;
        alike |= std::uint64_t{alike_from(begin + scanned, bucket.tag) & in_bucket} << (8 * b);
      }
      list_candidates(query, alike, scanned);
    }
  }

  /// Those of the entries, a byte for each bucket, that are in the cells around.
  void list_candidates(Query& query, std::uint64_t alike, std::uint32_t scanned) const {
    if (query.count + static_cast<std::uint32_t>(std::popcount(alike)) > kMostCandidates) {
      query.is_crowded = true;
      return;
    }
    for (; alike != 0; alike &= alike - 1) {
      const auto bit = static_cast<std::uint32_t>(std::countr_zero(alike));
      const std::uint32_t place = query.begins[bit / 8] + scanned + bit % 8;
      const Entry& entry = order_[place];
      query.candidates[query.count] = {entry.point, place, bit / 8};
      __builtin_prefetch(&points_[entry.point]);
      query.count += entry.is_in(CellBricks::cells_around(query.in_brick, bit / 8)) ? 1 : 0;
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
      return _mm_cmpeq_epi32(_mm_srli_epi32(marks, CellBricks::kCellBits), wanted);
    };
    const __m128i both = _mm_packs_epi32(equal(entries), equal(entries + 4));
    return static_cast<std::uint32_t>(_mm_movemask_epi8(_mm_packs_epi16(both, _mm_setzero_si128())));
#else
    std::uint32_t alike = 0;
    for (std::uint32_t k = 0; k < kScanned; ++k)
      alike |= std::uint32_t{entries[k].tag() == tag} << k;
    return alike;
#endif
  }

  [[nodiscard]] bool has_near(const Query& query, std::uint64_t wanted) {
    std::uint64_t found = 0;
    const auto enough = [&](const Candidate& candidate) {
      if (candidate.point == query.point || !is_near_in(query, candidate)) return false;
      // Who is near enough to be company has company, and need not ask.
      if (wanted == 1) std::atomic_ref(settled_[candidate.place]).store(1, std::memory_order_relaxed);
      return ++found >= wanted;
    };
    if (!query.is_crowded) {
      for (const Candidate& candidate : std::span(query.candidates).first(query.count))
        if (enough(candidate)) return true;
      return false;
    }
    for (std::uint32_t b = 0; b < 8; ++b)
      for (const Entry& entry : entries_of(query.buckets[b]))
        if (entry.is_in(CellBricks::cells_around(query.in_brick, b)) &&
            enough({entry.point, static_cast<std::uint32_t>(&entry - order_.get()), b}))
          return true;
    return false;
  }

  /// Near, and really in that brick, so that none counts twice.
  [[nodiscard]] bool is_near_in(const Query& query, const Candidate& candidate) const {
    return are_near(query.point, candidate.point) &&
           CellBricks::brick_of(bricks_.cell_of(points_[candidate.point])) ==
               CellBricks::brick_around(query.first, candidate.brick);
  }

  /// Those of the bucket that have its tag.
  [[nodiscard]] std::span<const Entry> entries_of(const Bucket& bucket) const {
    const Entry* const entries = order_.get();
    const Entry* const end = entries + ends_[bucket.number + 1];
    const Entry* const begin =
        std::lower_bound(entries + ends_[bucket.number], end, bucket.tag,
                         [](const Entry& e, std::uint32_t tag) { return e.tag() < tag; });
    return {begin, std::upper_bound(begin, end, bucket.tag,
                                    [](std::uint32_t tag, const Entry& e) { return tag < e.tag(); })};
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
          bricks_.check(points_[begin + k]);
          const CellBricks::Index cell = bricks_.cell_of(points_[begin + k]);
          found[k] = {bricks_.bucket_of(CellBricks::brick_of(cell)), CellBricks::in_brick(cell)};
          __builtin_prefetch(&ends_[found[k].bucket.number + 1], 1);
        }
        for (std::size_t k = 0; k < count; ++k)
          body(begin + k, found[k].bucket, found[k].cell);
      }
    });
  }

  std::span<const Eigen::Vector3d> points_;
  CellBricks bricks_;
  double distance2_;
  std::vector<std::uint32_t> ends_;    ///< of bucket b at b + 1
  std::vector<std::uint8_t> settled_;  ///< by place: 1 if known to have enough others near
  std::unique_ptr<Entry[]> order_;     ///< the points, bucket after bucket, and kScanned more
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
