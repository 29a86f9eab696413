#include "same_rays.h"

#include <raycloud/core/error.h>
#include <raycloud/exec/stream.h>

#include <algorithm>
#include <numeric>

namespace ray {
namespace {

constexpr std::uint64_t kMostNumbers = 0xffffffff;

}  // namespace

NumberedRays::NumberedRays(const Context& context, std::span<RaySource* const> sources,
                           const RayKeyRule& rule)
    : memory_(memory_budget(context)), most_(memory_ / (2 * sizeof(NumberedRay))) {
  std::uint64_t stated = 0;
  for (const RaySource* source : sources)
    stated += source->info().ray_count.value_or(0);
  rays_.reserve(std::min<std::uint64_t>(stated, most_));
  for (RaySource* source : sources)
    add_cloud(context, *source, rule);
}

void NumberedRays::add_cloud(const Context& context, RaySource& source, const RayKeyRule& rule) {
  struct OfChunk {
    std::vector<RayKey> keys;
    std::uint64_t first = 0, rows = 0;
    TimeSpan times;
  };
  NumberedCloud cloud{.source = &source, .first = numbers_, .times = {}};
  stream(
      context, source, nullptr,
      [&](const RayCloud& rays, const RawChunk& raw) {
        OfChunk chunk{ray_keys(rays, rule), raw.first_row, raw.rows, {}};
        for (const double time : rays.times)
          chunk.times.add({time, time});
        return chunk;
      },
      [&](const RayCloud&, const OfChunk& chunk) {
        const std::uint64_t first = cloud.first + chunk.first;
        numbers_ = std::max(numbers_, first + std::max<std::uint64_t>(chunk.rows, chunk.keys.size()));
        if (numbers_ > kMostNumbers) throw Error(ErrorCode::out_of_range, "more than 4 billion rays");
        add(chunk.keys, first);
        cloud.times.add(chunk.times);
      });
  source.rewind();
  clouds_.push_back(cloud);
}

void NumberedRays::add(std::span<const RayKey> keys, std::uint64_t first) {
  count_ += keys.size();
  for (std::size_t i = 0; i < keys.size(); ++i)
    rays_.push_back({keys[i], static_cast<std::uint32_t>(first + i)});
  if (parted_ || count_ > most_) part();
}

void NumberedRays::part() {
  constexpr int kShift = 56;
  if (!parted_) parted_ = std::make_unique<SpilledRows<NumberedRay>>(kParts, memory_ / 16);
  for (const NumberedRay& ray : rays_)
    parted_->append(ray.key.high >> kShift, {&ray, 1});
  rays_ = std::vector<NumberedRay>();
}

std::uint64_t NumberedRays::end_of_cloud_with(std::uint32_t number) const {
  const auto after =
      std::upper_bound(clouds_.begin(), clouds_.end(), number,
                       [](std::uint64_t of_ray, const NumberedCloud& cloud) { return of_ray < cloud.first; });
  return after == clouds_.end() ? numbers_ : after->first;
}

std::vector<std::uint32_t> leaders_of(const Context& context, NumberedRays& numbered) {
  std::vector<std::uint32_t> leaders(numbered.numbers());
  std::iota(leaders.begin(), leaders.end(), 0U);
  std::vector<std::uint32_t> of_copies;  // the first, second … of the same rays of one cloud
  numbered.each_group(context, [&](std::span<const NumberedRay> same) {
    of_copies.clear();
    std::size_t copy = 0;
    std::uint64_t next_cloud = 0;
    for (const NumberedRay& ray : same) {
      if (ray.number >= next_cloud) {
        copy = 0;
        next_cloud = numbered.end_of_cloud_with(ray.number);
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
