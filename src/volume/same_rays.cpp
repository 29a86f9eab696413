#include "same_rays.h"

#include <raycloud/core/error.h>
#include <raycloud/exec/stream.h>

#include <algorithm>
#include <numeric>

namespace ray {
namespace {

constexpr std::uint64_t kMostNumbers = 0xffffffff;

/// Adds the rays of one cloud, the first of which gets the number after the last.
void number_cloud(const Context& context, RaySource& source, const RayKeyRule& rule, NumberedRays& numbered) {
  struct OfChunk {
    std::vector<RayKey> keys;
    std::uint64_t first = 0, rows = 0;
    TimeSpan times;
  };
  const std::uint64_t first = numbered.first.back();
  std::uint64_t next = first;
  TimeSpan times;
  stream(
      context, source, nullptr,
      [&](const RayCloud& rays, const RawChunk& raw) {
        OfChunk chunk{ray_keys(rays, rule), raw.first_row, raw.rows, {}};
        for (const double time : rays.times) {
          chunk.times.first = std::min(chunk.times.first, time);
          chunk.times.last = std::max(chunk.times.last, time);
        }
        return chunk;
      },
      [&](const RayCloud&, const OfChunk& chunk) {
        next = std::max(next, first + chunk.first + std::max<std::uint64_t>(chunk.rows, chunk.keys.size()));
        if (next > kMostNumbers) throw Error(ErrorCode::out_of_range, "more than 4 billion rays");
        for (std::size_t i = 0; i < chunk.keys.size(); ++i)
          numbered.rays.push_back({chunk.keys[i], static_cast<std::uint32_t>(first + chunk.first + i)});
        times.first = std::min(times.first, chunk.times.first);
        times.last = std::max(times.last, chunk.times.last);
      });
  source.rewind();
  numbered.times.push_back(times);
  numbered.first.push_back(next);
}

}  // namespace

std::size_t NumberedRays::cloud_of(std::uint32_t number) const {
  return static_cast<std::size_t>(std::upper_bound(first.begin(), first.end(), number) - first.begin() - 1);
}

NumberedRays number_rays(const Context& context, std::span<RaySource* const> clouds, const RayKeyRule& rule) {
  NumberedRays numbered;
  numbered.first.push_back(0);
  std::uint64_t stated = 0;
  for (const RaySource* cloud : clouds)
    stated += cloud->info().ray_count.value_or(0);
  numbered.rays.reserve(stated);
  for (RaySource* cloud : clouds)
    number_cloud(context, *cloud, rule, numbered);
  parallel_sort(context, numbered.rays.begin(), numbered.rays.end());
  return numbered;
}

std::vector<std::uint32_t> leaders_of(const NumberedRays& numbered) {
  std::vector<std::uint32_t> leaders(numbered.first.back());
  std::iota(leaders.begin(), leaders.end(), 0U);
  std::vector<std::uint32_t> of_copies;  // the first, second … of the same rays of one cloud
  each_group(numbered, [&](std::span<const NumberedRay> same) {
    of_copies.clear();
    std::size_t copy = 0;
    std::uint64_t next_cloud = 0;
    for (const NumberedRay& ray : same) {
      if (ray.number >= next_cloud) {
        copy = 0;
        next_cloud = numbered.first[numbered.cloud_of(ray.number) + 1];
      }
      if (copy == of_copies.size()) of_copies.push_back(ray.number);
      leaders[ray.number] = of_copies[copy++];
    }
  });
  return leaders;
}

RayKeyRule key_rule(std::span<RaySource* const> clouds, std::vector<std::string> columns) {
  const bool single = std::any_of(clouds.begin(), clouds.end(), [](const RaySource* cloud) {
    return cloud->info().precision == Precision::single;
  });
  return {.single_vectors = single, .columns = std::move(columns)};
}

}  // namespace ray
