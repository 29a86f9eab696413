#pragma once
/// Keeping rays by what is remembered of cubes, in bounded memory: a part of all cubes at a time.

#include "row_bits.h"

#include <raycloud/exec/stream.h>
#include <raycloud/spatial/key_table.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace ray {

/// What tables may hold of the context's memory.
[[nodiscard]] inline std::size_t table_budget(const Context& context) {
  constexpr std::size_t kChunks = 100'000'000;
  const std::size_t memory = memory_budget(context);
  return std::max(memory / 2, memory - std::min(memory, kChunks));
}

/// Forgets a quarter of the range, again and again, until the rest fits. What is forgotten is for a later
/// pass.
template <class Tables>
void shrink_to_budget(Tables& tables, std::size_t budget, ShardRange& range) {
  while (tables.memory() > budget && range.end - range.first > 1) {
    range.end -= std::max(1U, (range.end - range.first) / 4);
    tables.restrict_to(range);
  }
}

/// The shards after `done`, as many as fill the budget if they are like those.
[[nodiscard]] inline ShardRange next_range(ShardRange done, std::size_t memory, std::size_t budget) {
  const double share = static_cast<double>(budget) / static_cast<double>(std::max<std::size_t>(memory, 1));
  const double width = std::min(share * (done.end - done.first), double{ShardRange::kShards});
  return {done.end, std::min(ShardRange::kShards, done.end + std::max(1U, static_cast<unsigned>(width)))};
}

/// Writes the rows from `settled` on whose bit is set; the first rows were written already.
inline std::uint64_t write_rows(const Context& context, RaySource& source, RaySink& sink, const RowBits& kept,
                                std::uint64_t settled) {
  source.rewind();
  std::uint64_t row = 0;
  const StreamCounts counts = stream(
      context, source, &sink, [](const RayCloud&) { return Nothing{}; },
      [&](RayCloud& rays, Nothing) {
        const std::uint64_t first = std::exchange(row, row + rays.size());
        return row <= settled ? std::vector<std::uint8_t>(rays.size()) : kept.mask(first, rays.size());
      });
  return counts.rays_out;
}

/// Streams the rays that `rule` keeps. A rule is
///   keys_of(rays) const            what it needs of a chunk, thread-safe
///   keep(rays, keys, range, mask)  sets mask[i] to 1 where ray i stays because of a cube in `range`, given
///                                  the rays before it; for cubes outside it neither says nor remembers
///   memory, restrict_to(range), clear()   of what it remembers
/// and keeps a ray if it does so because of any cube.
template <class Rule>
StreamCounts keep_by_keys(const Context& context, RaySource& source, RaySink& sink, Rule& rule) {
  using Keys = decltype(rule.keys_of(RayCloud{}));
  const std::size_t budget = table_budget(context);
  const auto keys_of = [&](const RayCloud& rays) { return rule.keys_of(rays); };
  ShardRange range;
  RowBits kept;               // of the rows after the settled ones
  std::uint64_t settled = 0;  // rows that are written or dropped for good
  std::uint64_t row = 0;
  const auto judge = [&](const RayCloud& rays, const Keys& keys) {
    std::vector<std::uint8_t> mask(rays.size());
    rule.keep(rays, keys, range, mask);
    row += rays.size();
    return mask;
  };
  StreamCounts counts = stream(context, source, &sink, keys_of, [&](RayCloud& rays, const Keys& keys) {
    std::vector<std::uint8_t> mask = judge(rays, keys);
    if (range.is_all()) {
      settled = row;
    } else {
      kept.set(row - mask.size(), mask);
      std::fill(mask.begin(), mask.end(), std::uint8_t{0});
    }
    shrink_to_budget(rule, budget, range);
    return mask;
  });
  if (range.is_all()) return counts;
  while (range.end < ShardRange::kShards) {
    range = next_range(range, rule.memory(), budget);
    rule.clear();
    source.rewind();
    row = 0;
    stream(context, source, nullptr, keys_of, [&](RayCloud& rays, const Keys& keys) {
      const std::vector<std::uint8_t> mask = judge(rays, keys);
      if (row > settled) kept.set(row - mask.size(), mask);
      shrink_to_budget(rule, budget, range);
    });
  }
  rule.clear();
  counts.rays_out += write_rows(context, source, sink, kept, settled);
  return counts;
}

}  // namespace ray
