#include "ellipsoid_lanes.h"

#include <Eigen/Core>
#include <cmath>

namespace ray::plain {
namespace {

/// Numbers of eight at once; plain loops over so few are not made parallel by compilers.
using Lanes = Eigen::Array<float, kEightLanes, 1>;
using ConstLanes = Eigen::Map<const Lanes>;

template <class Bits>
std::uint32_t bits_of(const Bits& is_set) {
  std::uint32_t bits = 0;
  for (Eigen::Index i = 0; i < Lanes::SizeAtCompileTime; ++i)
    bits |= std::uint32_t{is_set[i]} << i;
  return bits;
}
/// Not a number is not.
std::uint32_t at_least_zero(const Lanes& lanes) {
  return bits_of(lanes >= 0.0F);
}
std::uint32_t above_zero(const Lanes& lanes) {
  return bits_of(lanes > 0.0F);
}

}  // namespace

std::uint32_t boxes_on_line(const std::array<EightFloats, 3>& min, const std::array<EightFloats, 3>& max,
                            const LineInBoxes& line) {
  Lanes enters = Lanes::Zero(), leaves = Lanes::Constant(line.reach);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const bool up = line.inverse[axis] > 0.0F;
    const ConstLanes near(up ? min[axis].data() : max[axis].data());
    const ConstLanes far(up ? max[axis].data() : min[axis].data());
    enters = enters.max((near - line.from[axis]) * line.inverse[axis]);
    leaves = leaves.min((far - line.from[axis]) * line.inverse[axis]);
  }
  return at_least_zero(leaves - enters);
}

CrossedLanes ellipsoids_on_line(const std::array<EightFloats, 3>& centre,
                                const std::array<EightFloats, 6>& shape, const LineAtEllipsoids& line) {
  const auto [dx, dy, dz] = line.direction;
  const ConstLanes xx(shape[0].data()), xy(shape[1].data()), xz(shape[2].data()), yy(shape[3].data()),
      yz(shape[4].data()), zz(shape[5].data());
  const Lanes wx = line.at[0] - ConstLanes(centre[0].data()), wy = line.at[1] - ConstLanes(centre[1].data()),
              wz = line.at[2] - ConstLanes(centre[2].data());
  const Lanes sx = xx * dx + xy * dy + xz * dz, sy = xy * dx + yy * dy + yz * dz,
              sz = xz * dx + yz * dy + zz * dz;
  const Lanes from2 = wx * (xx * wx + xy * wy + xz * wz) + wy * (xy * wx + yy * wy + yz * wz) +
                      wz * (xz * wx + yz * wy + zz * wz);
  const Lanes way2 = dx * sx + dy * sy + dz * sz;
  const Lanes along = wx * sx + wy * sy + wz * sz;
  const Lanes w2 = wx * wx + wy * wy + wz * wz;
  // In units of way2 from the middle of the chord, whose half squared is half2.
  const Lanes half2 = way2 - from2 * way2 + along * along;
  const Lanes unit = kFormRounding * (xx + yy + zz);
  const Lanes doubt2 = 2.0F * unit * (w2 * way2 + from2) + kChordRoom * way2 + unit;
  const std::uint32_t met = at_least_zero(half2 + doubt2);
  if (met == 0) return {};
  // A line that surely begins or ends inside, or does not reach the middle, does not cross.
  const Lanes w = w2.sqrt();
  const Lanes room = kChordRoom * way2.sqrt();
  const Lanes most2 = half2 + doubt2, least2 = half2 - doubt2;
  const auto doubt_at = [&](float place) { return Lanes(unit * (std::abs(place) + w) + room); };
  const Lanes before = -(line.start * way2 + along), behind = line.end * way2 + along;
  const Lanes before_doubt = doubt_at(line.start), behind_doubt = doubt_at(line.end);
  const Lanes most_before = before + before_doubt, most_behind = behind + behind_doubt;
  CrossedLanes crossed;
  crossed.perhaps = met & at_least_zero(most_before) & at_least_zero(most_before * most_before - least2) &
                    at_least_zero(most_behind) & at_least_zero(most_behind * most_behind - least2);
  if (crossed.perhaps == 0 || line.late >= line.end) return crossed;
  const Lanes least_before = before - before_doubt, least_behind = behind - behind_doubt;
  const Lanes most_late = (line.late * way2 + along + doubt_at(line.late)).max(0.0F);
  crossed.late = crossed.perhaps & above_zero(least2) & above_zero(least_before) &
                 above_zero(least_before * least_before - most2) & above_zero(least_behind) &
                 above_zero(least_behind * least_behind - most2) & above_zero(least2 - most_late * most_late);
  return crossed;
}

}  // namespace ray::plain
