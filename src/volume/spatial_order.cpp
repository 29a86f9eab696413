#include "spatial_order.h"

#include <raycloud/exec/fresh_memory.h>
#include <raycloud/exec/parallel.h>

#include <algorithm>
#include <array>

namespace ray {
namespace {

struct OrderedPoint {
  std::array<float, 3> at;
  std::uint32_t index;
};

constexpr std::size_t kSmallest = 8;

struct PointRange {
  std::size_t begin;
  std::size_t end;
  [[nodiscard]] std::size_t size() const { return end - begin; }
  /// The first part takes the largest size that leaves something for the second.
  [[nodiscard]] std::size_t middle() const {
    std::size_t half = kSmallest;
    while (2 * half < size())
      half *= 2;
    return begin + half;
  }
};

void cut(std::vector<OrderedPoint>& points, const PointRange& range) {
  const auto first = points.begin() + static_cast<std::ptrdiff_t>(range.begin);
  const auto last = points.begin() + static_cast<std::ptrdiff_t>(range.end);
  std::array<float, 3> low = first->at, high = first->at;
  for (auto point = first; point != last; ++point)
    for (std::size_t axis = 0; axis < 3; ++axis) {
      low[axis] = std::min(low[axis], point->at[axis]);
      high[axis] = std::max(high[axis], point->at[axis]);
    }
  std::size_t widest = 0;
  for (std::size_t axis = 1; axis < 3; ++axis)
    if (high[axis] - low[axis] > high[widest] - low[widest]) widest = axis;
  std::nth_element(first, points.begin() + static_cast<std::ptrdiff_t>(range.middle()), last,
                   [widest](const OrderedPoint& a, const OrderedPoint& b) {
                     return a.at[widest] != b.at[widest] ? a.at[widest] < b.at[widest] : a.index < b.index;
                   });
}

void cut_all(std::vector<OrderedPoint>& points, const PointRange& range) {
  if (range.size() <= kSmallest) return;
  cut(points, range);
  cut_all(points, {range.begin, range.middle()});
  cut_all(points, {range.middle(), range.end});
}

}  // namespace

std::vector<std::uint32_t> spatial_order(const Context& context, std::size_t count,
                                         const std::function<Eigen::Vector3f(std::size_t)>& point) {
  constexpr std::size_t kPoints = 1 << 16;  // that one thread orders
  auto points = touched_vector<OrderedPoint>(context, count);
  parallel_for(context, count, kPoints, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Eigen::Vector3f at = point(i);
      points[i] = {{at.x(), at.y(), at.z()}, static_cast<std::uint32_t>(i)};
    }
  });
  // All ranges of a size at once, until they are small.
  std::vector<PointRange> ranges{{0, count}};
  while (!ranges.empty() && ranges.front().size() > kPoints) {
    parallel_for(context, ranges.size(), 1, [&](std::size_t begin, std::size_t) {
      if (ranges[begin].size() > kSmallest) cut(points, ranges[begin]);
    });
    std::vector<PointRange> parts;
    for (const PointRange& range : ranges) {
      if (range.size() <= kPoints) {
        parts.push_back(range);
        continue;
      }
      parts.push_back({range.begin, range.middle()});
      parts.push_back({range.middle(), range.end});
    }
    ranges = std::move(parts);
  }
  parallel_for(context, ranges.size(), 1,
               [&](std::size_t begin, std::size_t) { cut_all(points, ranges[begin]); });
  std::vector<std::uint32_t> order(count);
  parallel_for(context, count, kPoints, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      order[i] = points[i].index;
  });
  return order;
}

}  // namespace ray
