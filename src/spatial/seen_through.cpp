#include <raycloud/core/lanes.h>
#include <raycloud/spatial/seen_through.h>

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <limits>

#ifdef __SSE2__
#include <emmintrin.h>
#endif

namespace ray {
namespace {

constexpr double kBrickWidth = 32.0;           // radii
constexpr std::int64_t kMostBricks = 1 << 18;  // of an outlier's ray, the beginning will do
constexpr std::size_t kFew = 32;               // points of a cell that need no groups
constexpr std::size_t kGroup = 8;              // points, at most: those of an Eight
constexpr double kRounded = 1.0 + 1e-9;

std::int64_t brick_at(double value, double width) {
  constexpr double kFurthest = 0x1p58;
  return static_cast<std::int64_t>(std::clamp(std::floor(value / width), -kFurthest, kFurthest));
}

/// Every third bit, for eight parts of a brick along an axis.
std::uint32_t spread_bits(float offset) {
  const auto part = 8.0F * (offset / static_cast<float>(kBrickWidth) + 0.5F);
  const auto number = static_cast<std::uint32_t>(std::clamp(part, 0.0F, 7.0F));
  return (number & 1) | (number & 2) << 2 | (number & 4) << 4;
}

/// Near numbers are near in space.
std::uint32_t place_in_brick(const Eigen::Vector3f& offset) {
  return spread_bits(offset.x()) | spread_bits(offset.y()) << 1 | spread_bits(offset.z()) << 2;
}

/// The middle of a brick along an axis.
double middle_of(std::int64_t brick, double width) {
  return (static_cast<double>(brick) + 0.5) * width;
}

/// What a squared distance may be at most, in radii, given what is rounded off within a brick: 0.001.
float with_room(float reach) {
  return 1.001F * reach * reach + 0.01F;
}

using EightFloats [[gnu::vector_size(32), gnu::may_alias]] = float;

/// Whose sign is that of what is below zero.
[[gnu::always_inline]] inline std::uint32_t bits_below_zero(const EightFloats& values) {
#ifdef __SSE2__
  const __m128 low{values[0], values[1], values[2], values[3]},
      high{values[4], values[5], values[6], values[7]};
  return static_cast<std::uint32_t>(_mm_movemask_ps(low) | _mm_movemask_ps(high) << 4);
#else
  std::uint32_t bits = 0;
  for (std::uint32_t i = 0; i < 8; ++i)
    bits |= std::uint32_t{std::signbit(values[i])} << i;
  return bits;
#endif
}

}  // namespace

/// The cells of the bricks that the box of a ball touches, and the middles of the bricks.
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
        visit(cells_.along(0, x) | cells_.along(1, y) | cells_.along(2, z),
              Eigen::Vector3d(middle_of(x, width_), middle_of(y, width_), middle_of(z, width_)));
}

SeenThrough::SeenThrough(Points points, double radius)
    : points_(std::move(points)), passes_(points_.size()), radius_(radius), width_(kBrickWidth * radius) {
  if (points_.empty()) return;
  for (const Eigen::Vector3d& point : points_)
    box_.extend(point);
  const Eigen::Array3d furthest = box_.min().cwiseAbs().cwiseMax(box_.max().cwiseAbs());
  const Eigen::Array3d reach = 1.001 * radius_ + 1e-9 * furthest;  // with room for rounding
  box_ = {box_.min().array() - reach, box_.max().array() + reach};
  choose_cells();
  list_points();
}

/// Where a line is inside the box of all balls; nowhere if the second is less.
std::pair<double, double> SeenThrough::inside_box(const Line& line) const {
  double in = 0.0, out = std::numeric_limits<double>::infinity();
  for (Eigen::Index a = 0; a < 3; ++a) {
    const double to_min = box_.min()[a] - line.start[a], to_max = box_.max()[a] - line.start[a];
    if (line.direction[a] == 0.0) {
      if (to_min > 0.0 || to_max < 0.0) out = -1.0;
      continue;
    }
    const double one = to_min / line.direction[a], other = to_max / line.direction[a];
    in = std::max(in, std::min(one, other));
    out = std::min(out, std::max(one, other));
  }
  return {in, out};
}

/// As many as hold all bricks beside each other, but not very many more than there are points.
void SeenThrough::choose_cells() {
  constexpr int kFewest = 2;  // bits: a ball may touch two bricks that are beside each other
  constexpr std::size_t kMany = 32;
  std::array<int, 3> bits{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<Eigen::Index>(axis);
    const auto [low, high] =
        std::minmax_element(points_.begin(), points_.end(),
                            [&](const Eigen::Vector3d& p, const Eigen::Vector3d& q) { return p[a] < q[a]; });
    const std::int64_t extent = brick_at((*high)[a], width_) - brick_at((*low)[a], width_) + 3;
    bits[axis] = std::max<int>(std::bit_width(static_cast<std::uint64_t>(extent)), kFewest);
  }
  const int most = std::clamp<int>(std::bit_width(kMany * points_.size()), 3 * kFewest, 31);
  while (bits[0] + bits[1] + bits[2] > most)
    --*std::max_element(bits.begin(), bits.end());
  std::uint32_t shift = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    cells_.shift[axis] = shift;
    cells_.mask[axis] = ((std::uint32_t{1} << bits[axis]) - 1) << shift;
    shift += static_cast<std::uint32_t>(bits[axis]);
  }
}

void SeenThrough::list_points() {
  occupied_.resize((cells_.count() + 63) / 64);
  for (const Eigen::Vector3d& point : points_)
    each_cell_of_ball(point, [&](std::size_t cell, const Eigen::Vector3d&) {
      occupied_[cell / 64].cells |= std::uint64_t{1} << cell % 64;
    });
  std::uint32_t count = 0;
  for (Occupied& occupied : occupied_) {
    occupied.before = count;
    count += static_cast<std::uint32_t>(std::popcount(occupied.cells));
  }
  // The length of the list of each cell, then where it ends; filling it from behind leaves where it begins.
  std::vector<std::uint32_t> begins(count + 1);
  for (const Eigen::Vector3d& point : points_)
    each_cell_of_ball(point, [&](std::size_t cell, const Eigen::Vector3d&) { ++begins[rank_of(cell)]; });
  std::uint32_t sum = 0;
  for (std::uint32_t& begin : begins)
    begin = sum += begin;
  std::vector<Listed> listed(sum);
  for (std::size_t i = 0; i < points_.size(); ++i)
    each_cell_of_ball(points_[i], [&](std::size_t cell, const Eigen::Vector3d& middle) {
      listed[--begins[rank_of(cell)]] = {((points_[i] - middle) / radius_).cast<float>(),
                                         static_cast<std::uint32_t>(i)};
    });
  for (std::size_t cell = 0; cell < count; ++cell)
    add_list({listed.data() + begins[cell], listed.data() + begins[cell + 1]});
}

/// Of a cell.
void SeenThrough::add_list(std::span<Listed> listed) {
  const auto place = [&] { return static_cast<std::uint32_t>(eights_.size()); };
  const std::uint32_t begin = place();
  if (listed.size() <= kFew) {
    add_points(listed);
    lists_.push_back({begin, place(), false});
    return;
  }
  std::sort(listed.begin(), listed.end(), [](const Listed& a, const Listed& b) {
    return place_in_brick(a.offset) < place_in_brick(b.offset);
  });
  const std::size_t groups = (listed.size() + kGroup - 1) / kGroup;
  eights_.resize(begin + (groups + 7) / 8);
  lists_.push_back({begin, place(), true});
  for (std::size_t i = 0; i < groups; ++i) {
    const auto group = listed.subspan(i * kGroup, std::min(kGroup, listed.size() - i * kGroup));
    Eigen::Vector3f middle = Eigen::Vector3f::Zero();
    for (const Listed& one : group)
      middle += one.offset / static_cast<float>(group.size());
    float reach = 0.0F;
    for (const Listed& one : group)
      reach = std::max(reach, (one.offset - middle).norm() + 1.0F);
    eights_[begin + i / 8].set(i % 8, middle, with_room(reach), place());
    add_points(group);
  }
}

void SeenThrough::add_points(std::span<const Listed> listed) {
  for (std::size_t i = 0; i < listed.size(); ++i) {
    if (i % 8 == 0) eights_.emplace_back();
    eights_.back().set(i % 8, listed[i].offset, with_room(1.0F), listed[i].point);
  }
}

void SeenThrough::add(const Eigen::Vector3d& start, const Eigen::Vector3d& end, bool bounded) {
  if (points_.empty()) return;
  const double length = (end - start).norm();
  double to = bounded ? length - radius_ : length;
  if (!(to > 0.0)) return;
  const Line line{start, (end - start) / length};
  const auto [begins, ends] = inside_box(line);
  to = std::min(to, ends);
  if (!(begins < to)) return;
  std::array<std::uint32_t, 3> cell{}, step{};
  std::array<double, 3> next{}, each{};
  Eigen::Vector3d middle, to_next;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<Eigen::Index>(axis);
    const double direction = line.direction[a];
    const std::int64_t brick = brick_at(start[a] + begins * direction, width_);
    cell[axis] = cells_.along(axis, brick);
    middle[a] = middle_of(brick, width_);
    const bool up = direction > 0.0;
    step[axis] = cells_.along(axis, up ? 1 : -1);
    to_next[a] = up ? width_ : -width_;
    each[axis] = width_ / std::abs(direction);
    next[axis] = direction == 0.0
                     ? std::numeric_limits<double>::infinity()
                     : (static_cast<double>(brick + (up ? 1 : 0)) * width_ - start[a]) / direction;
  }
  const Eigen::Vector3f along = line.direction.cast<float>();
  const double per_radius = 1.0 / radius_;
  double in = begins;
  for (std::int64_t bricks = 0; bricks < kMostBricks; ++bricks) {
    std::size_t axis = next[1] < next[0] ? 1 : 0;
    axis = next[2] < next[axis] ? 2 : axis;
    const double out = std::clamp(next[axis], in, to);
    const std::size_t at = cell[0] | cell[1] | cell[2];
    if ((occupied_[at / 64].cells >> at % 64 & 1) != 0) {
      const Eigen::Vector3d from = (start - middle + in * line.direction) * per_radius;
      visit(at, line, {in, out, from.cast<float>(), along});
    }
    if (next[axis] >= to) return;
    in = out;
    cell[axis] = (cell[axis] + step[axis]) & cells_.mask[axis];
    middle[static_cast<Eigen::Index>(axis)] += to_next[static_cast<Eigen::Index>(axis)];
    next[axis] += each[axis];
  }
}

/// The loops of a brick, for processors with and without AVX2.
struct SeenThrough::Kernels {
  [[gnu::always_inline]] static EightFloats lanes(const Eight::Floats& values) {
    return reinterpret_cast<const EightFloats&>(values);
  }

  /// Calls `visit(which)` for all of the balls that the line meets, and few others.
  template <class Visit>
  [[gnu::always_inline]] static void each_near(std::span<const Eight> eights, const Way& way,
                                               const Visit& visit) {
    const float along_x = way.along.x(), along_y = way.along.y(), along_z = way.along.z();
    for (const Eight& eight : eights) {
      const EightFloats x = lanes(eight.x) - way.from.x(), y = lanes(eight.y) - way.from.y(),
                        z = lanes(eight.z) - way.from.z();
      const EightFloats nearest = x * along_x + y * along_y + z * along_z;
      for (std::uint32_t met =
               bits_below_zero(x * x + y * y + z * z - nearest * nearest - lanes(eight.reach2));
           met != 0; met &= met - 1)
        visit(eight.which[static_cast<std::size_t>(std::countr_zero(met))]);
    }
  }

  [[gnu::always_inline]] static void visit(SeenThrough& seen, std::size_t cell, const Line& line,
                                           const Way& way) {
    const auto visit_point = [&](std::uint32_t point) {
      const Eigen::Vector3d offset = seen.points_[point] - line.start;
      const double nearest = offset.dot(line.direction);
      if (nearest >= way.in && nearest < way.out &&
          offset.squaredNorm() - nearest * nearest < seen.radius_ * seen.radius_)
        std::atomic_ref(seen.passes_[point]).fetch_add(1, std::memory_order_relaxed);
    };
    const List& list = seen.lists_[seen.rank_of(cell)];
    const std::span<const Eight> eights = std::span<const Eight>(seen.eights_);
    const std::span<const Eight> of_list = eights.subspan(list.begin, list.end - list.begin);
    if (list.is_of_groups)
      each_near(of_list, way,
                [&](std::uint32_t group) { each_near(eights.subspan(group, 1), way, visit_point); });
    else
      each_near(of_list, way, visit_point);
  }
  static void visit_plain(SeenThrough& seen, std::size_t cell, const Line& line, const Way& way) {
    visit(seen, cell, line, way);
  }
#ifdef RAY_HAS_LANES
  RAY_AVX2 static void visit_avx2(SeenThrough& seen, std::size_t cell, const Line& line, const Way& way) {
    visit(seen, cell, line, way);
  }
#endif
};

/// Counts for the points of a cell to which the line is nearest on its way through the brick, so that each
/// ray counts once.
void SeenThrough::visit(std::size_t cell, const Line& line, const Way& way) {
#ifdef RAY_HAS_LANES
  if (lanes_in_use != LaneSet::kPlain) return Kernels::visit_avx2(*this, cell, line, way);
#endif
  Kernels::visit_plain(*this, cell, line, way);
}

}  // namespace ray
