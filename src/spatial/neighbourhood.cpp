#include <raycloud/spatial/neighbourhood.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cmath>
#include <cstring>
#ifdef __x86_64__
#include <immintrin.h>
#endif

namespace ray {
namespace {

/// Four at once where the processor can, else two and two.
using FourDoubles [[gnu::vector_size(32)]] = double;

/// Numbers of those in a set, and how many; then up to three times the number of one that is not there.
struct ChosenNeighbours {
  std::array<std::uint8_t, Neighbourhood::kMost + 4> numbers;
  std::size_t count = 0;

  ChosenNeighbours(Neighbourhood::Some some, std::size_t nobody) {
    for (; some != 0; some &= some - 1)
      numbers[count++] = static_cast<std::uint8_t>(std::countr_zero(some));
    for (std::size_t i = count; i < count + 3; ++i)
      numbers[i] = static_cast<std::uint8_t>(nobody);
  }
};

}  // namespace

/// The inner loops, for processors with and without AVX2.
struct Neighbourhood::Kernels {
  static Some within_plain(const Neighbourhood& around, float distance2) {
    Some bits = 0;
    for (std::size_t i = 0; i < around.size_; ++i)
      bits |= Some{around.rounded2_[i] <= distance2} << i;
    return bits;
  }
  static Some seen_from_plain(const Neighbourhood& around, const Eigen::Vector3d& side, double at_least) {
    Some bits = 0;
    for (std::size_t i = 0; i < around.size_; ++i) {
      const double product = side.x() * static_cast<double>(around.to_sensor_x_[i]) +
                             side.y() * static_cast<double>(around.to_sensor_y_[i]) +
                             side.z() * static_cast<double>(around.to_sensor_z_[i]);
      bits |= Some{product >= at_least} << i;
    }
    return bits;
  }

  /// A squared distance within which there are as many as wanted, and seldom more. As the number of points on
  /// a surface grows with the squared distance, a guess by proportion is soon right.
  template <class Within>
  [[gnu::always_inline]] static Some guess_nearest(const Neighbourhood& around, Some some, std::size_t most,
                                                   float furthest2, Within within) {
    constexpr int kGuesses = 12;
    const auto wanted = static_cast<float>(most);
    float low = 0.0F, high = furthest2, low_count = 0.0F;
    auto high_count = static_cast<float>(std::popcount(some));
    Some result = some;
    for (int guess = 0; guess < kGuesses && high_count > wanted; ++guess) {
      const float at = low + (high - low) * ((wanted - low_count + 0.5F) / (high_count - low_count + 1.0F));
      const Some inside = within(around, at) & some;
      const auto count = static_cast<float>(std::popcount(inside));
      if (count >= wanted)
        high = at, high_count = count, result = inside;
      else
        low = at, low_count = count;
    }
    return result;
  }
  static Some nearest_plain(const Neighbourhood& around, Some some, std::size_t most) {
    const auto& rounded2 = around.rounded2_;
    const float furthest2 =
        *std::max_element(rounded2.begin(), rounded2.begin() + static_cast<std::ptrdiff_t>(around.size_));
    return guess_nearest(around, some, most, furthest2, within_plain);
  }

  /// By their numbers, or the first ones.
  [[gnu::always_inline]] static FourDoubles four(const Column<double>& column, const std::uint8_t* n) {
    return FourDoubles{column[n[0]], column[n[1]], column[n[2]], column[n[3]]};
  }
  [[gnu::always_inline]] static FourDoubles four(const Column<double>& column, std::size_t first) {
    FourDoubles result;
    std::memcpy(&result, column.data() + first, sizeof(result));
    return result;
  }
  template <class Numbers>
  [[gnu::always_inline]] static double furthest_of(const Neighbourhood& around, std::size_t count,
                                                   Numbers numbers) {
    FourDoubles most{};
    for (std::size_t i = 0; i < count; i += 4) {
      const FourDoubles distance2 = four(around.distance2_, numbers(i));
      most = distance2 > most ? distance2 : most;
    }
    return std::max(std::max(most[0], most[1]), std::max(most[2], most[3]));
  }
  template <class Numbers>
  [[gnu::always_inline]] static void add_moments(const Neighbourhood& around, std::size_t count,
                                                 Numbers numbers, Moments& total) {
    constexpr double kRounds = 0x1.8p52;
    total.furthest2 = furthest_of(around, count, numbers);
    if (!(total.furthest2 > 0.0)) return;
    int exponent = 0;
    static_cast<void>(std::frexp(std::sqrt(total.furthest2), &exponent));
    const double scale = total.scale = std::ldexp(1.0, 22 - exponent);
    std::array<FourDoubles, 9> sums{};
    for (std::size_t i = 0; i < count; i += 4) {
      const FourDoubles x = four(around.x_, numbers(i)) * scale + kRounds - kRounds;
      const FourDoubles y = four(around.y_, numbers(i)) * scale + kRounds - kRounds;
      const FourDoubles z = four(around.z_, numbers(i)) * scale + kRounds - kRounds;
      sums[0] += x, sums[1] += y, sums[2] += z;
      sums[3] += x * x, sums[4] += x * y, sums[5] += x * z;
      sums[6] += y * y, sums[7] += y * z, sums[8] += z * z;
    }
    const auto sum_of = [&](std::size_t i) { return sums[i][0] + sums[i][1] + sums[i][2] + sums[i][3]; };
    for (std::size_t i = 0; i < 3; ++i)
      total.sum[i] = sum_of(i);
    for (std::size_t i = 0; i < 6; ++i)
      total.products[i] = sum_of(3 + i);
  }
  [[gnu::always_inline]] static void moments_of(const Neighbourhood& around, Some some, Moments& total) {
    if (some == around.all()) {
      add_moments(
          around, around.size_, [](std::size_t i) { return i; }, total);
      return;
    }
    const ChosenNeighbours which(some, around.size_);
    add_moments(
        around, which.count, [&](std::size_t i) { return which.numbers.data() + i; }, total);
  }
  static void moments_plain(const Neighbourhood& around, Some some, Moments& total) {
    moments_of(around, some, total);
  }

#ifdef __x86_64__
  [[gnu::target("avx2")]] static Some within_avx2(const Neighbourhood& around, float distance2) {
    const __m256 most = _mm256_set1_ps(distance2);
    Some bits = 0;
    for (std::size_t i = 0; i < around.size_; i += kLanes) {
      const __m256 inside = _mm256_cmp_ps(_mm256_load_ps(around.rounded2_.data() + i), most, _CMP_LE_OQ);
      bits |= static_cast<Some>(static_cast<unsigned>(_mm256_movemask_ps(inside))) << i;
    }
    return bits;
  }
  [[gnu::target("avx2")]] static Some seen_from_avx2(const Neighbourhood& around, const Eigen::Vector3d& side,
                                                     double at_least) {
    const __m256d sx = _mm256_set1_pd(side.x()), sy = _mm256_set1_pd(side.y()), sz = _mm256_set1_pd(side.z()),
                  least = _mm256_set1_pd(at_least);
    Some bits = 0;
    for (std::size_t i = 0; i < around.size_; i += 4) {
      const __m256d x = _mm256_cvtps_pd(_mm_load_ps(around.to_sensor_x_.data() + i));
      const __m256d y = _mm256_cvtps_pd(_mm_load_ps(around.to_sensor_y_.data() + i));
      const __m256d z = _mm256_cvtps_pd(_mm_load_ps(around.to_sensor_z_.data() + i));
      const __m256d product =
          _mm256_add_pd(_mm256_add_pd(_mm256_mul_pd(sx, x), _mm256_mul_pd(sy, y)), _mm256_mul_pd(sz, z));
      const __m256d facing = _mm256_cmp_pd(product, least, _CMP_GE_OQ);
      bits |= static_cast<Some>(static_cast<unsigned>(_mm256_movemask_pd(facing))) << i;
    }
    return bits & around.all();
  }
  [[gnu::target("avx2")]] static Some nearest_avx2(const Neighbourhood& around, Some some, std::size_t most) {
    __m256 furthest2 = _mm256_setzero_ps();
    for (std::size_t i = 0; i < around.size_; i += kLanes)
      furthest2 = _mm256_max_ps(furthest2, _mm256_load_ps(around.rounded2_.data() + i));
    const __m128 of_four = _mm_max_ps(_mm256_castps256_ps128(furthest2), _mm256_extractf128_ps(furthest2, 1));
    const __m128 of_two = _mm_max_ps(of_four, _mm_movehl_ps(of_four, of_four));
    return guess_nearest(around, some, most, std::max(of_two[0], of_two[1]), within_avx2);
  }
  [[gnu::target("avx2")]] static void moments_avx2(const Neighbourhood& around, Some some, Moments& total) {
    moments_of(around, some, total);
  }
  static inline const bool kHasAvx2 = __builtin_cpu_supports("avx2") != 0;
  static inline const auto seen_from_fast = kHasAvx2 ? seen_from_avx2 : seen_from_plain;
  static inline const auto nearest_fast = kHasAvx2 ? nearest_avx2 : nearest_plain;
  static inline const auto moments_fast = kHasAvx2 ? moments_avx2 : moments_plain;
#else
  static constexpr auto seen_from_fast = seen_from_plain;
  static constexpr auto nearest_fast = nearest_plain;
  static constexpr auto moments_fast = moments_plain;
#endif
};

void Neighbourhood::fill(const PointTree& tree, std::size_t place, std::span<const Neighbour> neighbours) {
  assert(neighbours.size() <= kMost);
  tree_ = &tree;
  place_ = place;
  size_ = neighbours.size();
  const Eigen::Vector3d middle = tree.point(place);
  for (std::size_t i = 0; i < size_; ++i) {
    const Neighbour& neighbour = neighbours[i];
    places_[i] = neighbour.place;
    distance2_[i] = neighbour.distance2;
    rounded2_[i] = static_cast<float>(neighbour.distance2);
    const Eigen::Vector3d offset = tree.point(neighbour.place) - middle;
    x_[i] = offset.x(), y_[i] = offset.y(), z_[i] = offset.z();
    const PackedDirection& to_sensor = tree.to_sensor(neighbour.place);
    to_sensor_x_[i] = to_sensor[0], to_sensor_y_[i] = to_sensor[1], to_sensor_z_[i] = to_sensor[2];
  }
  for (std::size_t i = size_; i < (size_ / kLanes + 1) * kLanes; ++i) {
    distance2_[i] = 0.0;
    rounded2_[i] = 0.0F;
    x_[i] = y_[i] = z_[i] = 0.0;
    to_sensor_x_[i] = to_sensor_y_[i] = to_sensor_z_[i] = 0.0F;
  }
}

Neighbourhood::Some Neighbourhood::nearest(Some some, std::size_t most) const {
  const auto count = static_cast<std::size_t>(std::popcount(some));
  if (count <= most) return some;
  if (most == 0) return 0;
  const Some guessed = Kernels::nearest_fast(*this, some, most);
  ChosenNeighbours which(guessed, size_);
  if (which.count == most) return guessed;
  const auto begin = which.numbers.begin();
  std::nth_element(
      begin, begin + static_cast<std::ptrdiff_t>(most), begin + static_cast<std::ptrdiff_t>(which.count),
      [&](std::size_t a, std::size_t b) { return nearer_first(*tree_)(neighbour(a), neighbour(b)); });
  Some result = 0;
  for (std::size_t i = 0; i < most; ++i)
    result |= Some{1} << which.numbers[i];
  return result;
}

Neighbourhood::Some Neighbourhood::seen_from(const Eigen::Vector3d& side, double at_least) const {
  return Kernels::seen_from_fast(*this, side, at_least);
}

double Neighbourhood::furthest2() const {
  const auto end = distance2_.begin() + static_cast<std::ptrdiff_t>(size_);
  return size_ == 0 ? 0.0 : *std::max_element(distance2_.begin(), end);
}

Neighbourhood::Moments Neighbourhood::moments(Some some) const {
  Moments result;
  Kernels::moments_fast(*this, some, result);
  return result;
}

}  // namespace ray
