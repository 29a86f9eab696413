// The loops of point_sieve.h eight points at a time, where the processor can. The same operations in the same
// order, so the same bits.

#include "point_sieve.h"
#include "point_sieve_avx512.h"

#include <raycloud/core/lanes.h>

#ifdef RAY_HAS_LANES
#include <immintrin.h>

namespace ray {
namespace avx2 {
namespace {

/// The lanes whose bits are set, one after the other.
constexpr auto lanes_of_bits() {
  std::array<std::array<std::uint8_t, 8>, 256> lanes{};
  for (std::size_t bits = 0; bits < 256; ++bits)
    for (std::size_t lane = 0, next = 0; lane < 8; ++lane)
      if ((bits >> lane & 1) != 0) lanes[bits][next++] = static_cast<std::uint8_t>(lane);
  return lanes;
}
constexpr auto kLanesOfBits = lanes_of_bits();

/// Puts the lanes whose bits are set in front.
RAY_AVX2 inline __m256i order_of(int bits) {
  const auto* lanes = reinterpret_cast<const __m128i*>(kLanesOfBits[static_cast<std::size_t>(bits)].data());
  return _mm256_cvtepu8_epi32(_mm_loadl_epi64(lanes));
}
RAY_AVX2 inline std::size_t count_of(int bits) {
  return static_cast<std::size_t>(_mm_popcnt_u32(static_cast<unsigned>(bits)));
}
RAY_AVX2 inline void put(float* to, __m256 values, __m256i order) {
  _mm256_storeu_ps(to, _mm256_permutevar8x32_ps(values, order));
}
RAY_AVX2 inline __m256i load(const std::uint32_t* from) {
  return _mm256_loadu_si256(reinterpret_cast<const __m256i*>(from));
}
RAY_AVX2 inline void put(std::uint32_t* to, __m256i values, __m256i order) {
  _mm256_storeu_si256(reinterpret_cast<__m256i*>(to), _mm256_permutevar8x32_epi32(values, order));
}
RAY_AVX2 inline __m256 dot(__m256 ax, __m256 ay, __m256 az, __m256 bx, __m256 by, __m256 bz) {
  return _mm256_add_ps(_mm256_add_ps(_mm256_mul_ps(ax, bx), _mm256_mul_ps(ay, by)), _mm256_mul_ps(az, bz));
}
RAY_AVX2 inline void end_list(SievedPoints& near) {
  _mm256_storeu_ps(&near.distance2[near.size], _mm256_set1_ps(std::numeric_limits<float>::infinity()));
}
RAY_AVX2 inline __m256 less(const double* values, __m256d middle) {
  const __m128 low = _mm256_cvtpd_ps(_mm256_sub_pd(_mm256_loadu_pd(values), middle));
  const __m128 high = _mm256_cvtpd_ps(_mm256_sub_pd(_mm256_loadu_pd(values + 4), middle));
  return _mm256_set_m128(high, low);
}
RAY_AVX2 inline __m256 outside(__m256 at, __m256 half) {
  const __m256 size = _mm256_andnot_ps(_mm256_set1_ps(-0.0F), at);
  return _mm256_max_ps(_mm256_sub_ps(size, half), _mm256_setzero_ps());
}

RAY_AVX2 void sieve_box(const SieveSource& source, const SieveBox& box, SievePoints& points) {
  const __m256d middle_x = _mm256_set1_pd(box.middle[0]), middle_y = _mm256_set1_pd(box.middle[1]),
                middle_z = _mm256_set1_pd(box.middle[2]);
  const __m256 half_x = _mm256_set1_ps(box.half[0]), half_y = _mm256_set1_ps(box.half[1]),
               half_z = _mm256_set1_ps(box.half[2]);
  const __m256 within2 = _mm256_set1_ps(box.within2);
  const __m256i step = _mm256_set1_epi32(8);
  __m256i place = _mm256_add_epi32(_mm256_set1_epi32(static_cast<int>(source.first)),
                                   _mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7));
  std::size_t size = points.size;
  for (std::uint32_t i = 0; i < source.count; i += 8) {
    const std::size_t at = source.first + i;
    const __m256 x = less(source.columns[0] + at, middle_x), y = less(source.columns[1] + at, middle_y),
                 z = less(source.columns[2] + at, middle_z);
    const __m256 out_x = outside(x, half_x), out_y = outside(y, half_y), out_z = outside(z, half_z);
    const __m256 distance2 = dot(out_x, out_y, out_z, out_x, out_y, out_z);
    int bits = _mm256_movemask_ps(_mm256_cmp_ps(distance2, within2, _CMP_LE_OQ));
    if (source.count - i < 8) bits &= (1 << (source.count - i)) - 1;
    const __m256i order = order_of(bits);
    put(&points.x[size], x, order);
    put(&points.y[size], y, order);
    put(&points.z[size], z, order);
    put(&points.place[size], place, order);
    size += count_of(bits);
    place = _mm256_add_epi32(place, step);
  }
  points.size = size;
}

template <bool kHasSide>
RAY_AVX2 bool sieve_sphere(const SievePoints& points, const SieveSphere& sphere, SievedPoints& near) {
  const __m256 x = _mm256_set1_ps(sphere.middle[0]), y = _mm256_set1_ps(sphere.middle[1]),
               z = _mm256_set1_ps(sphere.middle[2]);
  const __m256 side_x = _mm256_set1_ps(sphere.side[0]), side_y = _mm256_set1_ps(sphere.side[1]),
               side_z = _mm256_set1_ps(sphere.side[2]);
  const __m256 within2 = _mm256_set1_ps(sphere.within2);
  const __m256 doubt = _mm256_set1_ps(sphere.doubt), less_doubt = _mm256_set1_ps(-sphere.doubt);
  const __m256i self = _mm256_set1_epi32(static_cast<int>(sphere.self));
  __m256 doubtful = _mm256_setzero_ps();
  std::size_t size = 0;
  for (std::size_t i = 0; i < points.size; i += 8) {
    const __m256 dx = _mm256_sub_ps(_mm256_load_ps(&points.x[i]), x),
                 dy = _mm256_sub_ps(_mm256_load_ps(&points.y[i]), y),
                 dz = _mm256_sub_ps(_mm256_load_ps(&points.z[i]), z);
    const __m256 distance2 = dot(dx, dy, dz, dx, dy, dz);
    const __m256i place = load(&points.place[i]);
    __m256 is_near = _mm256_andnot_ps(_mm256_castsi256_ps(_mm256_cmpeq_epi32(place, self)),
                                      _mm256_cmp_ps(distance2, within2, _CMP_LE_OQ));
    if (kHasSide) {
      const __m256 along =
          dot(side_x, side_y, side_z, _mm256_load_ps(&points.to_sensor_x[i]),
              _mm256_load_ps(&points.to_sensor_y[i]), _mm256_load_ps(&points.to_sensor_z[i]));
      is_near = _mm256_and_ps(is_near, _mm256_cmp_ps(along, less_doubt, _CMP_GE_OQ));
      doubtful = _mm256_or_ps(doubtful, _mm256_and_ps(is_near, _mm256_cmp_ps(along, doubt, _CMP_LE_OQ)));
    }
    const int bits = _mm256_movemask_ps(is_near);
    const __m256i order = order_of(bits);
    put(&near.distance2[size], distance2, order);
    put(&near.place[size], place, order);
    size += count_of(bits);
  }
  near.size = size;
  end_list(near);
  return _mm256_movemask_ps(doubtful) != 0;
}

RAY_AVX2 void sieve_body(const SievePoints& points, const SieveBody& body, SievedPoints& near) {
  const __m256 x = _mm256_set1_ps(body.centre[0]), y = _mm256_set1_ps(body.centre[1]),
               z = _mm256_set1_ps(body.centre[2]);
  const __m256 xx = _mm256_set1_ps(body.shape[0]), xy = _mm256_set1_ps(body.shape[1]),
               xz = _mm256_set1_ps(body.shape[2]), yy = _mm256_set1_ps(body.shape[3]),
               yz = _mm256_set1_ps(body.shape[4]), zz = _mm256_set1_ps(body.shape[5]);
  const __m256 rounding = _mm256_set1_ps(body.rounding), most = _mm256_set1_ps(body.most);
  std::size_t size = 0;
  for (std::size_t i = 0; i < points.size; i += 8) {
    const __m256 dx = _mm256_sub_ps(_mm256_load_ps(&points.x[i]), x),
                 dy = _mm256_sub_ps(_mm256_load_ps(&points.y[i]), y),
                 dz = _mm256_sub_ps(_mm256_load_ps(&points.z[i]), z);
    const __m256 value = dot(dx, dy, dz, dot(xx, xy, xz, dx, dy, dz), dot(xy, yy, yz, dx, dy, dz),
                             dot(xz, yz, zz, dx, dy, dz));
    const __m256 wrong = _mm256_mul_ps(rounding, dot(dx, dy, dz, dx, dy, dz));
    const int bits = _mm256_movemask_ps(_mm256_cmp_ps(_mm256_sub_ps(value, wrong), most, _CMP_LE_OQ));
    if (bits == 0) continue;
    const __m256i order = order_of(bits);
    put(&near.distance2[size], _mm256_add_ps(value, wrong), order);
    put(&near.place[size], load(&points.place[i]), order);
    size += count_of(bits);
  }
  near.size = size;
  end_list(near);
}

RAY_AVX2 std::size_t sieve_count(const SievedPoints& near, float distance2) {
  const __m256 most = _mm256_set1_ps(distance2);
  std::size_t count = 0;
  for (std::size_t i = 0; i < near.size; i += 8)
    count +=
        count_of(_mm256_movemask_ps(_mm256_cmp_ps(_mm256_load_ps(&near.distance2[i]), most, _CMP_LE_OQ)));
  return count;
}

RAY_AVX2 void sieve_further(SievedPoints& near, float distance2) {
  const __m256 most = _mm256_set1_ps(distance2);
  std::size_t size = 0;
  for (std::size_t i = 0; i < near.size; i += 8) {
    const __m256 d = _mm256_load_ps(&near.distance2[i]);
    const __m256i place = load(&near.place[i]);
    const int bits = _mm256_movemask_ps(_mm256_cmp_ps(d, most, _CMP_LE_OQ));
    const __m256i order = order_of(bits);
    put(&near.distance2[size], d, order);
    put(&near.place[size], place, order);
    size += count_of(bits);
  }
  near.size = size;
  end_list(near);
}

RAY_AVX2 float sieve_least_sum(const SievePoints& points, const std::array<float, 3>& middle,
                               const float* values, std::size_t count) {
  const __m256 x = _mm256_set1_ps(middle[0]), y = _mm256_set1_ps(middle[1]), z = _mm256_set1_ps(middle[2]);
  __m256 least = _mm256_set1_ps(std::numeric_limits<float>::infinity());
  for (std::size_t i = 0; i < count; i += 8) {
    const __m256 dx = _mm256_sub_ps(_mm256_load_ps(&points.x[i]), x),
                 dy = _mm256_sub_ps(_mm256_load_ps(&points.y[i]), y),
                 dz = _mm256_sub_ps(_mm256_load_ps(&points.z[i]), z);
    const __m256 distance = _mm256_sqrt_ps(dot(dx, dy, dz, dx, dy, dz));
    least = _mm256_min_ps(_mm256_add_ps(distance, _mm256_load_ps(values + i)), least);
  }
  __m128 four = _mm_min_ps(_mm256_castps256_ps128(least), _mm256_extractf128_ps(least, 1));
  four = _mm_min_ps(four, _mm_movehl_ps(four, four));
  return _mm_cvtss_f32(_mm_min_ss(four, _mm_shuffle_ps(four, four, 1)));
}

}  // namespace
}  // namespace avx2

void sieve_box(const SieveSource& source, const SieveBox& box, SievePoints& points) {
  if (lanes_in_use == LaneSet::kAvx512) return avx512::sieve_box(source, box, points);
  lanes_in_use == LaneSet::kAvx2 ? avx2::sieve_box(source, box, points)
                                 : plain::sieve_box(source, box, points);
}
bool sieve_sphere(const SievePoints& points, const SieveSphere& sphere, SievedPoints& near) {
  if (lanes_in_use == LaneSet::kAvx512) return avx512::sieve_sphere(points, sphere, near);
  if (lanes_in_use == LaneSet::kPlain) return plain::sieve_sphere(points, sphere, near);
  return sphere.has_side ? avx2::sieve_sphere<true>(points, sphere, near)
                         : avx2::sieve_sphere<false>(points, sphere, near);
}
void sieve_body(const SievePoints& points, const SieveBody& body, SievedPoints& near) {
  lanes_in_use == LaneSet::kPlain ? plain::sieve_body(points, body, near)
                                  : avx2::sieve_body(points, body, near);
}
std::size_t sieve_count(const SievedPoints& near, float distance2) {
  if (lanes_in_use == LaneSet::kAvx512) return avx512::sieve_count(near, distance2);
  return lanes_in_use == LaneSet::kAvx2 ? avx2::sieve_count(near, distance2)
                                        : plain::sieve_count(near, distance2);
}
void sieve_further(SievedPoints& near, float distance2) {
  if (lanes_in_use == LaneSet::kAvx512) return avx512::sieve_further(near, distance2);
  lanes_in_use == LaneSet::kAvx2 ? avx2::sieve_further(near, distance2)
                                 : plain::sieve_further(near, distance2);
}
float sieve_least_sum(const SievePoints& points, const std::array<float, 3>& middle, const float* values,
                      std::size_t count) {
  return lanes_in_use == LaneSet::kPlain ? plain::sieve_least_sum(points, middle, values, count)
                                         : avx2::sieve_least_sum(points, middle, values, count);
}

}  // namespace ray

#else

namespace ray {

void sieve_box(const SieveSource& source, const SieveBox& box, SievePoints& points) {
  plain::sieve_box(source, box, points);
}
bool sieve_sphere(const SievePoints& points, const SieveSphere& sphere, SievedPoints& near) {
  return plain::sieve_sphere(points, sphere, near);
}
void sieve_body(const SievePoints& points, const SieveBody& body, SievedPoints& near) {
  plain::sieve_body(points, body, near);
}
std::size_t sieve_count(const SievedPoints& near, float distance2) {
  return plain::sieve_count(near, distance2);
}
void sieve_further(SievedPoints& near, float distance2) {
  plain::sieve_further(near, distance2);
}
float sieve_least_sum(const SievePoints& points, const std::array<float, 3>& middle, const float* values,
                      std::size_t count) {
  return plain::sieve_least_sum(points, middle, values, count);
}

}  // namespace ray

#endif
