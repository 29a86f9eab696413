// The loops of point_sieve.h sixteen points at a time, where the processor can. The same operations in the
// same order, so the same bits.

#include "point_sieve_avx512.h"

#ifdef RAY_HAS_LANES
#include <immintrin.h>

namespace ray::avx512 {
namespace {

RAY_AVX512 inline __m512 all(float value) {
  return _mm512_set1_ps(value);
}
RAY_AVX512 inline __m512 from(const float* values) {
  return _mm512_loadu_ps(values);
}
RAY_AVX512 inline __m512i from(const std::uint32_t* values) {
  return _mm512_loadu_si512(values);
}
/// Those of the mask, one after the other.
RAY_AVX512 inline void put(float* to, __mmask16 some, __m512 values) {
  _mm512_storeu_ps(to, _mm512_maskz_compress_ps(some, values));
}
RAY_AVX512 inline void put(std::uint32_t* to, __mmask16 some, __m512i values) {
  _mm512_storeu_si512(to, _mm512_maskz_compress_epi32(some, values));
}
RAY_AVX512 inline std::size_t count_of(__mmask16 some) {
  return static_cast<std::size_t>(_mm_popcnt_u32(some));
}
RAY_AVX512 inline __m512 dot(__m512 ax, __m512 ay, __m512 az, __m512 bx, __m512 by, __m512 bz) {
  return _mm512_add_ps(_mm512_add_ps(_mm512_mul_ps(ax, bx), _mm512_mul_ps(ay, by)), _mm512_mul_ps(az, bz));
}
RAY_AVX512 inline void end_list(SievedPoints& near) {
  _mm512_storeu_ps(&near.distance2[near.size], all(std::numeric_limits<float>::infinity()));
}
/// Of the lanes in the mask, no others are read.
RAY_AVX512 inline __m512 less(const double* values, __m512d middle, __mmask16 some) {
  const auto low = static_cast<__mmask8>(some), high = static_cast<__mmask8>(some >> 8);
  const __m512d a = _mm512_maskz_loadu_pd(low, values), b = _mm512_maskz_loadu_pd(high, values + 8);
  return _mm512_insertf32x8(_mm512_castps256_ps512(_mm512_cvtpd_ps(_mm512_sub_pd(a, middle))),
                            _mm512_cvtpd_ps(_mm512_sub_pd(b, middle)), 1);
}
RAY_AVX512 inline __m512 outside(__m512 at, __m512 half) {
  return _mm512_max_ps(_mm512_sub_ps(_mm512_abs_ps(at), half), _mm512_setzero_ps());
}

template <bool kHasSide>
RAY_AVX512 bool near_points(const SievePoints& points, const SieveSphere& sphere, SievedPoints& near) {
  const __m512 x = all(sphere.middle[0]), y = all(sphere.middle[1]), z = all(sphere.middle[2]);
  const __m512 side_x = all(sphere.side[0]), side_y = all(sphere.side[1]), side_z = all(sphere.side[2]);
  const __m512 within2 = all(sphere.within2), doubt = all(sphere.doubt), less_doubt = all(-sphere.doubt);
  const __m512i self = _mm512_set1_epi32(static_cast<int>(sphere.self));
  unsigned doubtful = 0;
  std::size_t size = 0;
  for (std::size_t i = 0; i < points.size; i += 16) {
    const __m512 dx = _mm512_sub_ps(from(&points.x[i]), x), dy = _mm512_sub_ps(from(&points.y[i]), y),
                 dz = _mm512_sub_ps(from(&points.z[i]), z);
    const __m512 distance2 = dot(dx, dy, dz, dx, dy, dz);
    const __m512i place = from(&points.place[i]);
    __mmask16 is_near =
        _mm512_mask_cmp_ps_mask(_mm512_cmpneq_epi32_mask(place, self), distance2, within2, _CMP_LE_OQ);
    if (kHasSide) {
      const __m512 along = dot(side_x, side_y, side_z, from(&points.to_sensor_x[i]),
                               from(&points.to_sensor_y[i]), from(&points.to_sensor_z[i]));
      is_near = _mm512_mask_cmp_ps_mask(is_near, along, less_doubt, _CMP_GE_OQ);
      doubtful |= _mm512_mask_cmp_ps_mask(is_near, along, doubt, _CMP_LE_OQ);
    }
    put(&near.distance2[size], is_near, distance2);
    put(&near.place[size], is_near, place);
    size += count_of(is_near);
  }
  near.size = size;
  end_list(near);
  return doubtful != 0;
}

}  // namespace

RAY_AVX512 void sieve_box(const SieveSource& source, const SieveBox& box, SievePoints& points) {
  const __m512d middle_x = _mm512_set1_pd(box.middle[0]), middle_y = _mm512_set1_pd(box.middle[1]),
                middle_z = _mm512_set1_pd(box.middle[2]);
  const __m512 half_x = all(box.half[0]), half_y = all(box.half[1]), half_z = all(box.half[2]);
  const __m512 within2 = all(box.within2);
  __m512i place = _mm512_add_epi32(_mm512_set1_epi32(static_cast<int>(source.first)),
                                   _mm512_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15));
  std::size_t size = points.size;
  for (std::uint32_t i = 0; i < source.count; i += 16) {
    const std::size_t at = source.first + i;
    const std::uint32_t left = source.count - i;
    const auto some = static_cast<__mmask16>(left < 16 ? (1U << left) - 1 : 0xffffU);
    const __m512 x = less(source.columns[0] + at, middle_x, some),
                 y = less(source.columns[1] + at, middle_y, some),
                 z = less(source.columns[2] + at, middle_z, some);
    const __m512 out_x = outside(x, half_x), out_y = outside(y, half_y), out_z = outside(z, half_z);
    const __m512 distance2 = dot(out_x, out_y, out_z, out_x, out_y, out_z);
    const __mmask16 is_near = _mm512_mask_cmp_ps_mask(some, distance2, within2, _CMP_LE_OQ);
    put(&points.x[size], is_near, x);
    put(&points.y[size], is_near, y);
    put(&points.z[size], is_near, z);
    put(&points.place[size], is_near, place);
    size += count_of(is_near);
    place = _mm512_add_epi32(place, _mm512_set1_epi32(16));
  }
  points.size = size;
}

RAY_AVX512 bool sieve_sphere(const SievePoints& points, const SieveSphere& sphere, SievedPoints& near) {
  return sphere.has_side ? near_points<true>(points, sphere, near) : near_points<false>(points, sphere, near);
}

RAY_AVX512 std::size_t sieve_count(const SievedPoints& near, float distance2) {
  const __m512 most = all(distance2);
  std::size_t count = 0;
  for (std::size_t i = 0; i < near.size; i += 16)
    count += count_of(_mm512_cmp_ps_mask(from(&near.distance2[i]), most, _CMP_LE_OQ));
  return count;
}

RAY_AVX512 void sieve_further(SievedPoints& near, float distance2) {
  const __m512 most = all(distance2);
  std::size_t size = 0;
  for (std::size_t i = 0; i < near.size; i += 16) {
    const __m512 d = from(&near.distance2[i]);
    const __m512i place = from(&near.place[i]);
    const __mmask16 some = _mm512_cmp_ps_mask(d, most, _CMP_LE_OQ);
    put(&near.distance2[size], some, d);
    put(&near.place[size], some, place);
    size += count_of(some);
  }
  near.size = size;
  end_list(near);
}

}  // namespace ray::avx512

#endif
