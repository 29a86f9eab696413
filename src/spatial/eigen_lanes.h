#pragma once
/// Eigenvalues and eigenvectors of symmetric 3×3 matrices: of one, or of several at once.

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <cstddef>
#ifdef __SSE2__
#include <immintrin.h>
#endif

namespace ray {

/// The six numbers of a symmetric matrix, of one or of several. `Value` is a double, or a vector of them as
/// compilers have it; each of these goes through the same steps, so that it comes out the same to the last
/// bit.
template <class Value>
struct SymmetricLanes {
  Value xx, xy, xz, yy, yz, zz;
};

template <class Value>
using VectorLanes = std::array<Value, 3>;

template <class Value>
struct EigenLanes {
  VectorLanes<Value> values;                  ///< ascending
  std::array<VectorLanes<Value>, 3> vectors;  ///< in the order of the values
  /// Below 1 where this is none: of a ball, or where fourth powers would be no doubles, or no numbers.
  Value is_good;
};

namespace eigen_lanes {

inline double square_root(double v) {
  return std::sqrt(v);
}
/// Of several, two by two, which takes no longer.
template <class Value>
[[gnu::always_inline]] inline Value square_root(const Value& v) {
  Value root;
#ifdef __SSE2__
  for (std::size_t i = 0; i < sizeof(Value) / sizeof(double); i += 2) {
    const __m128d two = _mm_sqrt_pd(__m128d{v[i], v[i + 1]});
    root[i] = two[0], root[i + 1] = two[1];
  }
#else
  for (std::size_t i = 0; i < sizeof(Value) / sizeof(double); ++i)
    root[i] = std::sqrt(v[i]);
#endif
  return root;
}

template <class Value>
[[gnu::always_inline]] inline Value dot(const VectorLanes<Value>& a, const VectorLanes<Value>& b) {
  return a[0] * b[0] + (a[1] * b[1] + a[2] * b[2]);
}

template <class Value>
[[gnu::always_inline]] inline VectorLanes<Value> times(const SymmetricLanes<Value>& m,
                                                       const VectorLanes<Value>& v) {
  return {m.xx * v[0] + m.xy * v[1] + m.xz * v[2], m.xy * v[0] + m.yy * v[1] + m.yz * v[2],
          m.xz * v[0] + m.yz * v[1] + m.zz * v[2]};
}

template <class Value>
[[gnu::always_inline]] inline SymmetricLanes<Value> less(const SymmetricLanes<Value>& m, Value diagonal) {
  return {m.xx - diagonal, m.xy, m.xz, m.yy - diagonal, m.yz, m.zz - diagonal};
}

template <class Value>
[[gnu::always_inline]] inline Value absolute(Value v) {
  return v < 0.0 ? -v : v;
}

/// 2 cos(acos(c) / 3), for c from 0 to 1: the largest x for which x³ - 3 x = 2 c, which is flat nowhere near.
/// A polynomial is 1e-5 off, a step of Newton takes that to 1e-10. The same on every machine, which no
/// library promises of its cosines.
template <class Value>
[[gnu::always_inline]] inline Value twice_cosine_of_third(Value c) {
  const Value x =
      1.732060864 + c * 0.332823444 + c * c * (-0.091843866 + c * 0.035024377 - c * c * 0.008070797);
  return x - (x * (x * x - 3.0) - 2.0 * c) / (3.0 * (x * x - 1.0));
}

/// The longest of the products of rows, all of which are along the vector that the matrix takes to zero.
template <class Value>
[[gnu::always_inline]] inline VectorLanes<Value> null_vector(const SymmetricLanes<Value>& m) {
  const VectorLanes<Value> a{m.xy * m.yz - m.xz * m.yy, m.xz * m.xy - m.xx * m.yz, m.xx * m.yy - m.xy * m.xy};
  const VectorLanes<Value> b{m.xy * m.zz - m.xz * m.yz, m.xz * m.xz - m.xx * m.zz, m.xx * m.yz - m.xy * m.xz};
  const VectorLanes<Value> c{m.yy * m.zz - m.yz * m.yz, m.yz * m.xz - m.xy * m.zz, m.xy * m.yz - m.yy * m.xz};
  const Value aa = dot(a, a), bb = dot(b, b), cc = dot(c, c);
  const Value of_two = aa >= bb ? aa : bb;
  const Value per_length = 1.0 / square_root(of_two >= cc ? of_two : cc);
  VectorLanes<Value> result;
  for (std::size_t i = 0; i < 3; ++i) {
    const Value of_ab = aa >= bb ? a[i] : b[i];
    result[i] = (of_two >= cc ? of_ab : c[i]) * per_length;
  }
  return result;
}

}  // namespace eigen_lanes

/// In closed form (Smith 1961) where the eigenvalues are well apart. True to 1e-7 of the largest one.
template <class Value>
[[gnu::always_inline]] inline EigenLanes<Value> closed_form_eigen(const SymmetricLanes<Value>& a) {
  using namespace eigen_lanes;
  const Value zero{}, one = zero + 1.0;
  const Value mean = (a.xx + a.yy + a.zz) / 3.0;
  const SymmetricLanes<Value> b = less(a, mean);
  const Value spread2 =
      (b.xx * b.xx + b.yy * b.yy + b.zz * b.zz + 2.0 * (b.xy * b.xy + b.xz * b.xz + b.yz * b.yz)) / 6.0;
  EigenLanes<Value> result;
  result.is_good = spread2 > 1e-12 * mean * mean ? one : zero;
  result.is_good = spread2 > 1e-70 ? result.is_good : zero;
  result.is_good = spread2 < 1e70 ? result.is_good : zero;
  const Value spread = square_root(spread2);
  const Value determinant = b.xx * (b.yy * b.zz - b.yz * b.yz) - b.xy * (b.xy * b.zz - b.yz * b.xz) +
                            b.xz * (b.xy * b.yz - b.yy * b.xz);
  const Value cosine = determinant / (2.0 * spread2 * spread);
  const Value at_most_one = cosine > 1.0 ? one : cosine;
  const Value half_determinant = at_most_one < -1.0 ? -one : at_most_one;
  // The eigenvalue that is further from the middle one than the other: the largest where the determinant is
  // positive.
  const Value furthest = spread * twice_cosine_of_third(absolute(half_determinant));
  const VectorLanes<Value> first = null_vector(less(b, half_determinant >= 0.0 ? furthest : -furthest));
  for (const Value& v : first)
    result.is_good = v - v == 0.0 ? result.is_good : zero;

  // The others are those of the matrix across it, by one rotation. Of these two axes across it, as long as
  // each other, one has a zero, so that what lies along the axes of space stays there.
  const Value x_size = absolute(first[0]);
  const VectorLanes<Value> u{x_size < 0.6 ? zero : first[2], x_size < 0.6 ? -first[2] : zero,
                             x_size < 0.6 ? first[1] : -first[0]};
  const VectorLanes<Value> w{first[1] * u[2] - first[2] * u[1], first[2] * u[0] - first[0] * u[2],
                             first[0] * u[1] - first[1] * u[0]};
  const Value length2 = dot(u, u), per_length2 = 1.0 / length2;
  const VectorLanes<Value> au = times(a, u), aw = times(a, w);
  const Value uu = dot(u, au) * per_length2, uw = dot(u, aw) * per_length2, ww = dot(w, aw) * per_length2;
  const Value half_difference = 0.5 * (uu - ww);
  const Value radius = square_root(half_difference * half_difference + uw * uw);
  // The direction of the larger one, computed without cancellation.
  const Value sum = absolute(half_difference) + radius;
  Value along_u = half_difference >= 0.0 ? sum : uw;
  Value along_w = half_difference >= 0.0 ? uw : sum;
  along_u = radius > 0.0 ? along_u : one;
  along_w = radius > 0.0 ? along_w : zero;
  const Value per_length = 1.0 / square_root((along_u * along_u + along_w * along_w) * length2);
  along_u *= per_length, along_w *= per_length;
  const Value middle = 0.5 * (uu + ww);
  const Value first_value = dot(first, times(a, first));
  const Value smaller = middle - radius, larger = middle + radius;
  result.values = {half_determinant >= 0.0 ? smaller : first_value,
                   half_determinant >= 0.0 ? larger : smaller,
                   half_determinant >= 0.0 ? first_value : larger};
  for (std::size_t i = 0; i < 3; ++i) {
    const Value large = along_u * u[i] + along_w * w[i], small = along_u * w[i] - along_w * u[i];
    result.vectors[0][i] = half_determinant >= 0.0 ? small : first[i];
    result.vectors[1][i] = half_determinant >= 0.0 ? large : small;
    result.vectors[2][i] = half_determinant >= 0.0 ? first[i] : large;
  }
  return result;
}

}  // namespace ray
