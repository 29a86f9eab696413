#include "insertion_order.h"

#include <raycloud/exec/random.h>

#include <algorithm>
#include <bit>
#include <tuple>

namespace ray {
namespace {

constexpr int kCurveBits = 20;  // of each coordinate; what is nearer may come in any order

/// Place along the curve of Hilbert (Skilling, "Programming the Hilbert curve", 2004).
template <std::size_t N>
std::uint64_t curve_place(std::array<std::uint32_t, N> x) {
  for (std::uint32_t& coordinate : x)
    coordinate >>= 31 - kCurveBits;
  for (std::uint32_t q = 1u << (kCurveBits - 1); q > 1; q >>= 1) {
    const std::uint32_t below = q - 1;
    for (std::size_t i = 0; i < N; ++i) {
      if ((x[i] & q) != 0) {
        x[0] ^= below;
      } else {
        const std::uint32_t swapped = (x[0] ^ x[i]) & below;
        x[0] ^= swapped;
        x[i] ^= swapped;
      }
    }
  }
  for (std::size_t i = 1; i < N; ++i)
    x[i] ^= x[i - 1];
  std::uint32_t turned = 0;
  for (std::uint32_t q = 1u << (kCurveBits - 1); q > 1; q >>= 1)
    if ((x[N - 1] & q) != 0) turned ^= q - 1;
  std::uint64_t place = 0;
  for (int bit = kCurveBits - 1; bit >= 0; --bit) {
    for (std::size_t i = 0; i < N; ++i)
      place = place << 1 | (((x[i] ^ turned) >> bit) & 1u);
  }
  return place;
}

template <std::size_t N>
std::vector<std::uint32_t> order_of(const std::vector<std::array<std::uint32_t, N>>& points) {
  const RandomStream random(1, "insertion rounds");
  const int rounds = std::bit_width(points.size());
  struct Key {
    std::uint64_t place;
    std::uint32_t round;
    std::uint32_t index;
  };
  std::vector<Key> keys(points.size());
  for (std::uint32_t i = 0; i < keys.size(); ++i) {
    const int late = std::countl_zero(random.bits(i) | 1);  // half of the points come in the last round
    keys[i] = {curve_place<N>(points[i]), static_cast<std::uint32_t>(std::max(0, rounds - late)), i};
  }
  std::sort(keys.begin(), keys.end(), [](const Key& a, const Key& b) {
    return std::tie(a.round, a.place, a.index) < std::tie(b.round, b.place, b.index);
  });
  std::vector<std::uint32_t> order(points.size());
  for (std::size_t i = 0; i < keys.size(); ++i)
    order[i] = keys[i].index;
  return order;
}

}  // namespace

std::uint64_t place_on_curve(const std::array<std::uint32_t, 3>& point) {
  return curve_place<3>(point);
}

std::vector<std::uint32_t> insertion_order(const std::vector<std::array<std::uint32_t, 2>>& points) {
  return order_of(points);
}

std::vector<std::uint32_t> insertion_order(const std::vector<std::array<std::uint32_t, 3>>& points) {
  return order_of(points);
}

}  // namespace ray
