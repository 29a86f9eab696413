/// The searches of EllipsoidTree: which ellipsoids a line or a point may meet.

#include "ellipsoid_lanes.h"

#include <raycloud/volume/ellipsoid_tree.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#ifdef __SSE2__
#include <emmintrin.h>
#endif

namespace ray {
namespace {

/// Numbers of eight at once; plain loops over so few are not made parallel by compilers.
using Lanes = Eigen::Array<float, 8, 1>;
using ConstLanes = Eigen::Map<const Lanes>;

/// A bit for each that is 0 or more. Not a number is not.
std::uint32_t at_least_zero(const Lanes& lanes) {
#ifdef __SSE2__
  const auto mask = [](const float* four) {
    return static_cast<std::uint32_t>(_mm_movemask_ps(_mm_cmpge_ps(_mm_loadu_ps(four), _mm_setzero_ps())));
  };
  return mask(lanes.data()) | mask(lanes.data() + 4) << 4;
#else
  std::uint32_t bits = 0;
  for (Eigen::Index i = 0; i < lanes.size(); ++i)
    bits |= std::uint32_t{lanes[i] >= 0.0F} << i;
  return bits;
#endif
}

/// `work(i)` for each bit i that is set.
template <class Work>
void each_bit(std::uint32_t bits, const Work& work) {
  for (; bits != 0; bits &= bits - 1)
    work(static_cast<std::size_t>(std::countr_zero(bits)));
}

template <class Data>
void fetch(const Data& data) {
  constexpr std::size_t kLine = 64;
  for (std::size_t at = 0; at < sizeof(Data); at += kLine)
    __builtin_prefetch(reinterpret_cast<const std::byte*>(&data) + at);
}

/// Parts of boxes still to be looked at: seven beside the way at each of at most eleven levels, and eight.
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
  std::array<Part, 96> parts_;
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
  double length, late;        // m
};

void EllipsoidTree::near_line(const Eigen::Vector3d& start, const Eigen::Vector3d& end,
                              std::vector<std::uint32_t>& slots) const {
  std::vector<std::uint32_t> none;
  near_line(start, end, 0.0, slots, none);
}

void EllipsoidTree::near_line(const Eigen::Vector3d& start, const Eigen::Vector3d& end, double beyond,
                              std::vector<std::uint32_t>& slots, std::vector<std::uint32_t>& late) const {
  slots.clear();
  late.clear();
  if (levels_.empty()) return;
  const Eigen::Vector3d way = end - start;
  const auto [first, last] = clipped(start, way, min_, max_);
  const double length = way.norm();
  if (!(first <= last) || !(length > 0.0)) return;
  const Line line{start, way / length, length, length - beyond};
  LineInBoxes in_boxes;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<Eigen::Index>(axis);
    constexpr double kLeast = 1e-12;
    const double d = line.direction[a];
    in_boxes.from[axis] = static_cast<float>(start[a] + first * way[a] - origin_[a]);
    in_boxes.inverse[axis] = static_cast<float>(1.0 / (std::abs(d) < kLeast ? std::copysign(kLeast, d) : d));
  }
  in_boxes.reach = static_cast<float>((last - first) * length * (1.0 + 1e-6) + slack_);

  // Packs are met a little later, when they have come from memory.
  std::array<std::uint32_t, 32> met;
  std::size_t waiting = 0;
  const auto meet_all = [&] {
    for (std::size_t i = 0; i < waiting; ++i)
      meet_pack(met[i], line, slots, late);
    waiting = 0;
  };
  OpenParts open;
  open.push(levels_.size() - 1, 0);
  while (!open.empty()) {
    const auto [level, number] = open.pop();
    const Boxes& boxes = levels_[level][number];
    each_bit(boxes_on_line(boxes.min, boxes.max, in_boxes),
             [&, level = level, number = number](std::size_t i) {
               const std::size_t part = kParts * number + i;
               if (level > 0) {
                 open.push(level - 1, part);
                 fetch(levels_[level - 1][part]);
               } else {
                 if (waiting == met.size()) meet_all();
                 met[waiting++] = static_cast<std::uint32_t>(part);
                 fetch(packs_[part]);
               }
             });
  }
  meet_all();
}

void EllipsoidTree::meet_pack(std::size_t p, const Line& line, std::vector<std::uint32_t>& slots,
                              std::vector<std::uint32_t>& late) const {
  const Pack& pack = packs_[p];
  // From the point of the line nearest to the anchor, so that single precision will do.
  const Eigen::Vector3d to_anchor = pack.anchor - line.start;
  const double middle = line.direction.dot(to_anchor);
  const Eigen::Vector3f nearest = (middle * line.direction - to_anchor).cast<float>();
  const Eigen::Vector3f direction = line.direction.cast<float>();
  const CrossedLanes crossed = ellipsoids_on_line(pack.centre, pack.shape,
                                                  {{nearest.x(), nearest.y(), nearest.z()},
                                                   {direction.x(), direction.y(), direction.z()},
                                                   static_cast<float>(-middle),
                                                   static_cast<float>(line.late - middle),
                                                   static_cast<float>(line.length - middle)});
  const auto slot_of = [&](std::size_t i) { return static_cast<std::uint32_t>(kPack * p + i); };
  each_bit(crossed.late, [&](std::size_t i) { late.push_back(slot_of(i)); });
  const std::uint32_t rest = crossed.perhaps & ~crossed.late;
  if (rest == 0) return;
  fetch(normals_[kPack * p]);
  each_bit(rest, [&](std::size_t i) { slots.push_back(slot_of(i)); });
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
    Lanes depth = Lanes::Constant(std::numeric_limits<float>::infinity());  // below 0: outside
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const float place = at[static_cast<Eigen::Index>(axis)];
      depth = depth.min(place - ConstLanes(boxes.min[axis].data()))
                  .min(ConstLanes(boxes.max[axis].data()) - place);
    }
    each_bit(at_least_zero(depth), [&, level = level, number = number](std::size_t i) {
      if (level > 0)
        open.push(level - 1, kParts * number + i);
      else
        hold_pack(kParts * number + i, point, slots);
    });
  }
}

void EllipsoidTree::hold_pack(std::size_t p, const Eigen::Vector3d& point,
                              std::vector<std::uint32_t>& slots) const {
  const Pack& pack = packs_[p];
  const Eigen::Vector3f from = (point - pack.anchor).cast<float>();
  const ConstLanes xx(pack.shape[0].data()), xy(pack.shape[1].data()), xz(pack.shape[2].data()),
      yy(pack.shape[3].data()), yz(pack.shape[4].data()), zz(pack.shape[5].data());
  const Lanes wx = from.x() - ConstLanes(pack.centre[0].data()),
              wy = from.y() - ConstLanes(pack.centre[1].data()),
              wz = from.z() - ConstLanes(pack.centre[2].data());
  const Lanes value = wx * (xx * wx + xy * wy + xz * wz) + wy * (xy * wx + yy * wy + yz * wz) +
                      wz * (xz * wx + yz * wy + zz * wz);
  const Lanes doubt = kFormRounding * (1.0F + (xx + yy + zz) * (wx * wx + wy * wy + wz * wz));
  each_bit(at_least_zero(1.0F + doubt - value), [&](std::size_t i) {
    const auto slot = static_cast<std::uint32_t>(kPack * p + i);
    const auto lane = static_cast<Eigen::Index>(i);
    if (value[lane] < 1.0F - doubt[lane] || is_inside(at_slot(slot), point)) slots.push_back(slot);
  });
}

}  // namespace ray
