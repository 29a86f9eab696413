#include "cell_grid.h"
#include "whole_rays.h"

#include <raycloud/core/bounds.h>
#include <raycloud/core/error.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace ray {
namespace {

/// Balls along a line, from radius to radius: a tapering cylinder with round ends.
struct Limb {
  Eigen::Vector3d from;
  Eigen::Vector3d to;
  double from_radius = 0.0;
  double to_radius = 0.0;

  /// min over t in [0, 1] of |x - c(t)| - r(t): convex in t, so its only minimum is where the derivative is 0
  /// or at an end.
  [[nodiscard]] double distance(const Eigen::Vector3d& x) const {
    const Eigen::Vector3d axis = to - from;
    const double length = axis.norm();
    const double taper = to_radius - from_radius;
    const double from_distance = (x - from).norm() - from_radius;
    const double to_distance = (x - to).norm() - to_radius;
    if (length <= std::abs(taper)) return std::min(from_distance, to_distance);  // one ball holds the other
    const double along = (x - from).dot(axis) / length;
    const double across = (x - from - along / length * axis).norm();
    const double slope = taper / length;
    const double t = (along + across * slope / std::sqrt(1.0 - slope * slope)) / length;
    if (!(t > 0.0)) return from_distance;
    if (!(t < 1.0)) return to_distance;
    return (x - from - t * axis).norm() - (from_radius + t * taper);
  }

  /// All that is nearer than `distance`.
  [[nodiscard]] Bounds reach(double distance) const {
    const auto around = [&](const Eigen::Vector3d& centre, double radius) {
      const Eigen::Vector3d half = Eigen::Vector3d::Constant(std::max(radius + distance, 0.0));
      return Bounds{centre - half, centre + half};
    };
    Bounds bounds = around(from, from_radius);
    bounds.add(around(to, to_radius));
    return bounds;
  }
};

std::vector<Limb> limbs_of(const Forest& forest) {
  std::vector<Limb> limbs;
  for (const Tree& tree : forest.trees) {
    for (const TreeSegment& segment : tree.segments) {
      const bool foot = segment.parent == TreeSegment::kNoParent;
      if (foot && tree.segments.size() > 1) continue;  // the lower end of the next
      const TreeSegment& parent = foot ? segment : tree.segments[segment.parent];
      limbs.push_back({parent.position, segment.position, parent.radius, segment.radius});
    }
  }
  return limbs;
}

/// The limbs that reach into each cube of a grid.
class LimbGrid {
 public:
  LimbGrid(std::vector<Limb> limbs, double distance)
      : limbs_(std::move(limbs)), distance_(distance), grid_(grid_for()), table_({}) {
    std::vector<std::pair<std::uint64_t, std::uint32_t>> entries;
    for (std::size_t i = 0; i < limbs_.size(); ++i)
      add_cells(i, entries);
    std::sort(entries.begin(), entries.end());
    std::vector<std::uint64_t> keys;
    for (const auto& [key, limb] : entries) {
      if (keys.empty() || keys.back() != key) {
        keys.push_back(key);
        begins_.push_back(near_.size());
      }
      near_.push_back(limb);
    }
    begins_.push_back(near_.size());
    table_ = CellTable(keys);
  }

  [[nodiscard]] bool any_within(const Eigen::Vector3d& point) const {
    const auto key = grid_.key(point);
    const auto cell = key ? table_.find(*key) : std::optional<std::size_t>{};
    if (!cell) return false;
    const auto at = [&](std::size_t i) { return near_.begin() + static_cast<std::ptrdiff_t>(begins_[i]); };
    return std::any_of(at(*cell), at(*cell + 1),
                       [&](std::uint32_t i) { return limbs_[i].distance(point) <= distance_; });
  }

 private:
  /// Cubes about as wide as what a limb reaches.
  [[nodiscard]] CellGrid grid_for() const {
    Bounds all;
    double sum = 0.0;
    for (const Limb& limb : limbs_) {
      const Bounds reach = limb.reach(distance_);
      all.add(reach);
      sum += reach.extent().maxCoeff();
    }
    if (all.empty()) return {Eigen::Vector3d::Zero(), 1.0};
    const double usual = sum / static_cast<double>(limbs_.size());
    const double least = all.extent().maxCoeff() / static_cast<double>(CellGrid::kMost / 2);
    double width = std::max({usual, least, 1e-3});
    while (entries_for(width) > 64.0 * static_cast<double>(limbs_.size()) + 1e6)
      width *= 2.0;  // some limbs are much larger than the usual one
    return {all.min - Eigen::Vector3d::Constant(width), width};
  }

  [[nodiscard]] double entries_for(double width) const {
    double sum = 0.0;
    for (const Limb& limb : limbs_)
      sum += ((limb.reach(distance_).extent() / width).array() + 2.0).prod();
    return sum;
  }

  void add_cells(std::size_t i, std::vector<std::pair<std::uint64_t, std::uint32_t>>& entries) const {
    const Bounds reach = limbs_[i].reach(distance_);
    const auto cell = [&](const Eigen::Vector3d& point) {
      return Eigen::Vector3d(((point - grid_.origin()) / grid_.width()).array().floor())
          .cast<std::uint64_t>()
          .eval();
    };
    const auto low = cell(reach.min), high = cell(reach.max);
    for (std::uint64_t x = low.x(); x <= high.x(); ++x) {
      for (std::uint64_t y = low.y(); y <= high.y(); ++y) {
        for (std::uint64_t z = low.z(); z <= high.z(); ++z)
          entries.emplace_back(CellGrid::key(x, y, z), static_cast<std::uint32_t>(i));
      }
    }
  }

  std::vector<Limb> limbs_;
  double distance_;
  CellGrid grid_;
  CellTable table_;
  std::vector<std::size_t> begins_;  ///< in near_, by cell
  std::vector<std::uint32_t> near_;  ///< limbs
};

}  // namespace

SplitRulePtr split_by_trees(const Forest& forest, Metres distance) {
  if (!std::isfinite(distance.value)) {
    throw Error(ErrorCode::usage, "the distance from the trees must be a number");
  }
  return whole_rays([near = LimbGrid(limbs_of(forest), distance.value)](const RayCloud& rays, std::size_t i) {
    return !near.any_within(rays.ends[i]);
  });
}

}  // namespace ray
