/// The searches of EllipsoidTree: which ellipsoids a line or a point may meet.

#include <raycloud/volume/ellipsoid_tree.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace ray {
namespace {

/// A form in single precision is wrong by so much of the largest product in it, which is at most the trace of
/// the shape times the squared lengths.
constexpr float kRounding = 1e-6F;
constexpr float kMargin = 1.01F;

/// Parts of boxes still to be looked at. Four times as many levels as a tree of 2^32 has.
class OpenParts {
 public:
  struct Part {
    std::uint32_t level;
    std::uint32_t number;
  };
  void push(std::size_t level, std::size_t number) {
    parts_[count_++] = {static_cast<std::uint32_t>(level), static_cast<std::uint32_t>(number)};
  }
  [[nodiscard]] bool empty() const { return count_ == 0; }
  Part pop() { return parts_[--count_]; }

 private:
  std::array<Part, 64> parts_;
  std::size_t count_ = 0;
};

/// The part of a line within a box, as fractions; empty where second < first.
std::pair<double, double> clipped(const Eigen::Vector3d& start, const Eigen::Vector3d& way,
                                  const Eigen::Vector3d& min, const Eigen::Vector3d& max) {
  double first = 0.0, last = 1.0;
  for (int axis = 0; axis < 3; ++axis) {
    if (way[axis] == 0.0) {
      if (start[axis] < min[axis] || start[axis] > max[axis]) return {1.0, 0.0};
      continue;
    }
    const double a = (min[axis] - start[axis]) / way[axis];
    const double b = (max[axis] - start[axis]) / way[axis];
    first = std::max(first, std::min(a, b));
    last = std::min(last, std::max(a, b));
  }
  return {first, last};
}

}  // namespace

struct EllipsoidTree::Line {
  Eigen::Vector3d start;
  Eigen::Vector3d direction;  // unit
  double length;
  std::array<float, 3> d;
};

void EllipsoidTree::near_line(const Eigen::Vector3d& start, const Eigen::Vector3d& end,
                              std::vector<std::uint32_t>& slots) const {
  slots.clear();
  if (levels_.empty()) return;
  const Eigen::Vector3d way = end - start;
  const auto [first, last] = clipped(start, way, min_, max_);
  const double length = way.norm();
  if (!(first <= last) || !(length > 0.0)) return;
  Line line{start, way / length, length, {}};
  std::array<float, 3> from, inverse;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<Eigen::Index>(axis);
    constexpr double kLeast = 1e-12;
    const double d = line.direction[a];
    line.d[axis] = static_cast<float>(d);
    from[axis] = static_cast<float>(start[a] + first * way[a] - origin_[a]);
    inverse[axis] = static_cast<float>(1.0 / (std::abs(d) < kLeast ? std::copysign(kLeast, d) : d));
  }
  const auto reach = static_cast<float>((last - first) * length * (1.0 + 1e-6) + slack_);

  OpenParts open;
  open.push(levels_.size() - 1, 0);
  while (!open.empty()) {
    const auto [level, number] = open.pop();
    const Boxes& boxes = levels_[level][number];
    std::array<float, kParts> enters, leaves;
    enters.fill(0.0F);
    leaves.fill(reach);
    for (std::size_t axis = 0; axis < 3; ++axis)
      for (std::size_t i = 0; i < kParts; ++i) {
        const float a = (boxes.min[axis][i] - from[axis]) * inverse[axis];
        const float b = (boxes.max[axis][i] - from[axis]) * inverse[axis];
        const float near = a < b ? a : b, far = a < b ? b : a;
        enters[i] = enters[i] > near ? enters[i] : near;
        leaves[i] = leaves[i] < far ? leaves[i] : far;
      }
    for (std::size_t i = 0; i < kParts; ++i) {
      if (!(enters[i] <= leaves[i])) continue;
      if (level > 0)
        open.push(level - 1, kParts * number + i);
      else
        meet_pack(kParts * number + i, line, slots);
    }
  }
}

void EllipsoidTree::meet_pack(std::size_t p, const Line& line, std::vector<std::uint32_t>& slots) const {
  const Pack& pack = packs_[p];
  // From the point of the line nearest to the anchor, so that single precision will do.
  const Eigen::Vector3d to_anchor = pack.anchor - line.start;
  const double middle = line.direction.dot(to_anchor);
  const Eigen::Vector3d nearest = middle * line.direction - to_anchor;
  const auto px = static_cast<float>(nearest.x()), py = static_cast<float>(nearest.y()),
             pz = static_cast<float>(nearest.z());
  const auto start = static_cast<float>(-middle), end = static_cast<float>(line.length - middle);
  const auto [dx, dy, dz] = line.d;
  std::array<float, kPack> way2, along, half2, rounding, meets;
  for (std::size_t i = 0; i < kPack; ++i) {
    const float xx = pack.shape[0][i], xy = pack.shape[1][i], xz = pack.shape[2][i], yy = pack.shape[3][i],
                yz = pack.shape[4][i], zz = pack.shape[5][i];
    const float wx = px - pack.centre[0][i], wy = py - pack.centre[1][i], wz = pz - pack.centre[2][i];
    const float sx = xx * dx + xy * dy + xz * dz, sy = xy * dx + yy * dy + yz * dz,
                sz = xz * dx + yz * dy + zz * dz;
    const float from2 = wx * (xx * wx + xy * wy + xz * wz) + wy * (xy * wx + yy * wy + yz * wz) +
                        wz * (xz * wx + yz * wy + zz * wz);
    const float w2 = wx * wx + wy * wy + wz * wz;
    way2[i] = dx * sx + dy * sy + dz * sz;
    along[i] = wx * sx + wy * sy + wz * sz;
    rounding[i] = 2.0F * kRounding * (xx + yy + zz) * (w2 * way2[i] + from2);
    half2[i] = way2[i] - from2 * way2[i] + along[i] * along[i];
    meets[i] = half2[i] + rounding[i] + (kMargin - 1.0F) * way2[i];
  }
  for (std::size_t i = 0; i < kPack; ++i) {
    if (!(meets[i] >= 0.0F)) continue;
    // In units of way2 from the middle of the chord, whose half squared is half2. A line that surely begins
    // or ends inside, or does not reach the middle, does not cross.
    const Eigen::Vector3f w(px - pack.centre[0][i], py - pack.centre[1][i], pz - pack.centre[2][i]);
    const float unit = kRounding * (pack.shape[0][i] + pack.shape[3][i] + pack.shape[5][i]);
    const float inside = half2[i] - rounding[i] - unit;
    const auto crosses = [&](float place, float side) {
      const float at = side * (place * way2[i] + along[i]);
      const float doubt = unit * (std::abs(place) + w.norm());
      return at >= -doubt && (at + doubt) * (at + doubt) >= inside;
    };
    if (!crosses(start, -1.0F) || !crosses(end, 1.0F)) continue;
    slots.push_back(static_cast<std::uint32_t>(kPack * p + i));
  }
}

void EllipsoidTree::holding(const Eigen::Vector3d& point, std::vector<std::uint32_t>& slots) const {
  slots.clear();
  if (levels_.empty()) return;
  if ((point.array() < min_.array()).any() || (point.array() > max_.array()).any()) return;
  const Eigen::Vector3f at = (point - origin_).cast<float>();
  OpenParts open;
  open.push(levels_.size() - 1, 0);
  while (!open.empty()) {
    const auto [level, number] = open.pop();
    const Boxes& boxes = levels_[level][number];
    std::array<float, kParts> out;  // above 0: outside
    for (std::size_t i = 0; i < kParts; ++i) {
      const float x0 = boxes.min[0][i] - at.x(), x1 = at.x() - boxes.max[0][i];
      const float y0 = boxes.min[1][i] - at.y(), y1 = at.y() - boxes.max[1][i];
      const float z0 = boxes.min[2][i] - at.z(), z1 = at.z() - boxes.max[2][i];
      const float x = x0 > x1 ? x0 : x1, y = y0 > y1 ? y0 : y1, z = z0 > z1 ? z0 : z1;
      const float xy = x > y ? x : y;
      out[i] = xy > z ? xy : z;
    }
    for (std::size_t i = 0; i < kParts; ++i) {
      if (out[i] > 0.0F) continue;
      if (level > 0)
        open.push(level - 1, kParts * number + i);
      else
        hold_pack(kParts * number + i, point, slots);
    }
  }
}

void EllipsoidTree::hold_pack(std::size_t p, const Eigen::Vector3d& point,
                              std::vector<std::uint32_t>& slots) const {
  const Pack& pack = packs_[p];
  const Eigen::Vector3f from = (point - pack.anchor).cast<float>();
  std::array<float, kPack> value, doubt;
  for (std::size_t i = 0; i < kPack; ++i) {
    const float wx = from.x() - pack.centre[0][i], wy = from.y() - pack.centre[1][i],
                wz = from.z() - pack.centre[2][i];
    const float xx = pack.shape[0][i], yy = pack.shape[3][i], zz = pack.shape[5][i];
    value[i] = wx * wx * xx + wy * wy * yy + wz * wz * zz +
               2.0F * (wx * wy * pack.shape[1][i] + wx * wz * pack.shape[2][i] + wy * wz * pack.shape[4][i]);
    doubt[i] = kRounding * (1.0F + (xx + yy + zz) * (wx * wx + wy * wy + wz * wz));
  }
  for (std::size_t i = 0; i < kPack; ++i) {
    if (value[i] > 1.0F + doubt[i]) continue;
    const auto slot = static_cast<std::uint32_t>(kPack * p + i);
    if (value[i] < 1.0F - doubt[i] || is_inside(at_slot(slot), point)) slots.push_back(slot);
  }
}

}  // namespace ray
