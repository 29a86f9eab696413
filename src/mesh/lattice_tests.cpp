#include "lattice_tests.h"

#include <algorithm>
#include <cmath>

namespace ray {
namespace {

__extension__ using Wide = __int128;
using Offset = std::array<std::int64_t, 3>;

Offset between(const LatticePoint& from, const LatticePoint& to) {
  return {std::int64_t{to[0]} - from[0], std::int64_t{to[1]} - from[1], std::int64_t{to[2]} - from[2]};
}

int sign_of(Wide value) {
  return value > 0 ? 1 : value < 0 ? -1 : 0;
}

/// Coordinates are within ±2^30: 2^30 * 2^61 * 3 has 93 bits.
Wide determinant_of(const Offset& a, const Offset& b, const Offset& c) {
  return Wide{a[0]} * (b[1] * c[2] - b[2] * c[1]) + Wide{a[1]} * (b[2] * c[0] - b[0] * c[2]) +
         Wide{a[2]} * (b[0] * c[1] - b[1] * c[0]);
}

std::int64_t squared_length(const Offset& a) {
  return a[0] * a[0] + a[1] * a[1] + a[2] * a[2];
}

struct InDouble {
  double x, y, z;
};

InDouble in_double(const LatticePoint& from, const LatticePoint& to) {
  return {static_cast<double>(to[0] - from[0]), static_cast<double>(to[1] - from[1]),
          static_cast<double>(to[2] - from[2])};
}

double determinant_of(const InDouble& a, const InDouble& b, const InDouble& c) {
  return a.x * (b.y * c.z - b.z * c.y) + a.y * (b.z * c.x - b.x * c.z) + a.z * (b.x * c.y - b.y * c.x);
}

/// Sign of the sum of `minors[i] * squares[i]`, each of which would need 155 bits.
int sign_of_sum(const std::array<Wide, 4>& minors, const std::array<std::int64_t, 4>& squares) {
  constexpr int kLow = 48;
  Wide high = 0, low = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    const Wide above = minors[i] >> kLow;
    high += above * squares[i];
    low += (minors[i] - (above << kLow)) * squares[i];
  }
  high += low >> kLow;  // rounds down, and what is left of `low` is not negative
  const Wide rest = low - ((low >> kLow) << kLow);
  return high != 0 ? sign_of(high) : rest != 0 ? 1 : 0;
}

int exact_side_of_sphere(const std::array<LatticePoint, 4>& corners,
                         const std::array<std::uint32_t, 4>& ranks, const LatticePoint& p,
                         std::uint32_t rank) {
  std::array<Offset, 4> away;
  std::array<std::int64_t, 4> squares{};
  for (std::size_t i = 0; i < 4; ++i) {
    away[i] = between(p, corners[i]);
    squares[i] = squared_length(away[i]);
  }
  const auto& [a, b, c, d] = away;
  const std::array<Wide, 4> minors{determinant_of(b, c, d), -determinant_of(a, c, d), determinant_of(a, b, d),
                                   -determinant_of(a, b, c)};
  if (const int sign = sign_of_sum(minors, squares); sign != 0) return sign;
  // On it: what raising each of them does, the highest first. Raising p itself puts it outside.
  std::array<std::size_t, 4> order{0, 1, 2, 3};
  std::sort(order.begin(), order.end(), [&](std::size_t i, std::size_t j) { return ranks[i] > ranks[j]; });
  for (const std::size_t i : order) {
    if (ranks[i] < rank) break;
    if (minors[i] != 0) return sign_of(minors[i]);
  }
  return -1;
}

}  // namespace

int side_of_plane(const LatticePoint& a, const LatticePoint& b, const LatticePoint& c,
                  const LatticePoint& d) {
  const InDouble u = in_double(a, b), v = in_double(a, c), w = in_double(a, d);
  const double determinant = determinant_of(u, v, w);
  const double x = std::max({std::abs(u.x), std::abs(v.x), std::abs(w.x)});
  const double y = std::max({std::abs(u.y), std::abs(v.y), std::abs(w.y)});
  const double z = std::max({std::abs(u.z), std::abs(v.z), std::abs(w.z)});
  // Six products of three, each of which suffers five roundings of 2^-53 at most.
  const double doubt = 5e-15 * x * y * z;
  if (determinant > doubt) return 1;
  if (determinant < -doubt) return -1;
  return sign_of(determinant_of(between(a, b), between(a, c), between(a, d)));
}

int side_of_sphere(const std::array<LatticePoint, 4>& corners, const std::array<std::uint32_t, 4>& ranks,
                   const LatticePoint& p, std::uint32_t rank) {
  const InDouble a = in_double(p, corners[0]), b = in_double(p, corners[1]), c = in_double(p, corners[2]),
                 d = in_double(p, corners[3]);
  const auto square = [](const InDouble& v) { return v.x * v.x + v.y * v.y + v.z * v.z; };
  const double aa = square(a), bb = square(b), cc = square(c), dd = square(d);
  const double sum = aa * determinant_of(b, c, d) - bb * determinant_of(a, c, d) +
                     cc * determinant_of(a, b, d) - dd * determinant_of(a, b, c);
  const auto largest = [](double s, double t, double u, double v) {
    return std::max(std::max(std::abs(s), std::abs(t)), std::max(std::abs(u), std::abs(v)));
  };
  // 24 products of four, each of which suffers twelve roundings of 2^-53 at most.
  const double doubt = 4e-14 * largest(a.x, b.x, c.x, d.x) * largest(a.y, b.y, c.y, d.y) *
                       largest(a.z, b.z, c.z, d.z) * largest(aa, bb, cc, dd);
  if (sum > doubt) return 1;
  if (sum < -doubt) return -1;
  return exact_side_of_sphere(corners, ranks, p, rank);
}

Sphere sphere_of(const std::array<LatticePoint, 4>& corners) {
  const std::array<Offset, 3> away{between(corners[0], corners[1]), between(corners[0], corners[2]),
                                   between(corners[0], corners[3])};
  const auto volume = static_cast<double>(determinant_of(away[0], away[1], away[2]));
  Sphere sphere{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::size_t y = (axis + 1) % 3, z = (axis + 2) % 3;
    Wide offset = 0;  // of the centre, times twice the volume; 3 * 2^60 * 2^61 * 3 has 125 bits
    for (std::size_t i = 0; i < 3; ++i) {
      const Offset& b = away[(i + 1) % 3];
      const Offset& c = away[(i + 2) % 3];
      offset += Wide{squared_length(away[i])} * (b[y] * c[z] - b[z] * c[y]);
    }
    sphere.centre[axis] = 0.5 * (static_cast<double>(offset) / volume);
    sphere.squared_radius += sphere.centre[axis] * sphere.centre[axis];
  }
  return sphere;
}

std::array<double, 3> normal_of(const LatticePoint& a, const LatticePoint& b, const LatticePoint& c) {
  const Offset u = between(a, b), v = between(a, c);
  return {static_cast<double>(u[1] * v[2] - u[2] * v[1]), static_cast<double>(u[2] * v[0] - u[0] * v[2]),
          static_cast<double>(u[0] * v[1] - u[1] * v[0])};
}

}  // namespace ray
