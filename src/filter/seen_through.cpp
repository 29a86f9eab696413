#include "seen_through.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <limits>

namespace ray {
namespace {

constexpr double kBrickWidth = 20.0;           // radii
constexpr std::int64_t kMostBricks = 1 << 18;  // of an outlier's ray, the beginning will do
constexpr std::size_t kFew = 16;               // points of a cell that need no groups
constexpr std::size_t kGroup = 8;              // points, at most
constexpr double kRounded = 1.0 + 1e-9;

std::int64_t brick_at(double value, double width) {
  constexpr double kFar = 0x1p58;
  return static_cast<std::int64_t>(std::clamp(std::floor(value / width), -kFar, kFar));
}

/// Every third bit, for eight parts of a brick along an axis: near numbers are near in space.
std::uint32_t spread_bits(double part) {
  const auto number = static_cast<std::uint32_t>(std::clamp(8.0 * part, 0.0, 7.0));
  return (number & 1) | (number & 2) << 2 | (number & 4) << 4;
}

std::uint32_t place_in_brick(const Eigen::Vector3d& point, double width) {
  const Eigen::Array3d at = point.array() / width;
  const Eigen::Array3d part = at - at.floor();
  return spread_bits(part.x()) | spread_bits(part.y()) << 1 | spread_bits(part.z()) << 2;
}

}  // namespace

/// The cells of the bricks that the box of a ball touches.
template <class Visit>
void SeenThrough::each_cell_of_ball(const Eigen::Vector3d& point, const Visit& visit) const {
  const double reach = radius_ * kRounded;
  std::array<std::int64_t, 3> low, high;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double at = point[static_cast<Eigen::Index>(axis)];
    low[axis] = brick_at(at - reach, width_);
    high[axis] = brick_at(at + reach, width_);
  }
  for (std::int64_t z = low[2]; z <= high[2]; ++z)
    for (std::int64_t y = low[1]; y <= high[1]; ++y)
      for (std::int64_t x = low[0]; x <= high[0]; ++x)
        visit(cells_.along(0, x) | cells_.along(1, y) | cells_.along(2, z));
}

SeenThrough::SeenThrough(const Points& points, double radius)
    : passes_(points.size()), radius_(radius), width_(kBrickWidth * radius) {
  if (points.empty()) return;
  choose_cells(points);
  list_points(points);
}

/// As many as hold all bricks beside each other, but not very many more than there are points.
void SeenThrough::choose_cells(const Points& points) {
  constexpr int kFewest = 2;  // bits: a ball may touch two bricks that are beside each other
  constexpr std::size_t kMany = 32;
  std::array<int, 3> bits{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<Eigen::Index>(axis);
    const auto [low, high] =
        std::minmax_element(points.begin(), points.end(),
                            [&](const Eigen::Vector3d& p, const Eigen::Vector3d& q) { return p[a] < q[a]; });
    const std::int64_t extent = brick_at((*high)[a], width_) - brick_at((*low)[a], width_) + 3;
    bits[axis] = std::max<int>(std::bit_width(static_cast<std::uint64_t>(extent)), kFewest);
  }
  const int most = std::clamp<int>(std::bit_width(kMany * points.size()), 3 * kFewest, 31);
  while (bits[0] + bits[1] + bits[2] > most)
    --*std::max_element(bits.begin(), bits.end());
  std::uint32_t shift = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    cells_.shift[axis] = shift;
    cells_.mask[axis] = ((std::uint32_t{1} << bits[axis]) - 1) << shift;
    shift += static_cast<std::uint32_t>(bits[axis]);
  }
}

void SeenThrough::list_points(const Points& points) {
  occupied_.resize((cells_.count() + 63) / 64);
  for (const Eigen::Vector3d& point : points)
    each_cell_of_ball(point,
                      [&](std::size_t cell) { occupied_[cell / 64].cells |= std::uint64_t{1} << cell % 64; });
  std::uint32_t count = 0;
  for (Occupied& occupied : occupied_) {
    occupied.before = count;
    count += static_cast<std::uint32_t>(std::popcount(occupied.cells));
  }
  // The length of the list of each cell, then where it ends; filling it from behind leaves where it begins.
  std::vector<std::uint32_t> begins(count + 1);
  for (const Eigen::Vector3d& point : points)
    each_cell_of_ball(point, [&](std::size_t cell) { ++begins[rank_of(cell)]; });
  std::uint32_t sum = 0;
  for (std::uint32_t& begin : begins)
    begin = sum += begin;
  std::vector<Listed> listed(sum);
  for (std::size_t i = 0; i < points.size(); ++i)
    each_cell_of_ball(points[i], [&](std::size_t cell) {
      listed[--begins[rank_of(cell)]] = {place_in_brick(points[i], width_), static_cast<std::uint32_t>(i)};
    });
  for (std::size_t cell = 0; cell < count; ++cell) {
    first_node_.push_back(static_cast<std::uint32_t>(nodes_.size()));
    add_nodes(points, {listed.data() + begins[cell], listed.data() + begins[cell + 1]});
  }
  first_node_.push_back(static_cast<std::uint32_t>(nodes_.size()));
}

/// Of the points of a cell.
void SeenThrough::add_nodes(const Points& points, std::span<Listed> listed) {
  const bool few = listed.size() <= kFew;
  if (!few) std::sort(listed.begin(), listed.end());
  for (std::size_t i = 0; i < listed.size(); ++i) {
    if (!few && i % kGroup == 0) add_group(points, listed.subspan(i, std::min(kGroup, listed.size() - i)));
    const auto next = static_cast<std::uint32_t>(nodes_.size() + 1);
    nodes_.push_back({points[listed[i].point], radius_ * radius_, listed[i].point, next});
  }
}

void SeenThrough::add_group(const Points& points, std::span<const Listed> listed) {
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  for (const Listed& one : listed)
    middle += points[one.point] / static_cast<double>(listed.size());
  double reach = 0.0;
  for (const Listed& one : listed)
    reach = std::max(reach, (points[one.point] - middle).norm() + radius_);
  const std::size_t end = nodes_.size() + 1 + listed.size();
  constexpr double kNotLess = 1.001;  // whatever is rounded
  nodes_.push_back({middle, kNotLess * reach * reach, kIsGroup, static_cast<std::uint32_t>(end)});
}

void SeenThrough::add(const Eigen::Vector3d& start, const Eigen::Vector3d& end, bool bounded) {
  if (passes_.empty()) return;
  const double length = (end - start).norm();
  const double to = bounded ? length - radius_ : length;
  if (!(to > 0.0)) return;
  const Line line{start, (end - start) / length};
  std::array<std::uint32_t, 3> cell{}, step{};
  std::array<double, 3> next{}, each{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<Eigen::Index>(axis);
    const double direction = line.direction[a];
    const std::int64_t brick = brick_at(start[a], width_);
    cell[axis] = cells_.along(axis, brick);
    const bool up = direction > 0.0;
    step[axis] = cells_.along(axis, up ? 1 : -1);
    each[axis] = width_ / std::abs(direction);
    next[axis] = direction == 0.0
                     ? std::numeric_limits<double>::infinity()
                     : (static_cast<double>(brick + (up ? 1 : 0)) * width_ - start[a]) / direction;
  }
  double in = 0.0;
  for (std::int64_t bricks = 0; bricks < kMostBricks; ++bricks) {
    std::size_t axis = next[1] < next[0] ? 1 : 0;
    axis = next[2] < next[axis] ? 2 : axis;
    const double out = std::clamp(next[axis], in, to);
    const std::size_t at = cell[0] | cell[1] | cell[2];
    if ((occupied_[at / 64].cells >> at % 64 & 1) != 0) visit(at, line, in, out);
    if (next[axis] >= to) return;
    in = out;
    cell[axis] = (cell[axis] + step[axis]) & cells_.mask[axis];
    next[axis] += each[axis];
  }
}

/// Counts for the points of a cell to which the line is nearest on its way through the brick, so that each
/// ray counts once.
void SeenThrough::visit(std::size_t cell, const Line& line, double in, double out) {
  const std::size_t rank = rank_of(cell);
  const std::uint32_t end = first_node_[rank + 1];
  for (std::uint32_t i = first_node_[rank]; i < end; ++i) {
    const Node& node = nodes_[i];
    const bool is_group = node.point == kIsGroup;
    const Eigen::Vector3d offset = node.middle - line.start;
    const double nearest = offset.dot(line.direction);
    if (offset.squaredNorm() - nearest * nearest < node.radius2) {
      if (!is_group && nearest >= in && nearest < out)
        std::atomic_ref(passes_[node.point]).fetch_add(1, std::memory_order_relaxed);
    } else if (is_group) {
      i = node.end - 1;
    }
  }
}

}  // namespace ray
