#include "insertion_order.h"

#include <raycloud/exec/random.h>

#include <algorithm>
#include <bit>
#include <tuple>

namespace ray {
namespace {

constexpr int kCurveBits = kPlaneCurveBits / 2;  // of each coordinate; what is nearer may come in any order

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

/// Half of the points come in the last round.
class InsertionRounds {
 public:
  explicit InsertionRounds(std::size_t points) : last_(std::bit_width(points)) {}
  [[nodiscard]] std::uint32_t operator()(std::uint32_t point) const {
    return static_cast<std::uint32_t>(std::max(0, last_ - std::countl_zero(random_.bits(point) | 1)));
  }
  [[nodiscard]] std::size_t count() const { return static_cast<std::size_t>(last_) + 1; }

 private:
  RandomStream random_{1, "insertion rounds"};
  int last_;
};

template <std::size_t N>
std::vector<std::uint32_t> order_of(const std::vector<std::array<std::uint32_t, N>>& points) {
  const InsertionRounds round_of(points.size());
  struct Key {
    std::uint64_t place;
    std::uint32_t round;
    std::uint32_t index;
  };
  std::vector<Key> keys(points.size());
  for (std::uint32_t i = 0; i < keys.size(); ++i)
    keys[i] = {curve_place<N>(points[i]), round_of(i), i};
  std::sort(keys.begin(), keys.end(), [](const Key& a, const Key& b) {
    return std::tie(a.round, a.place, a.index) < std::tie(b.round, b.place, b.index);
  });
  std::vector<std::uint32_t> order(points.size());
  for (std::size_t i = 0; i < keys.size(); ++i)
    order[i] = keys[i].index;
  return order;
}

}  // namespace

std::uint64_t place_on_curve(const std::array<std::uint32_t, 2>& point) {
  return curve_place<2>(point);
}

std::uint64_t place_on_curve(const std::array<std::uint32_t, 3>& point) {
  return curve_place<3>(point);
}

std::vector<std::uint32_t> insertion_order_along_curve(std::size_t points) {
  const InsertionRounds round_of(points);
  std::vector<std::size_t> next(round_of.count() + 1, 0);
  std::vector<std::uint8_t> rounds(points);
  for (std::uint32_t i = 0; i < points; ++i) {
    rounds[i] = static_cast<std::uint8_t>(round_of(i));
    ++next[rounds[i] + std::size_t{1}];
  }
  for (std::size_t round = 1; round < next.size(); ++round)
    next[round] += next[round - 1];
  std::vector<std::uint32_t> order(points);
  for (std::uint32_t i = 0; i < points; ++i)
    order[next[rounds[i]]++] = i;
  return order;
}

std::vector<std::uint32_t> insertion_order(const std::vector<std::array<std::uint32_t, 2>>& points) {
  return order_of(points);
}

std::vector<std::uint32_t> insertion_order(const std::vector<std::array<std::uint32_t, 3>>& points) {
  return order_of(points);
}

}  // namespace ray
