#include "exact_moments.h"

#include <array>
#include <cmath>
#include <cstddef>

namespace ray {
namespace {

/// Four at once where the processor can, else two and two: the sums are exact in any order.
using FourDoubles [[gnu::vector_size(32)]] = double;

struct Offsets {
  const PointTree& tree;
  const Eigen::Vector3d& middle;
  std::span<const Neighbour> neighbours;
  double scale;
};
/// Sums of x, y, z, xx, yy, zz, xy, xz, yz.
using MomentSums = std::array<double, 9>;

[[gnu::always_inline]] inline void add_moments(const Offsets& offsets, MomentSums& total) {
  constexpr double kRounds = 0x1.8p52;
  const std::size_t size = offsets.neighbours.size();
  const Eigen::Vector3d middle = offsets.middle;
  std::array<FourDoubles, 9> sums{};
  for (std::size_t i = 0; i < size; i += 4) {
    FourDoubles x{}, y{}, z{};
    if (i + 4 <= size) {
      const auto place = [&](std::size_t k) { return offsets.neighbours[i + k].place; };
      const Eigen::Vector3d a = offsets.tree.point(place(0)), b = offsets.tree.point(place(1)),
                            c = offsets.tree.point(place(2)), d = offsets.tree.point(place(3));
      x = FourDoubles{a.x(), b.x(), c.x(), d.x()} - middle.x();
      y = FourDoubles{a.y(), b.y(), c.y(), d.y()} - middle.y();
      z = FourDoubles{a.z(), b.z(), c.z(), d.z()} - middle.z();
    } else {  // those that are not there are in the middle, and add nothing
      for (std::size_t k = 0; i + k < size; ++k) {
        const Eigen::Vector3d offset = offsets.tree.point(offsets.neighbours[i + k].place) - middle;
        x[k] = offset.x(), y[k] = offset.y(), z[k] = offset.z();
      }
    }
    x = x * offsets.scale + kRounds - kRounds;
    y = y * offsets.scale + kRounds - kRounds;
    z = z * offsets.scale + kRounds - kRounds;
    sums[0] += x, sums[1] += y, sums[2] += z;
    sums[3] += x * x, sums[4] += y * y, sums[5] += z * z;
    sums[6] += x * y, sums[7] += x * z, sums[8] += y * z;
  }
  for (std::size_t i = 0; i < sums.size(); ++i)
    total[i] = sums[i][0] + sums[i][1] + sums[i][2] + sums[i][3];
}

void add_moments_plain(const Offsets& offsets, MomentSums& total) {
  add_moments(offsets, total);
}
#ifdef __x86_64__
[[gnu::target("avx2")]] void add_moments_avx2(const Offsets& offsets, MomentSums& total) {
  add_moments(offsets, total);
}
const auto add_moments_fast = __builtin_cpu_supports("avx2") ? add_moments_avx2 : add_moments_plain;
#else
constexpr auto add_moments_fast = add_moments_plain;
#endif

}  // namespace

ExactMoments::ExactMoments(const PointTree& tree, const Eigen::Vector3d& middle,
                           std::span<const Neighbour> neighbours, double furthest2) {
  int exponent = 0;
  static_cast<void>(std::frexp(std::sqrt(furthest2), &exponent));
  scale_ = std::ldexp(1.0, 22 - exponent);
  MomentSums sums;
  add_moments_fast({tree, middle, neighbours, scale_}, sums);
  sum_ = {sums[0], sums[1], sums[2]};
  squares_ = {sums[3], sums[4], sums[5]};
  products_ = {sums[6], sums[7], sums[8]};
}

}  // namespace ray
