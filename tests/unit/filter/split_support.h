#pragma once
/// What the tests of splitting and combining share: random clouds with rays on borders, and the law.

#include "support/random_cloud.h"

#include <raycloud/core/error.h>
#include <raycloud/core/memory_stream.h>
#include <raycloud/filter/combine.h>
#include <raycloud/filter/partition.h>
#include <raycloud/filter/split.h>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <map>
#include <string>
#include <tuple>

namespace ray::test {

/// Unbounded, zero-length, duplicate and border-hugging rays within ±20 m of the origin, whose column
/// "number" says which is which.
inline RayCloud numbered_cloud(std::uint64_t seed, std::size_t rays) {
  RayCloud cloud =
      random_cloud(seed, {.rays = rays,
                          .half_extent = 10.0,
                          .float_coordinates = seed % 2 == 0,
                          .extras = {{"number", ScalarType::uint32}, {"real", ScalarType::float64}}});
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    cloud.extras[0].values<std::uint32_t>()[i] = static_cast<std::uint32_t>(i);
    // Some start or end exactly on whole metres, where the tests have borders.
    if (i % 11 == 3) cloud.ends[i] = cloud.ends[i].array().round();
    if (i % 13 == 5) cloud.starts[i] = cloud.starts[i].array().round();
  }
  return cloud;
}

struct Halves {
  RayCloud inside;
  RayCloud outside;
  SplitCounts counts;
};

inline Halves split(const RayCloud& cloud, const SplitRule& rule, const Context& context = {.threads = 1},
                    std::size_t chunk_rays = 64) {
  MemorySource source(cloud, chunk_rays);
  MemorySink inside(rule.columns(source.info().extras)), outside(rule.columns(source.info().extras));
  const SplitCounts counts = split_cloud(context, source, rule, inside, outside);
  return {inside.cloud(), outside.cloud(), counts};
}

inline std::map<PartKey, RayCloud> partition(const RayCloud& cloud, const PartitionRule& rule,
                                             const Context& context = {.threads = 1},
                                             std::size_t chunk_rays = 64) {
  MemorySource source(cloud, chunk_rays);
  const auto columns = rule.columns(source.info().extras);
  const Partition parts = partition_cloud(
      context, source, rule, [&](const PartKey&) { return std::make_unique<MemorySink>(columns); });
  std::map<PartKey, RayCloud> clouds;
  for (const auto& [key, part] : parts.parts) {
    clouds[key] = dynamic_cast<const MemorySink&>(*part.sink).cloud();
    EXPECT_EQ(part.rays, clouds[key].size());
  }
  return clouds;
}

inline double total_length(const RayCloud& cloud) {
  double sum = 0.0;
  for (std::size_t i = 0; i < cloud.size(); ++i)
    sum += (cloud.ends[i] - cloud.starts[i]).norm();
  return sum;
}

/// The rays as text with every bit, sorted: their order does not matter. `starts` may be left out.
inline std::vector<std::string> lines_of(const RayCloud& cloud, bool only_bounded_ends) {
  std::vector<std::string> lines;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (only_bounded_ends && cloud.bounded[i] == 0) continue;
    std::string line;
    const auto put = [&](const void* value, std::size_t size) {
      line.append(static_cast<const char*>(value), size);
    };
    put(cloud.ends[i].data(), 24);
    put(&cloud.times[i], 8);
    put(&cloud.colours[i], 4);
    put(&cloud.bounded[i], 1);
    for (const Column& column : cloud.extras) {
      if (column.name() != "clipped") put(column.data() + i * column.stride(), column.stride());
    }
    lines.push_back(std::move(line));
  }
  std::sort(lines.begin(), lines.end());
  return lines;
}

inline RayCloud together(const std::vector<RayCloud>& parts) {
  RayCloud all;
  for (const RayCloud& part : parts)
    all.append(part);
  return all;
}

/// The split–combine law: every bounded end once, with all its columns; the lengths add up.
inline void expect_law(const RayCloud& whole, const std::vector<RayCloud>& parts) {
  const RayCloud all = together(parts);
  RC_ASSERT(lines_of(all, true) == lines_of(whole, true));
  const double length = total_length(whole);
  RC_ASSERT(std::abs(total_length(all) - length) <= 1e-9 * (1.0 + length));
}

inline CombinedSource combined(const std::vector<RayCloud>& parts, std::size_t chunk_rays = 50) {
  std::vector<CloudToCombine> clouds;
  for (const RayCloud& part : parts) {
    clouds.push_back({"part " + std::to_string(clouds.size()),
                      [&part, chunk_rays] { return std::make_unique<MemorySource>(part, chunk_rays); }});
  }
  return CombinedSource(std::move(clouds));
}

inline RayCloud joined(const std::vector<RayCloud>& parts, const Context& context = {.threads = 1},
                       std::size_t chunk_rays = 50) {
  CombinedSource source = combined(parts, chunk_rays);
  const auto plan = plan_join(context, source);
  source.rewind();
  MemorySink sink(join_columns(*plan, source.info().extras));
  join_pieces(context, source, sink, *plan);
  return sink.cloud();
}

/// The rays in the order of their column "number".
inline RayCloud in_order(const RayCloud& cloud) {
  std::vector<std::size_t> order(cloud.size());
  for (std::size_t i = 0; i < order.size(); ++i)
    order[i] = i;
  const auto numbers = cloud.extra("number")->values<std::uint32_t>();
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return numbers[a] < numbers[b]; });
  RayCloud sorted;
  sorted.set_schema(schema_of(cloud));
  for (const std::size_t row : order) {
    std::vector<std::uint8_t> mask(cloud.size(), 0);
    mask[row] = 1;
    RayCloud one = cloud;
    one.select(mask);
    sorted.append(one);
  }
  return sorted;
}

/// The rays of `whole`: every bit, but starts of cut rays to rounding.
inline void expect_restored(const RayCloud& whole, const RayCloud& again) {
  RayCloud sorted = in_order(again);
  RC_ASSERT(sorted.size() == whole.size());
  for (std::size_t i = 0; i < whole.size(); ++i)
    RC_ASSERT((sorted.starts[i] - whole.starts[i]).norm() < 1e-5);
  sorted.starts = whole.starts;
  RC_ASSERT(same_bits(sorted, whole));
}

inline ErrorCode code_of(const std::function<void()>& call) {
  try {
    call();
  } catch (const Error& error) {
    return error.code();
  }
  ADD_FAILURE() << "nothing was thrown";
  return ErrorCode::cancelled;
}

}  // namespace ray::test
