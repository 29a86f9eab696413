#pragma once
/// Normally distributed numbers, the same bits on every machine.

#include "turn.h"

#include <raycloud/exec/random.h>

#include <cmath>
#include <limits>

namespace ray {

/// The natural logarithm from + - * / alone. Precondition: x > 0, a normal number. Relative error below
/// 1e-15.
[[nodiscard]] inline double natural_log(double x) {
  int exponent = 0;
  double mantissa = std::frexp(x, &exponent);  // exact
  if (mantissa < 0.7071067811865476) {
    mantissa *= 2.0;
    --exponent;
  }
  const double s = (mantissa - 1.0) / (mantissa + 1.0);  // log m = 2 artanh s, |s| < 0.172
  const double s2 = s * s;
  double sum = 0.0;
  for (const double term :
       {1.0 / 21, 1.0 / 19, 1.0 / 17, 1.0 / 15, 1.0 / 13, 1.0 / 11, 1.0 / 9, 1.0 / 7, 1.0 / 5, 1.0 / 3, 1.0})
    sum = sum * s2 + term;
  return 2.0 * s * sum + exponent * 0.6931471805599453;
}

/// Mean 0, variance 1 (Box and Muller, 1958).
[[nodiscard]] inline double gaussian(const RandomStream& random, std::uint64_t index) {
  const double positive = 1.0 - random.uniform(index, 0);
  return std::sqrt(-2.0 * natural_log(positive)) * turned(random.uniform(index, 1)).x();
}

}  // namespace ray
