#pragma once
/// One of several clouds whose rays have numbers that go on from cloud to cloud.

#include <raycloud/core/ray_stream.h>
#include <raycloud/volume/free_space.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace ray {

struct TimeSpan {
  double first = std::numeric_limits<double>::infinity();  ///< s; above `last` where there are no rays
  double last = -std::numeric_limits<double>::infinity();

  void add(const TimeSpan& other) {
    first = std::min(first, other.first);
    last = std::max(last, other.last);
  }
};

struct NumberedCloud {
  RaySource* source = nullptr;
  std::uint64_t first = 0;  ///< the number of its first row
  TimeSpan times;

  /// Of the first ray of a chunk; the others follow.
  [[nodiscard]] std::uint32_t first_of(const RawChunk& raw) const {
    return static_cast<std::uint32_t>(first + raw.first_row);
  }
  /// The times (s) by which looks are told apart. Where a cloud has no times, a thousand rays in its order
  /// are one look.
  [[nodiscard]] std::vector<double> look_times(const RayCloud& rays,
                                               std::span<const std::uint32_t> numbers) const {
    constexpr std::uint64_t kOneLook = 1000;
    std::vector<double> looks = rays.times;
    if (times.first < times.last) return looks;
    for (std::size_t i = 0; i < looks.size(); ++i)
      looks[i] = CountRule{}.look_time * (0.5 + static_cast<double>((numbers[i] - first) / kOneLook));
    return looks;
  }
};

}  // namespace ray
