// The loops of ellipsoid_lanes.h with all eight at once, where the processor can. The same operations in the
// same order, so the same bits.

#include "ellipsoid_lanes.h"

#include <raycloud/core/lanes.h>

#ifdef RAY_HAS_LANES
#include <immintrin.h>

#include <cmath>

namespace ray {
namespace avx2 {
namespace {

RAY_AVX2 inline __m256 lanes(const EightFloats& eight) {
  return _mm256_loadu_ps(eight.data());
}
RAY_AVX2 inline __m256 times(__m256 a, __m256 b) {
  return _mm256_mul_ps(a, b);
}
RAY_AVX2 inline __m256 plus(__m256 a, __m256 b) {
  return _mm256_add_ps(a, b);
}
RAY_AVX2 inline __m256 less(__m256 a, __m256 b) {
  return _mm256_sub_ps(a, b);
}
RAY_AVX2 inline __m256 dot(__m256 ax, __m256 ay, __m256 az, __m256 bx, __m256 by, __m256 bz) {
  return plus(plus(times(ax, bx), times(ay, by)), times(az, bz));
}
RAY_AVX2 inline __m256 at_least_zero(__m256 a) {
  return _mm256_cmp_ps(a, _mm256_setzero_ps(), _CMP_GE_OQ);
}
RAY_AVX2 inline __m256 above_zero(__m256 a) {
  return _mm256_cmp_ps(a, _mm256_setzero_ps(), _CMP_GT_OQ);
}
RAY_AVX2 inline __m256 both(__m256 a, __m256 b) {
  return _mm256_and_ps(a, b);
}
RAY_AVX2 inline std::uint32_t bits_of(__m256 a) {
  return static_cast<std::uint32_t>(_mm256_movemask_ps(a));
}

RAY_AVX2 std::uint32_t boxes_on_line(const std::array<EightFloats, 3>& min,
                                     const std::array<EightFloats, 3>& max, const LineInBoxes& line) {
  __m256 enters = _mm256_setzero_ps(), leaves = _mm256_set1_ps(line.reach);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const bool up = line.inverse[axis] > 0.0F;
    const __m256 near = lanes(up ? min[axis] : max[axis]), far = lanes(up ? max[axis] : min[axis]);
    const __m256 from = _mm256_set1_ps(line.from[axis]), inverse = _mm256_set1_ps(line.inverse[axis]);
    enters = _mm256_max_ps(times(less(near, from), inverse), enters);
    leaves = _mm256_min_ps(times(less(far, from), inverse), leaves);
  }
  return bits_of(at_least_zero(less(leaves, enters)));
}

RAY_AVX2 CrossedLanes ellipsoids_on_line(const std::array<EightFloats, 3>& centre,
                                         const std::array<EightFloats, 6>& shape,
                                         const LineAtEllipsoids& line) {
  const __m256 dx = _mm256_set1_ps(line.direction[0]), dy = _mm256_set1_ps(line.direction[1]),
               dz = _mm256_set1_ps(line.direction[2]);
  const __m256 xx = lanes(shape[0]), xy = lanes(shape[1]), xz = lanes(shape[2]), yy = lanes(shape[3]),
               yz = lanes(shape[4]), zz = lanes(shape[5]);
  const __m256 wx = less(_mm256_set1_ps(line.at[0]), lanes(centre[0])),
               wy = less(_mm256_set1_ps(line.at[1]), lanes(centre[1])),
               wz = less(_mm256_set1_ps(line.at[2]), lanes(centre[2]));
  const __m256 sx = dot(xx, xy, xz, dx, dy, dz), sy = dot(xy, yy, yz, dx, dy, dz),
               sz = dot(xz, yz, zz, dx, dy, dz);
  const __m256 from2 =
      dot(wx, wy, wz, dot(xx, xy, xz, wx, wy, wz), dot(xy, yy, yz, wx, wy, wz), dot(xz, yz, zz, wx, wy, wz));
  const __m256 way2 = dot(dx, dy, dz, sx, sy, sz);
  const __m256 along = dot(wx, wy, wz, sx, sy, sz);
  const __m256 w2 = dot(wx, wy, wz, wx, wy, wz);
  const __m256 half2 = plus(less(way2, times(from2, way2)), times(along, along));
  const __m256 unit = times(_mm256_set1_ps(kFormRounding), plus(plus(xx, yy), zz));
  const __m256 doubt2 = plus(plus(times(times(_mm256_set1_ps(2.0F), unit), plus(times(w2, way2), from2)),
                                  times(_mm256_set1_ps(kChordRoom), way2)),
                             unit);
  const __m256 most2 = plus(half2, doubt2);
  const __m256 met = at_least_zero(most2);
  if (bits_of(met) == 0) return {};
  const __m256 w = _mm256_sqrt_ps(w2);
  const __m256 room = times(_mm256_set1_ps(kChordRoom), _mm256_sqrt_ps(way2));
  const __m256 least2 = less(half2, doubt2);
  const __m256 start = _mm256_set1_ps(line.start), end = _mm256_set1_ps(line.end);
  const __m256 before = _mm256_xor_ps(_mm256_set1_ps(-0.0F), plus(times(start, way2), along));
  const __m256 behind = plus(times(end, way2), along);
  const __m256 before_doubt = plus(times(unit, plus(_mm256_set1_ps(std::abs(line.start)), w)), room);
  const __m256 behind_doubt = plus(times(unit, plus(_mm256_set1_ps(std::abs(line.end)), w)), room);
  const __m256 most_before = plus(before, before_doubt), most_behind = plus(behind, behind_doubt);
  CrossedLanes crossed;
  const __m256 perhaps = both(
      met,
      both(both(at_least_zero(most_before), at_least_zero(less(times(most_before, most_before), least2))),
           both(at_least_zero(most_behind), at_least_zero(less(times(most_behind, most_behind), least2)))));
  crossed.perhaps = bits_of(perhaps);
  if (crossed.perhaps == 0 || line.late >= line.end) return crossed;
  const __m256 least_before = less(before, before_doubt), least_behind = less(behind, behind_doubt);
  const __m256 late_doubt = plus(times(unit, plus(_mm256_set1_ps(std::abs(line.late)), w)), room);
  const __m256 most_late = _mm256_max_ps(
      plus(plus(times(_mm256_set1_ps(line.late), way2), along), late_doubt), _mm256_setzero_ps());
  const __m256 crosses =
      both(both(above_zero(least_before), above_zero(less(times(least_before, least_before), most2))),
           both(above_zero(least_behind), above_zero(less(times(least_behind, least_behind), most2))));
  const __m256 is_late = both(above_zero(least2), above_zero(less(least2, times(most_late, most_late))));
  crossed.late = bits_of(both(perhaps, both(crosses, is_late)));
  return crossed;
}

}  // namespace
}  // namespace avx2

std::uint32_t boxes_on_line(const std::array<EightFloats, 3>& min, const std::array<EightFloats, 3>& max,
                            const LineInBoxes& line) {
  return lanes_in_use != LaneSet::kPlain ? avx2::boxes_on_line(min, max, line)
                                         : plain::boxes_on_line(min, max, line);
}
CrossedLanes ellipsoids_on_line(const std::array<EightFloats, 3>& centre,
                                const std::array<EightFloats, 6>& shape, const LineAtEllipsoids& line) {
  return lanes_in_use != LaneSet::kPlain ? avx2::ellipsoids_on_line(centre, shape, line)
                                         : plain::ellipsoids_on_line(centre, shape, line);
}

}  // namespace ray

#else

namespace ray {

std::uint32_t boxes_on_line(const std::array<EightFloats, 3>& min, const std::array<EightFloats, 3>& max,
                            const LineInBoxes& line) {
  return plain::boxes_on_line(min, max, line);
}
CrossedLanes ellipsoids_on_line(const std::array<EightFloats, 3>& centre,
                                const std::array<EightFloats, 6>& shape, const LineAtEllipsoids& line) {
  return plain::ellipsoids_on_line(centre, shape, line);
}

}  // namespace ray

#endif
