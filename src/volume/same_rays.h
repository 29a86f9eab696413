#pragma once
/// Which rays of several clouds are the same.

#include "ray_key.h"

#include <raycloud/core/ray_stream.h>
#include <raycloud/exec/context.h>

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace ray {

struct NumberedRay {
  RayKey key;
  std::uint32_t number = 0;
  friend auto operator<=>(const NumberedRay&, const NumberedRay&) = default;
};

struct TimeSpan {
  double first = std::numeric_limits<double>::infinity();  ///< s; above `last` where there are no rays
  double last = -std::numeric_limits<double>::infinity();
};

/// The rays of all clouds, with numbers that go on from cloud to cloud: ray `i` of a chunk is number
/// `first[cloud] + raw.first_row + i`. Some numbers may have no ray.
struct NumberedRays {
  std::vector<std::uint64_t> first;  ///< of each cloud, and the number after the last
  std::vector<TimeSpan> times;       ///< of each cloud
  std::vector<NumberedRay> rays;     ///< in order of their keys, then of their numbers

  [[nodiscard]] std::size_t cloud_of(std::uint32_t number) const;
};

/// Reads every cloud once and rewinds it. 48 bytes a ray, of which 24 stay; about 0.3 µs of one core a ray.
/// Throws Error(out_of_range) for more than 4 billion rays.
[[nodiscard]] NumberedRays number_rays(const Context& context, std::span<RaySource* const> clouds,
                                       const RayKeyRule& rule);

/// `see(same)` for all rays of each key: a span of NumberedRay, in order of their numbers.
template <class See>
void each_group(const NumberedRays& numbered, const See& see) {
  const std::span<const NumberedRay> rays(numbered.rays);
  for (std::size_t begin = 0, end = 0; begin < rays.size(); begin = end) {
    while (end < rays.size() && rays[end].key == rays[begin].key)
      ++end;
    see(rays.subspan(begin, end - begin));
  }
}

/// For each number that of the ray that stands for it: the first of all clouds that is the same. Rays that
/// come several times in one cloud stand for as many in another, each for one. 4 bytes a ray.
[[nodiscard]] std::vector<std::uint32_t> leaders_of(const NumberedRays& numbered);

/// What two clouds must agree in to have the same rays.
[[nodiscard]] RayKeyRule key_rule(std::span<RaySource* const> clouds, std::vector<std::string> columns);

}  // namespace ray
