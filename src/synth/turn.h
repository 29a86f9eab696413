#pragma once
/// Sine and cosine from additions and multiplications alone, so that a scene has the same bits on every
/// machine.

#include <Eigen/Core>
#include <cmath>

namespace ray {

/// (cosine, sine) of `turns` whole turns. Absolute error below 1e-9; the quarter turns are exact.
[[nodiscard]] inline Eigen::Vector2d turned(double turns) {
  turns -= std::floor(turns);
  const double eighth = std::floor(turns * 8.0);
  const int quarter = static_cast<int>((eighth + 1.0) * 0.5);  // the nearest
  const double x = (turns - 0.25 * quarter) * 6.283185307179586;
  const double x2 = x * x;  // at most (π/4)²; Taylor series
  // Products with constants, since a division takes as long as five of them.
  const double sine =
      x * (1 - x2 * (1.0 / 6) *
                   (1 - x2 * (1.0 / 20) *
                            (1 - x2 * (1.0 / 42) * (1 - x2 * (1.0 / 72) * (1 - x2 * (1.0 / 110))))));
  const double cosine =
      1 - x2 * 0.5 *
              (1 - x2 * (1.0 / 12) *
                       (1 - x2 * (1.0 / 30) *
                                (1 - x2 * (1.0 / 56) * (1 - x2 * (1.0 / 90) * (1 - x2 * (1.0 / 132))))));
  switch (quarter % 4) {
    case 0:
      return {cosine, sine};
    case 1:
      return {-sine, cosine};
    case 2:
      return {-cosine, -sine};
    default:
      return {sine, -cosine};
  }
}

}  // namespace ray
