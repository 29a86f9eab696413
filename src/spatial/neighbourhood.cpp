#include <raycloud/core/lanes.h>
#include <raycloud/spatial/neighbourhood.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cmath>
#include <cstring>
#ifdef RAY_HAS_LANES
#include <immintrin.h>
#endif

namespace ray {
namespace {

/// Four at once where the processor can, else two and two.
using FourDoubles [[gnu::vector_size(32)]] = double;
using FourFloats [[gnu::vector_size(16)]] = float;
#ifdef RAY_HAS_LANES
using EightDoubles [[gnu::vector_size(64)]] = double;
#endif

/// Sums by lanes: in names of their own, so that they stay in registers.
template <class Lanes>
struct MomentSums {
  Lanes x{}, y{}, z{}, xx{}, xy{}, xz{}, yy{}, yz{}, zz{};

  /// By reference, as what holds wide registers is not passed to a function that does not know them.
  [[gnu::always_inline]] void add(const Lanes& at_x, const Lanes& at_y, const Lanes& at_z) {
    x += at_x, y += at_y, z += at_z;
    xx += at_x * at_x, xy += at_x * at_y, xz += at_x * at_z;
    yy += at_y * at_y, yz += at_y * at_z, zz += at_z * at_z;
  }
};

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

/// The inner loops, for processors with and without AVX2, and with AVX-512.
struct Neighbourhood::Kernels {
  /// Of lanes, with at least one that is nobody's.
  static std::size_t whole_groups(std::size_t size) { return (size / kLanes + 1) * kLanes; }

  /// All that the tree knows of the places.
  [[gnu::always_inline]] static void look_up(Neighbourhood& around) {
    const PointTree& tree = *around.tree_;
    const double x = tree.x_[around.place_], y = tree.y_[around.place_], z = tree.z_[around.place_];
    FourDoubles most{};
    for (std::size_t i = 0; i < whole_groups(around.size_); i += 4) {
      const std::uint32_t* n = around.places_.data() + i;
      const FourDoubles dx = four(tree.x_.data(), n) - x, dy = four(tree.y_.data(), n) - y,
                        dz = four(tree.z_.data(), n) - z;
      const FourDoubles distance2 = dx * dx + dy * dy + dz * dz;
      most = distance2 > most ? distance2 : most;
      put(dx, around.x_, i), put(dy, around.y_, i), put(dz, around.z_, i);
      put(distance2, around.distance2_, i);
      put(__builtin_convertvector(distance2, FourFloats), around.rounded2_, i);
      look_up_directions(around, i);
    }
    around.furthest2_ = greatest(most);
  }
  [[gnu::always_inline]] static void look_up_directions(Neighbourhood& around, std::size_t i) {
    const std::vector<PackedDirection>& to_sensor = around.tree_->to_sensor_;
    const std::uint32_t* n = around.places_.data() + i;
#ifdef __SSE2__
    const auto load = [&](std::size_t lane) {
      return _mm_loadl_epi64(reinterpret_cast<const __m128i*>(to_sensor[n[lane]].data()));
    };
    const auto floats = [](__m128i twice) { return _mm_cvtepi32_ps(_mm_srai_epi32(twice, 16)); };
    const __m128i low = _mm_unpacklo_epi16(load(0), load(1)), high = _mm_unpacklo_epi16(load(2), load(3));
    const __m128i xy = _mm_unpacklo_epi32(low, high), z = _mm_unpackhi_epi32(low, high);
    _mm_storeu_ps(around.to_sensor_x_.data() + i, floats(_mm_unpacklo_epi16(xy, xy)));
    _mm_storeu_ps(around.to_sensor_y_.data() + i, floats(_mm_unpackhi_epi16(xy, xy)));
    _mm_storeu_ps(around.to_sensor_z_.data() + i, floats(_mm_unpacklo_epi16(z, z)));
#else
    for (std::size_t lane = 0; lane < 4; ++lane) {
      const PackedDirection& direction = to_sensor[n[lane]];
      around.to_sensor_x_[i + lane] = direction[0];
      around.to_sensor_y_[i + lane] = direction[1];
      around.to_sensor_z_[i + lane] = direction[2];
    }
#endif
  }
  static void look_up_plain(Neighbourhood& around) {
    look_up(around);
  }

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
                                                   Within within) {
    constexpr int kGuesses = 12;
    const auto wanted = static_cast<float>(most);
    float low = 0.0F, high = static_cast<float>(around.furthest2_), low_count = 0.0F;
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
    return guess_nearest(around, some, most, within_plain);
  }

  /// By their numbers, or the first ones.
  template <class Number>
  [[gnu::always_inline]] static FourDoubles four(const double* column, const Number* n) {
    return FourDoubles{column[n[0]], column[n[1]], column[n[2]], column[n[3]]};
  }
  [[gnu::always_inline]] static FourDoubles four(const double* column, std::size_t first) {
    FourDoubles result;
    std::memcpy(&result, column + first, sizeof(result));
    return result;
  }
  template <class Four, class T>
  [[gnu::always_inline]] static void put(Four values, Column<T>& column, std::size_t first) {
    std::memcpy(column.data() + first, &values, sizeof(values));
  }
  [[gnu::always_inline]] static double greatest(const FourDoubles& of) {
    return std::max(std::max(of[0], of[1]), std::max(of[2], of[3]));
  }
  static constexpr double kRounds = 0x1.8p52;  // what is added to it becomes a whole number
  /// 2^22 of a power of two above the distance.
  static double scale_of(double furthest2) {
    int exponent = 0;
    const auto bits = std::bit_cast<std::uint64_t>(furthest2) >> 52;
    if (bits == 0 || bits == 0x7ff) {  // no normal number
      static_cast<void>(std::frexp(std::sqrt(furthest2), &exponent));
      return std::ldexp(1.0, 22 - exponent);
    }
    exponent = (static_cast<int>(bits) - 1021) >> 1;  // half that of the square, rounded up
    return std::bit_cast<double>(static_cast<std::uint64_t>(1023 + 22 - exponent) << 52);
  }
  template <class Numbers>
  [[gnu::always_inline]] static double furthest_of(const Neighbourhood& around, std::size_t count,
                                                   Numbers numbers) {
    FourDoubles most{};
    for (std::size_t i = 0; i < count; i += 4) {
      const FourDoubles distance2 = four(around.distance2_.data(), numbers(i));
      most = distance2 > most ? distance2 : most;
    }
    return greatest(most);
  }
  template <class Numbers>
  [[gnu::always_inline]] static void add_moments(const Neighbourhood& around, std::size_t count,
                                                 Numbers numbers, Moments& total) {
    total.furthest2 = furthest_of(around, count, numbers);
    if (!(total.furthest2 > 0.0)) return;
    const double scale = total.scale = scale_of(total.furthest2);
    MomentSums<FourDoubles> sums;
    for (std::size_t i = 0; i < count; i += 4) {
      const FourDoubles x = four(around.x_.data(), numbers(i)) * scale + kRounds - kRounds;
      const FourDoubles y = four(around.y_.data(), numbers(i)) * scale + kRounds - kRounds;
      const FourDoubles z = four(around.z_.data(), numbers(i)) * scale + kRounds - kRounds;
      sums.add(x, y, z);
    }
    put(sums, total);
  }
  [[gnu::always_inline]] static double sum_of(const FourDoubles& v) {
    return (v[0] + v[1]) + (v[2] + v[3]);
  }
  [[gnu::always_inline]] static void put(const MomentSums<FourDoubles>& sums, Moments& total) {
    total.sum = {sum_of(sums.x), sum_of(sums.y), sum_of(sums.z)};
    total.products = {sum_of(sums.xx), sum_of(sums.xy), sum_of(sums.xz),
                      sum_of(sums.yy), sum_of(sums.yz), sum_of(sums.zz)};
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

#ifdef RAY_HAS_LANES
  RAY_AVX2 static Some within_avx2(const Neighbourhood& around, float distance2) {
    const __m256 most = _mm256_set1_ps(distance2);
    Some bits = 0;
    for (std::size_t i = 0; i < around.size_; i += kLanes) {
      const __m256 inside = _mm256_cmp_ps(_mm256_load_ps(around.rounded2_.data() + i), most, _CMP_LE_OQ);
      bits |= static_cast<Some>(static_cast<unsigned>(_mm256_movemask_ps(inside))) << i;
    }
    return bits;
  }
  RAY_AVX2 static Some seen_from_avx2(const Neighbourhood& around, const Eigen::Vector3d& side,
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
  RAY_AVX2 static Some nearest_avx2(const Neighbourhood& around, Some some, std::size_t most) {
    return guess_nearest(around, some, most, within_avx2);
  }
  RAY_AVX2 static void moments_avx2(const Neighbourhood& around, Some some, Moments& total) {
    moments_of(around, some, total);
  }
  RAY_AVX2 static void look_up_avx2(Neighbourhood& around) {
    look_up(around);
  }

  /// The numbers of those of a set that are among eight; or of all of these.
  RAY_AVX512 static EightDoubles eight(const Column<double>& column, std::size_t i, Some some) {
    return _mm512_maskz_loadu_pd(static_cast<__mmask8>(some >> i), column.data() + i);
  }
  RAY_AVX512 static __m512d eight(const Column<float>& column, std::size_t i) {
    return _mm512_cvtps_pd(_mm256_load_ps(column.data() + i));
  }
  RAY_AVX512 static Some seen_from_avx512(const Neighbourhood& around, const Eigen::Vector3d& side,
                                          double at_least) {
    const __m512d sx = _mm512_set1_pd(side.x()), sy = _mm512_set1_pd(side.y()), sz = _mm512_set1_pd(side.z()),
                  least = _mm512_set1_pd(at_least);
    Some bits = 0;
    for (std::size_t i = 0; i < around.size_; i += 8) {
      const __m512d x = eight(around.to_sensor_x_, i), y = eight(around.to_sensor_y_, i),
                    z = eight(around.to_sensor_z_, i);
      const __m512d product =
          _mm512_add_pd(_mm512_add_pd(_mm512_mul_pd(sx, x), _mm512_mul_pd(sy, y)), _mm512_mul_pd(sz, z));
      bits |= Some{_mm512_cmp_pd_mask(product, least, _CMP_GE_OQ)} << i;
    }
    return bits & around.all();
  }
  RAY_AVX512 static EightDoubles rounded(EightDoubles value, double scale) {
    return value * scale + kRounds - kRounds;
  }
  RAY_AVX512 static double greatest_of(const EightDoubles& of) {
    const FourDoubles high = __builtin_shufflevector(of, of, 4, 5, 6, 7);
    const FourDoubles low = __builtin_shufflevector(of, of, 0, 1, 2, 3);
    return greatest(low > high ? low : high);
  }
  /// By halves: of two sums each pair of lanes, of four each half, and of eight all.
  RAY_AVX512 static EightDoubles pairs_of(const EightDoubles& a, const EightDoubles& b) {
    return __builtin_shufflevector(a, b, 0, 8, 2, 10, 4, 12, 6, 14) +
           __builtin_shufflevector(a, b, 1, 9, 3, 11, 5, 13, 7, 15);
  }
  RAY_AVX512 static EightDoubles halves_of(const EightDoubles& ab, const EightDoubles& cd) {
    return __builtin_shufflevector(ab, cd, 0, 1, 8, 9, 4, 5, 12, 13) +
           __builtin_shufflevector(ab, cd, 2, 3, 10, 11, 6, 7, 14, 15);
  }
  RAY_AVX512 static EightDoubles all_of(const EightDoubles& abcd, const EightDoubles& efgh) {
    return __builtin_shufflevector(abcd, efgh, 0, 1, 2, 3, 8, 9, 10, 11) +
           __builtin_shufflevector(abcd, efgh, 4, 5, 6, 7, 12, 13, 14, 15);
  }
  RAY_AVX512 static void put_eight(const MomentSums<EightDoubles>& sums, Moments& total) {
    const EightDoubles all = all_of(halves_of(pairs_of(sums.x, sums.y), pairs_of(sums.z, sums.xx)),
                                    halves_of(pairs_of(sums.xy, sums.xz), pairs_of(sums.yy, sums.yz)));
    total.sum = {all[0], all[1], all[2]};
    total.products = {all[3], all[4], all[5], all[6], all[7], sum_of(halves(sums.zz))};
  }
  RAY_AVX512 static FourDoubles halves(const EightDoubles& of) {
    return __builtin_shufflevector(of, of, 0, 1, 2, 3) + __builtin_shufflevector(of, of, 4, 5, 6, 7);
  }
  RAY_AVX512 static void moments_avx512(const Neighbourhood& around, Some some, Moments& total) {
    EightDoubles furthest2{};
    for (std::size_t i = 0; i < around.size_; i += 8) {
      const EightDoubles distance2 = eight(around.distance2_, i, some);
      furthest2 = distance2 > furthest2 ? distance2 : furthest2;
    }
    total.furthest2 = greatest_of(furthest2);
    if (!(total.furthest2 > 0.0)) return;
    const double scale = total.scale = scale_of(total.furthest2);
    MomentSums<EightDoubles> sums;
    for (std::size_t i = 0; i < around.size_; i += 8) {
      const EightDoubles x = rounded(eight(around.x_, i, some), scale),
                         y = rounded(eight(around.y_, i, some), scale),
                         z = rounded(eight(around.z_, i, some), scale);
      sums.add(x, y, z);
    }
    put_eight(sums, total);
  }
#endif

  static void look_up_fast(Neighbourhood& around) {
#ifdef RAY_HAS_LANES
    if (lanes_in_use != LaneSet::kPlain) return look_up_avx2(around);
#endif
    look_up_plain(around);
  }
  static Some seen_from_fast(const Neighbourhood& around, const Eigen::Vector3d& side, double at_least) {
#ifdef RAY_HAS_LANES
    if (lanes_in_use == LaneSet::kAvx512) return seen_from_avx512(around, side, at_least);
    if (lanes_in_use == LaneSet::kAvx2) return seen_from_avx2(around, side, at_least);
#endif
    return seen_from_plain(around, side, at_least);
  }
  static Some nearest_fast(const Neighbourhood& around, Some some, std::size_t most) {
#ifdef RAY_HAS_LANES
    if (lanes_in_use != LaneSet::kPlain) return nearest_avx2(around, some, most);
#endif
    return nearest_plain(around, some, most);
  }
  static void moments_fast(const Neighbourhood& around, Some some, Moments& total) {
#ifdef RAY_HAS_LANES
    if (lanes_in_use == LaneSet::kAvx512) return moments_avx512(around, some, total);
    if (lanes_in_use == LaneSet::kAvx2) return moments_avx2(around, some, total);
#endif
    moments_plain(around, some, total);
  }
};

void Neighbourhood::start(const PointTree& tree, std::size_t place, std::size_t size) {
  assert(size <= kMost);
  tree_ = &tree;
  place_ = place;
  size_ = size;
  const auto end = places_.begin() + static_cast<std::ptrdiff_t>(Kernels::whole_groups(size));
  std::fill(places_.begin() + static_cast<std::ptrdiff_t>(size), end, static_cast<std::uint32_t>(place));
}

void Neighbourhood::fill(const PointTree& tree, std::size_t place, std::span<const Neighbour> neighbours) {
  start(tree, place, neighbours.size());
  for (std::size_t i = 0; i < size_; ++i)
    places_[i] = neighbours[i].place;
  Kernels::look_up_fast(*this);
  furthest2_ = 0.0;
  for (std::size_t i = 0; i < size_; ++i) {
    distance2_[i] = neighbours[i].distance2;
    rounded2_[i] = static_cast<float>(neighbours[i].distance2);
    furthest2_ = std::max(furthest2_, neighbours[i].distance2);
  }
}

void Neighbourhood::fill(const PointTree& tree, std::size_t place, std::span<const std::uint32_t> places) {
  start(tree, place, places.size());
  std::copy(places.begin(), places.end(), places_.begin());
  Kernels::look_up_fast(*this);
}

Neighbourhood::Some Neighbourhood::nearest(Some some, std::size_t most) const {
  const auto count = static_cast<std::size_t>(std::popcount(some));
  if (count <= most) return some;
  if (most == 0) return 0;
  const Some guessed = Kernels::nearest_fast(*this, some, most);
  if (static_cast<std::size_t>(std::popcount(guessed)) == most) return guessed;
  ChosenNeighbours which(guessed, size_);
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

Neighbourhood::Moments Neighbourhood::moments(Some some) const {
  Moments result;
  Kernels::moments_fast(*this, some, result);
  return result;
}

}  // namespace ray
