#include "points_in_spheres.h"

#include <raycloud/exec/parallel.h>

#include <algorithm>
#include <atomic>
#include <cmath>

namespace ray {
namespace {

using Index = Tetrahedra::Index;

/// What holds the sphere of a cell, or the half of space that it is where the cell has a vertex at infinity,
/// and little more.
class SphereBound {
 public:
  SphereBound(const Tetrahedra& cells, Index at) : is_half_space_(cells.is_infinite(at)) {
    const auto& vertices = cells.cell(at).vertices;
    from_ = cells.point(vertices[0]);
    if (is_half_space_) {
      towards_ = normal_of(from_, cells.point(vertices[1]), cells.point(vertices[2]));
    } else {
      const Sphere sphere = sphere_of(cells.corners(at));
      towards_ = sphere.centre;
      most_ = sphere.squared_radius * (1.0 + 1e-12);
    }
  }

  /// Certain if true.
  [[nodiscard]] bool misses(const LatticePoint& low, const LatticePoint& high) const {
    double sum = 0.0, doubt = 0.0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double least = static_cast<double>(low[axis]) - from_[axis];
      const double most = static_cast<double>(high[axis]) - from_[axis];
      if (is_half_space_) {
        const double along = towards_[axis] * (towards_[axis] > 0.0 ? most : least);
        sum -= along;
        doubt += 1e-14 * std::abs(along);
      } else {
        const double away = std::clamp(towards_[axis], least, most) - towards_[axis];
        sum += away * away;
      }
    }
    return sum > (is_half_space_ ? doubt : most_);
  }

 private:
  bool is_half_space_;
  LatticePoint from_{};
  std::array<double, 3> towards_{};  ///< from there: to the middle of the sphere, or out of the half of space
  double most_ = 0.0;                ///< squared radius
};

/// Boxes around points that follow each other, eight of one level in each of the next.
class PointBoxes {
 public:
  PointBoxes(const Tetrahedra& cells, const std::vector<Index>& points) : cells_(cells), points_(points) {
    for (std::size_t count = points.size(); levels_.empty() || count > 1; count = levels_.back().size()) {
      std::vector<Box> level((count + kFan - 1) / kFan);
      for (std::size_t i = 0; i < count; ++i) {
        const Box& part =
            levels_.empty() ? Box{cells.point(points[i]), cells.point(points[i])} : levels_.back()[i];
        Box& box = level[i / kFan];
        for (std::size_t axis = 0; axis < 3; ++axis) {
          box.low[axis] = std::min(box.low[axis], part.low[axis]);
          box.high[axis] = std::max(box.high[axis], part.high[axis]);
        }
      }
      levels_.push_back(std::move(level));
    }
  }

  /// Marks those of the points, by their place among them, that would make the cell go.
  void mark_in_sphere(Index at, std::vector<std::uint8_t>& marks) const {
    if (!points_.empty()) mark_in_box(at, SphereBound(cells_, at), levels_.size() - 1, 0, marks);
  }

 private:
  static constexpr std::size_t kFan = 8;
  struct Box {
    LatticePoint low{kLatticeSteps, kLatticeSteps, kLatticeSteps}, high{-1, -1, -1};
  };

  void mark_in_box(Index at, const SphereBound& bound, std::size_t level, std::size_t number,
                   std::vector<std::uint8_t>& marks) const {
    const Box& box = levels_[level][number];
    if (bound.misses(box.low, box.high)) return;
    const std::size_t first = number * kFan;
    if (level > 0) {
      for (std::size_t i = first; i < std::min(first + kFan, levels_[level - 1].size()); ++i)
        mark_in_box(at, bound, level - 1, i, marks);
      return;
    }
    for (std::size_t i = first; i < std::min(first + kFan, points_.size()); ++i) {
      const std::atomic_ref<std::uint8_t> mark(marks[i]);  // other cells may find the same point meanwhile
      if (mark.load(std::memory_order_relaxed) == 0 && cells_.conflicts(at, points_[i]))
        mark.store(1, std::memory_order_relaxed);
    }
  }

  const Tetrahedra& cells_;
  const std::vector<Index>& points_;
  std::vector<std::vector<Box>> levels_;
};

/// Cell by cell.
std::vector<std::uint8_t> marked_by_boxes(const Context& context, const Tetrahedra& cells,
                                          std::span<const Index> asked, const std::vector<Index>& points) {
  const PointBoxes boxes(cells, points);
  std::vector<std::uint8_t> marks(points.size(), 0);
  parallel_for(context, asked.size(), 256, [&](std::size_t begin, std::size_t end) {
    for (const Index at : asked.subspan(begin, end - begin))
      boxes.mark_in_sphere(at, marks);
  });
  return marks;
}

/// Point by point: soon done where most cells around are asked.
std::vector<std::uint8_t> marked_by_walking(const Context& context, const Tetrahedra& cells,
                                            std::span<const Index> asked, const std::vector<Index>& points) {
  std::vector<std::uint8_t> is_asked(cells.places(), 0);
  for (const Index at : asked)
    is_asked[at] = 1;
  std::vector<std::uint8_t> marks(points.size(), 0);
  parallel_for(context, points.size(), 4096, [&](std::size_t begin, std::size_t end) {
    std::vector<Index> region;
    Index from = cells.cell_of(cells.near_point(points[begin]));
    for (std::size_t i = begin; i < end; ++i) {
      marks[i] = cells.any_in_conflict(points[i], from, region, [&](Index at) { return is_asked[at] != 0; });
      from = region.front();
    }
  });
  return marks;
}

}  // namespace

std::vector<Index> points_in_spheres(const Context& context, const Tetrahedra& cells,
                                     std::span<const Index> asked, const std::vector<Index>& points) {
  const auto marks =
      (asked.size() < points.size() / 2 ? marked_by_boxes : marked_by_walking)(context, cells, asked, points);
  std::vector<Index> found;
  for (std::size_t i = 0; i < points.size(); ++i)
    if (marks[i] != 0) found.push_back(points[i]);
  return found;
}

}  // namespace ray
