#include <raycloud/spatial/neighbour_search.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <limits>

namespace ray {
namespace {

/// Squared distances, those that are not there infinite.
struct Distances {
  static constexpr std::size_t kLanes = 4;
  alignas(32) std::array<double, NeighbourSearch::kMost> values2;
  std::size_t size = 0;  // a multiple of the lanes
};

[[gnu::always_inline]] inline std::size_t count_within(const Distances& distances, double at) {
  using Doubles [[gnu::vector_size(Distances::kLanes * sizeof(double)), gnu::may_alias]] = double;
  using Wholes [[gnu::vector_size(Distances::kLanes * sizeof(double))]] = std::int64_t;
  const Doubles most = Doubles{} + at;
  Wholes less{};  // the number, below 0
  for (std::size_t i = 0; i < distances.size; i += Distances::kLanes)
    less += reinterpret_cast<const Doubles&>(distances.values2[i]) <= most;
  return static_cast<std::size_t>(-(less[0] + less[1] + less[2] + less[3]));
}

/// A squared distance within which there are as many as wanted, and seldom more. As the number of points on a
/// surface grows with the squared distance, a guess by proportion is soon right.
[[gnu::always_inline]] inline double guess_distance2(const Distances& distances, std::size_t count,
                                                     double furthest2, std::size_t most) {
  constexpr int kGuesses = 12;
  const auto wanted = static_cast<double>(most);
  double low = 0.0, high = furthest2;
  double low_count = 0.0, high_count = static_cast<double>(count);
  for (int guess = 0; guess < kGuesses && high_count > wanted; ++guess) {
    const double at = low + (high - low) * (wanted - low_count + 0.5) / (high_count - low_count + 1.0);
    const auto within = static_cast<double>(count_within(distances, at));
    (within >= wanted ? high : low) = at;
    (within >= wanted ? high_count : low_count) = within;
  }
  return high;
}

double guess_plain(const Distances& distances, std::size_t count, double furthest2, std::size_t most) {
  return guess_distance2(distances, count, furthest2, most);
}
#ifdef __x86_64__
[[gnu::target("avx2")]] double guess_avx2(const Distances& distances, std::size_t count, double furthest2,
                                          std::size_t most) {
  return guess_distance2(distances, count, furthest2, most);
}
const auto guess_fast = __builtin_cpu_supports("avx2") ? guess_avx2 : guess_plain;
#else
constexpr auto guess_fast = guess_plain;
#endif

}  // namespace

std::size_t keep_nearest(const PointTree& tree, std::span<Neighbour> neighbours, std::size_t most) {
  assert(neighbours.size() <= NeighbourSearch::kMost);
  if (neighbours.size() <= most || most == 0) return std::min(neighbours.size(), most);
  Distances distances;
  double furthest2 = 0.0;
  for (const Neighbour& neighbour : neighbours) {
    distances.values2[distances.size++] = neighbour.distance2;
    furthest2 = std::max(furthest2, neighbour.distance2);
  }
  for (; distances.size % Distances::kLanes != 0; ++distances.size)
    distances.values2[distances.size] = std::numeric_limits<double>::infinity();
  const double most2 = guess_fast(distances, neighbours.size(), furthest2, most);
  std::size_t kept = 0;
  for (const Neighbour neighbour : neighbours) {
    neighbours[kept] = neighbour;
    kept += neighbour.distance2 <= most2 ? 1 : 0;
  }
  if (kept > most) {
    const auto at = [&](std::size_t i) { return neighbours.begin() + static_cast<std::ptrdiff_t>(i); };
    std::nth_element(at(0), at(most), at(kept), nearer_first(tree));
  }
  return most;
}

}  // namespace ray
