#include "spatial_order.h"

#include <raycloud/core/bounds.h>
#include <raycloud/core/error.h>
#include <raycloud/exec/fresh_memory.h>
#include <raycloud/exec/parallel.h>
#include <raycloud/volume/ellipsoid_tree.h>

#include <Eigen/LU>
#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>

namespace ray {
namespace {

/// The box of an ellipsoid is as wide as its inverse shape says.
Bounds bounds_of(const Ellipsoid& ellipsoid) {
  const Eigen::Vector3d reach = ellipsoid.shape.inverse().diagonal().cwiseMax(0.0).cwiseSqrt();
  Bounds bounds;
  bounds.add(ellipsoid.centre - reach);
  bounds.add(ellipsoid.centre + reach);
  return bounds;
}

constexpr float kFar = 1e15F;  // where there is nothing

}  // namespace

EllipsoidTree::EllipsoidTree(const Context& context, std::size_t count,
                             const std::function<Eigen::Vector3d(std::size_t)>& place)
    : slots_(count) {
  lay_out(context, place, [](std::size_t i) { return i; });
}

EllipsoidTree::EllipsoidTree(const Context& context, const PointTree& points) : slots_(points.size()) {
  lay_out(
      context, [&](std::size_t place) { return points.point(place); },
      [&](std::size_t place) { return points.index(place); });
}

/// `number(i)` is that of the ellipsoid at `place(i)`.
template <class Place, class Number>
void EllipsoidTree::lay_out(const Context& context, const Place& place, const Number& number) {
  const std::size_t count = size();
  if (count > 0xfffffff0U) throw Error(ErrorCode::out_of_range, "more than 4 294 967 280 points");
  if (count == 0) return;
  origin_ = place(0).array().round();
  const std::vector<std::uint32_t> order = spatial_order(context, count, [&](std::size_t i) {
    const Eigen::Vector3d from_origin = place(i) - origin_;
    return Eigen::Vector3f(from_origin.cast<float>());
  });
  packs_ = touched_vector<Pack>(context, (count + kPack - 1) / kPack);
  normals_ = touched_vector<std::array<std::int16_t, 3>>(context, count);
  parallel_for(context, packs_.size(), 1 << 13, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) {
      Pack& pack = packs_[p];
      pack.anchor = (place(order[kPack * p]) * 65536.0).array().round() / 65536.0;
      for (auto& coordinate : pack.centre)
        coordinate.fill(kFar);
      pack.shape = {};
      for (const std::size_t diagonal : {0, 3, 5})
        pack.shape[diagonal].fill(1.0F);
      for (std::size_t i = kPack * p; i < std::min(count, kPack * (p + 1)); ++i)
        slots_[number(order[i])] = static_cast<std::uint32_t>(i);
    }
  });
}

void EllipsoidTree::set(std::size_t i, const Ellipsoid& ellipsoid) {
  const std::uint32_t slot = slots_[i];
  Pack& pack = packs_[slot / kPack];
  const std::size_t lane = slot % kPack;
  const Eigen::Vector3f offset = (ellipsoid.centre - pack.anchor).cast<float>();
  for (std::size_t axis = 0; axis < 3; ++axis)
    pack.centre[axis][lane] = offset[static_cast<Eigen::Index>(axis)];
  std::size_t entry = 0;
  for (int row = 0; row < 3; ++row)
    for (int column = row; column < 3; ++column)
      pack.shape[entry++][lane] = static_cast<float>(ellipsoid.shape(row, column));
  for (std::size_t axis = 0; axis < 3; ++axis)
    normals_[slot][axis] =
        static_cast<std::int16_t>(std::lround(32767.0 * ellipsoid.normal[static_cast<Eigen::Index>(axis)]));
}

Ellipsoid EllipsoidTree::at_slot(std::uint32_t slot) const {
  const Pack& pack = packs_[slot / kPack];
  const std::size_t lane = slot % kPack;
  const auto offset = [&](std::size_t axis) { return static_cast<double>(pack.centre[axis][lane]); };
  const auto entry = [&](std::size_t e) { return static_cast<double>(pack.shape[e][lane]); };
  Ellipsoid ellipsoid;
  ellipsoid.centre = pack.anchor + Eigen::Vector3d(offset(0), offset(1), offset(2));
  ellipsoid.shape << entry(0), entry(1), entry(2), entry(1), entry(3), entry(4), entry(2), entry(4), entry(5);
  const auto& normal = normals_[slot];
  ellipsoid.normal = Eigen::Vector3d(normal[0], normal[1], normal[2]) / 32767.0;
  return ellipsoid;
}

void EllipsoidTree::close(const Context& context) {
  if (packs_.empty()) return;
  std::vector<Bounds> bounds(packs_.size());
  parallel_for(context, packs_.size(), 1 << 13, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p)
      for (std::size_t i = kPack * p; i < std::min(size(), kPack * (p + 1)); ++i)
        bounds[p].add(bounds_of(at_slot(static_cast<std::uint32_t>(i))));
  });
  Bounds all;
  for (const Bounds& pack : bounds)
    all.add(pack);
  // Single precision is good for 2^-24 of the largest coordinate; a line is judged by a few operations.
  constexpr double kRounded = 2e-6;
  const double largest =
      std::max((all.max - origin_).cwiseAbs().maxCoeff(), (all.min - origin_).cwiseAbs().maxCoeff());
  slack_ = kRounded * largest + 1e-6;
  min_ = all.min.array() - slack_;
  max_ = all.max.array() + slack_;
  levels_.clear();
  while (levels_.empty() || bounds.size() > 1) {
    std::vector<Boxes>& level = levels_.emplace_back((bounds.size() + kParts - 1) / kParts);
    std::vector<Bounds> above(level.size());
    for (std::size_t part = 0; part < kParts * level.size(); ++part) {
      Boxes& boxes = level[part / kParts];
      const bool there = part < bounds.size();
      if (there) above[part / kParts].add(bounds[part]);
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto a = static_cast<Eigen::Index>(axis);
        boxes.min[axis][part % kParts] =
            there ? static_cast<float>(bounds[part].min[a] - slack_ - origin_[a]) : kFar;
        boxes.max[axis][part % kParts] =
            there ? static_cast<float>(bounds[part].max[a] + slack_ - origin_[a]) : kFar;
      }
    }
    bounds = std::move(above);
  }
}

}  // namespace ray
