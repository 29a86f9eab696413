#include "brick_list.h"
#include "cubes_between.h"

#include <raycloud/core/error.h>
#include <raycloud/spatial/crossed_cubes.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstdlib>
#include <string>

namespace ray {
namespace {

constexpr std::int64_t kMostCubes = std::int64_t{1} << 30;
constexpr double kOne = 4294967296.0;  // 2^32: a cube in fixed point

/// A ray in numbers of cubes, counted from a corner of the brick of its start.
struct Path {
  VoxelIndex brick;                  // of the start
  std::array<std::int32_t, 3> from;  // cubes
  std::array<std::int32_t, 3> to;
  std::array<double, 3> fraction;  // of the start within its cube
  std::array<double, 3> way;       // from start to end
};

Path path_of(const Eigen::Vector3d& start, const Eigen::Vector3d& end, double width) {
  const VoxelIndex first = voxel_index(start, {width});
  const VoxelIndex last = voxel_index(end, {width});
  Path path{{first.x >> 2, first.y >> 2, first.z >> 2}, {}, {}, {}, {}};
  const std::array<std::int64_t, 3> a{first.x, first.y, first.z};
  const std::array<std::int64_t, 3> b{last.x, last.y, last.z};
  for (std::size_t axis = 0; axis < 3; axis++) {
    const std::int64_t corner = a[axis] & ~std::int64_t{3};
    if (std::abs(b[axis] - corner) > kMostCubes) {
      throw Error(ErrorCode::out_of_range, "a ray of " + std::to_string((end - start).norm()) +
                                               " m is too long for cubes of " + std::to_string(width) +
                                               " m (at most 2^30 along an axis)");
    }
    const auto i = static_cast<Eigen::Index>(axis);
    path.from[axis] = static_cast<std::int32_t>(a[axis] - corner);
    path.to[axis] = static_cast<std::int32_t>(b[axis] - corner);
    path.fraction[axis] = start[i] / width - static_cast<double>(a[axis]);
    path.way[axis] = (end[i] - start[i]) / width;
  }
  return path;
}

/// The way along a minor axis, in fixed point.
struct Minor {
  std::int64_t start;
  std::int64_t leaves;  // where the ray leaves the first slab
  std::int64_t step;    // from slab to slab
  std::int64_t ahead;   // -1 if it goes up, 0 if down
  double speed;         // |step|
  std::int32_t from, to;
  bool is_exact;  // whether rounding takes the ray nowhere past its end, or back

  Minor(const Path& path, std::size_t axis, double per_slab, double to_first_face, std::int32_t slabs) {
    const double at = path.from[axis] + path.fraction[axis];
    const double slope = path.way[axis] * per_slab;
    start = static_cast<std::int64_t>(at * kOne);
    leaves = static_cast<std::int64_t>((at + slope * to_first_face) * kOne);
    step = static_cast<std::int64_t>(slope * kOne);
    if (at + slope * to_first_face < 0.0) leaves--;  // down, not towards 0
    ahead = slope > 0.0 ? -1 : 0;
    speed = std::abs(slope);
    from = path.from[axis];
    to = path.to[axis];
    is_exact = slabs == 1 || (is_between(leaves) && is_between(leaves + (slabs - 2) * step));
  }
  [[nodiscard]] bool is_between(std::int64_t position) const {
    return position >> 32 >= std::min(from, to) && position >> 32 <= std::max(from, to);
  }
  [[nodiscard]] std::int32_t cube(std::int64_t position) const {
    const auto cube = static_cast<std::int32_t>(position >> 32);
    return is_exact ? cube : std::clamp(cube, std::min(from, to), std::max(from, to));
  }
  /// Distance to the next face, in the direction of the ray.
  [[nodiscard]] double to_face(std::int64_t position) const {
    return static_cast<double>((position ^ ahead) & 0xffffffff);
  }
};

/// The way of a ray through the slabs of one brick of its main axis, along a minor axis.
struct Section {
  std::int64_t at;      // where it enters the first slab
  std::int64_t leaves;  // where it leaves that
  std::int64_t end;     // where it leaves the last
  std::int32_t from;    // cubes
  std::int32_t to;

  [[nodiscard]] bool is_in_one_brick() const { return (from ^ to) >> 2 == 0; }
  [[nodiscard]] Section next(const Minor& minor) const {
    return {end, end + minor.step, end + 4 * minor.step, to, minor.cube(end + 4 * minor.step)};
  }
};

/// A ray whose main axis is A goes from brick to brick along it, through one or two bricks along each of the
/// other axes. Mostly, all that it could cross there is known, and there is nothing to do.
template <std::size_t A>
class Walk {
 public:
  Walk(const Path& path, std::uint32_t ray, double per_slab, double to_first_face, BrickList& bricks)
      : path_(path),
        ray_(ray),
        bricks_(bricks),
        slabs_(std::abs(path.to[A] - path.from[A]) + 1),
        direction_(path.way[A] < 0.0 ? -1 : 1),
        u_(path, B, per_slab, to_first_face, slabs_),
        v_(path, C, per_slab, to_first_face, slabs_) {
    const VoxelIndex& brick = path.brick;
    const VoxelIndex last{brick.x + (path.to[0] >> 2), brick.y + (path.to[1] >> 2),
                          brick.z + (path.to[2] >> 2)};
    if (bricks.names().of(last) != BrickNames::kNone) start_ = bricks.names().of(brick);
  }

  void go() {
    std::int32_t left = slabs_;
    std::int32_t count = direction_ > 0 ? 4 - (path_.from[A] & 3) : (path_.from[A] & 3) + 1;
    const BrickNames::Name step = direction_ > 0 ? BrickNames::kSteps[A] : -BrickNames::kSteps[A];
    std::int32_t a = path_.from[A];
    BrickNames::Name row = start_;
    Section u = first_section(u_, count), v = first_section(v_, count);
    for (; left > count; left -= count, count = 4) {
      if (!is_known(row, u, v)) cross(a, count, row, u, v);
      a += count * direction_;
      row += step;
      u = u.next(u_);
      v = v.next(v_);
    }
    u.to = u_.to;
    v.to = v_.to;
    if (!is_known(row, u, v)) cross(a, left, row, u, v);
  }

 private:
  static constexpr std::size_t B = (A + 1) % 3, C = (A + 2) % 3;

  static Section first_section(const Minor& minor, std::int32_t count) {
    const std::int64_t end = minor.leaves + (count - 1) * minor.step;
    return {minor.start, minor.leaves, end, minor.from, minor.cube(end)};
  }

  /// Of the brick of a cube. `row`: that of the brick of cubes 0, 0 of the minor axes.
  static BrickNames::Name name(BrickNames::Name row, std::int32_t b, std::int32_t c) {
    const auto steps = [](std::int32_t count, std::size_t axis) {
      return static_cast<BrickNames::Name>(std::int64_t{count}) * BrickNames::kSteps[axis];
    };
    return row + steps(b >> 2, B) + steps(c >> 2, C);
  }

  [[nodiscard]] bool is_known(BrickNames::Name row, const Section& u, const Section& v) {
    if (start_ == BrickNames::kNone) return false;
    const std::uint64_t first = ~bricks_.place(name(row, u.from, v.from)).cubes;
    const std::uint64_t last = ~bricks_.place(name(row, u.to, v.to)).cubes;
    // Not a condition on each axis: those are hard to predict.
    const std::uint32_t corner = static_cast<std::uint32_t>((u.from ^ u.to) & (v.from ^ v.to)) >> 2;
    if ((first | last | corner) == 0) return true;
    const std::size_t i = CubesBetween::index(u.from, u.to), j = CubesBetween::index(v.from, v.to);
    const CubesBetween& between_u = kCubesBetween[B];
    const CubesBetween& between_v = kCubesBetween[C];
    if (((between_u.first[i] & between_v.first[j] & first) |
         (between_u.last[i] & between_v.last[j] & last)) != 0)
      return false;
    if (corner == 0) return true;
    return (between_u.first[i] & between_v.last[j] & ~bricks_.place(name(row, u.from, v.to)).cubes) == 0 &&
           (between_u.last[i] & between_v.first[j] & ~bricks_.place(name(row, u.to, v.from)).cubes) == 0;
  }

  /// Slab by slab. Apart, so that what is known already is passed by in a short loop.
  [[gnu::noinline]] void cross(std::int32_t a, std::int32_t count, BrickNames::Name row, Section u,
                               Section v) {
    std::array<std::uint64_t, 4> cubes{};  // of the bricks that are even and odd along the minor axes
    const auto cross = [&](std::int32_t b, std::int32_t c, std::uint64_t slabs) {
      cubes[which(b, c)] |= slabs << ((b & 3) << 2 * B | (c & 3) << 2 * C);
    };
    const std::int32_t brick_a = a >> 2;
    std::uint64_t slab_before = 0;
    std::int32_t b = u.from, c = v.from;
    for (std::int32_t left = count - 1; left >= 0; left--, a += direction_) {
      const std::uint64_t slab = std::uint64_t{1} << ((a & 3) << 2 * A);
      cross(b, c, slab_before | slab);
      const std::int32_t next_b = left == 0 ? u.to : u_.cube(u.leaves);
      const std::int32_t next_c = left == 0 ? v.to : v_.cube(v.leaves);
      // Where both change, the nearer face first: a cube in between.
      if (b != next_b && c != next_c) {
        const bool b_first = u_.to_face(u.at) * v_.speed < v_.to_face(v.at) * u_.speed;
        cross(b_first ? next_b : b, b_first ? c : next_c, slab);
      }
      b = next_b;
      c = next_c;
      u.at = u.leaves;
      v.at = v.leaves;
      u.leaves += u_.step;
      v.leaves += v_.step;
      slab_before = slab;
    }
    cross(b, c, slab_before);

    const auto list = [&](std::int32_t to_b, std::int32_t to_c) {
      std::array<std::int32_t, 3> brick{};
      brick[A] = brick_a;
      brick[B] = to_b >> 2;
      brick[C] = to_c >> 2;
      bricks_.add(ray_, {path_.brick.x + brick[0], path_.brick.y + brick[1], path_.brick.z + brick[2]},
                  start_ == BrickNames::kNone ? BrickNames::kNone : name(row, to_b, to_c),
                  cubes[which(to_b, to_c)]);
    };
    list(u.from, v.from);
    if (!u.is_in_one_brick()) list(u.to, v.from);
    if (!v.is_in_one_brick()) list(u.from, v.to);
    if (!u.is_in_one_brick() && !v.is_in_one_brick()) list(u.to, v.to);
  }
  static std::size_t which(std::int32_t b, std::int32_t c) {
    return static_cast<std::size_t>((b >> 2 & 1) | (c >> 1 & 2));
  }

  const Path& path_;
  std::uint32_t ray_;
  BrickList& bricks_;
  std::int32_t slabs_;
  std::int32_t direction_;
  Minor u_, v_;
  BrickNames::Name start_ = BrickNames::kNone;  // of a ray all of whose bricks have names
};

template <std::size_t A>
void walk(const Path& path, std::uint32_t ray, BrickList& bricks) {
  const double to_first_face = path.way[A] < 0.0 ? path.fraction[A] : 1.0 - path.fraction[A];
  const double length = std::abs(path.way[A]);
  Walk<A>(path, ray, length > 0.0 ? 1.0 / length : 0.0, to_first_face, bricks).go();
}

}  // namespace

CrossedCubes crossed_cubes(std::span<const Eigen::Vector3d> starts, std::span<const Eigen::Vector3d> ends,
                           Metres width, std::size_t most_bricks, const KnownBricks* known) {
  assert(starts.size() == ends.size() && width.value > 0.0);
  if (starts.empty()) return {};
  const VoxelIndex first = voxel_index(starts[0], width);
  BrickList bricks({first.x >> 2, first.y >> 2, first.z >> 2}, known);
  std::size_t done = 0;
  for (; done < ends.size() && bricks.size() < most_bricks; done++) {
    const Path path = path_of(starts[done], ends[done], width.value);
    const auto ray = static_cast<std::uint32_t>(done);
    const std::array<double, 3> size{std::abs(path.way[0]), std::abs(path.way[1]), std::abs(path.way[2])};
    if (size[0] >= size[1] && size[0] >= size[2])
      walk<0>(path, ray, bricks);
    else if (size[1] >= size[2])
      walk<1>(path, ray, bricks);
    else
      walk<2>(path, ray, bricks);
  }
  CrossedCubes crossed = bricks.take_all();
  crossed.done = done;
  return crossed;
}

}  // namespace ray
