#include <raycloud/core/error.h>
#include <raycloud/spatial/crossed_cubes.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <new>
#include <string>
#include <utility>

namespace ray {
namespace {

constexpr std::int64_t kMostCubes = std::int64_t{1} << 30;
constexpr double kOne = 4294967296.0;  // 2^32: a cube in fixed point

/// Collects the bricks of all rays. Neighbouring rays cross the same cubes near the sensor, so a memory of
/// what was listed, in boxes of 2³ bricks, saves nearly all of the list.
class Bricks {
 public:
  explicit Bricks(CrossedCubes& crossed)
      : crossed_(crossed), boxes_(static_cast<Box*>(std::calloc(kBoxes, sizeof(Box)))) {
    if (boxes_ == nullptr) throw std::bad_alloc();
  }

  void add(std::uint32_t ray, std::int64_t x, std::int64_t y, std::int64_t z, std::uint64_t cubes) {
    if (((x ^ x_) | (y ^ y_) | (z ^ z_)) >> 1 != 0 || box_ == nullptr) find_box(x, y, z);
    std::uint64_t& listed = box_->cubes[(x & 1) | (y & 1) << 1 | (z & 1) << 2];
    const std::uint64_t fresh = cubes & ~listed;
    if (fresh == 0) return;
    listed |= fresh;
    list(ray, voxel_place({x, y, z}), fresh);
  }

 private:
  static constexpr int kBoxBits = 14;
  static constexpr std::size_t kBoxes = std::size_t{1}
                                        << kBoxBits;  // 1.5 MB, of which small chunks touch little
  struct Box {
    VoxelIndex number;
    std::uint64_t is_used;
    std::array<std::uint64_t, 8> cubes;
  };
  struct Free {
    void operator()(Box* boxes) const { std::free(boxes); }
  };

  void find_box(std::int64_t x, std::int64_t y, std::int64_t z) {
    const VoxelIndex number{x >> 1, y >> 1, z >> 1};
    box_ = &boxes_[slot_of(number)];
    if (box_->is_used == 0 || box_->number != number) *box_ = {number, 1, {}};
    x_ = x;
    y_ = y;
    z_ = z;
  }

  static std::size_t slot_of(const VoxelIndex& number) {
    const std::uint64_t mixed = static_cast<std::uint64_t>(number.x) * 0x9e3779b97f4a7c15U +
                                static_cast<std::uint64_t>(number.y) * 0xc2b2ae3d27d4eb4fU +
                                static_cast<std::uint64_t>(number.z) * 0x165667b19e3779f9U;
    return (mixed ^ mixed >> 32) * 0x9e3779b97f4a7c15U >> (64 - kBoxBits);
  }

  void list(std::uint32_t ray, const VoxelPlace& place, std::uint64_t cubes) {
    VoxelKeys& bricks = crossed_.bricks;
    if (bricks.runs.empty() || bricks.runs.back().block != place.block) {
      bricks.runs.push_back({place.block, bricks.keys.size()});
    }
    bricks.keys.push_back(place.key);
    bricks.runs.back().end = bricks.keys.size();
    crossed_.cubes.push_back(cubes);
    crossed_.rays.push_back(ray);
  }

  CrossedCubes& crossed_;
  std::unique_ptr<Box[], Free> boxes_;
  Box* box_ = nullptr;  // the latest, of a brick
  std::int64_t x_ = 0;
  std::int64_t y_ = 0;
  std::int64_t z_ = 0;
};

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

/// The position along a minor axis where the ray leaves each slab, in fixed point.
struct Minor {
  std::int64_t at;      // where the ray enters the slab
  std::int64_t leaves;  // where it leaves it
  std::int64_t step;    // from slab to slab
  std::int64_t ahead;   // -1 if it goes up, 0 if down
  double speed;         // |step|
  std::int32_t low, high, to;

  Minor(const Path& path, std::size_t axis, double per_slab, double to_first_face) {
    const double start = path.from[axis] + path.fraction[axis];
    const double slope = path.way[axis] * per_slab;
    at = static_cast<std::int64_t>(start * kOne);
    leaves = static_cast<std::int64_t>((start + slope * to_first_face) * kOne);
    step = static_cast<std::int64_t>(slope * kOne);
    if (start + slope * to_first_face < 0.0) leaves--;  // down, not towards 0
    ahead = slope > 0.0 ? -1 : 0;
    speed = std::abs(slope);
    to = path.to[axis];
    low = std::min(path.from[axis], to);
    high = std::max(path.from[axis], to);
  }
  [[nodiscard]] bool is_between(std::int64_t position) const {
    return position >> 32 >= low && position >> 32 <= high;
  }
  /// Whether rounding takes the ray past its end, or back, before the last of `slabs`.
  [[nodiscard]] bool stays_between(std::int32_t slabs) const {
    return slabs == 0 || (is_between(leaves) && is_between(leaves + (slabs - 1) * step));
  }
  void next_slab() {
    at = leaves;
    leaves += step;
  }
  /// Distance to the next face, in the direction of the ray.
  [[nodiscard]] double to_face() const { return static_cast<double>((at ^ ahead) & 0xffffffff); }
};

/// Goes along a ray whose main axis is A.
template <std::size_t A>
void cross(const Path& path, std::uint32_t ray, Bricks& bricks) {
  constexpr std::size_t B = (A + 1) % 3, C = (A + 2) % 3;
  const std::int32_t direction = path.way[A] < 0.0 ? -1 : 1;
  const double to_first_face = direction > 0 ? 1.0 - path.fraction[A] : path.fraction[A];
  const double length = std::abs(path.way[A]);
  const double per_slab = length > 0.0 ? 1.0 / length : 0.0;
  Minor u(path, B, per_slab, to_first_face), v(path, C, per_slab, to_first_face);
  const std::int32_t slabs = std::abs(path.to[A] - path.from[A]);
  const bool is_exact = u.stays_between(slabs) && v.stays_between(slabs);

  std::array<std::int32_t, 3> brick{path.from[0] >> 2, path.from[1] >> 2, path.from[2] >> 2};
  std::uint64_t mask = 0;
  const auto list = [&] {
    bricks.add(ray, path.brick.x + brick[0], path.brick.y + brick[1], path.brick.z + brick[2], mask);
    mask = 0;
  };
  const auto shift = [](std::int32_t b, std::int32_t c) { return (b & 3) << 2 * B | (c & 3) << 2 * C; };
  const auto first_bit = [](std::int32_t a) { return std::uint64_t{1} << ((a & 3) << 2 * A); };
  const auto cube_of = [&](const Minor& minor) {
    const auto cube = static_cast<std::int32_t>(minor.leaves >> 32);
    return is_exact ? cube : std::clamp(cube, minor.low, minor.high);
  };

  std::int32_t a = path.from[A], b = path.from[B], c = path.from[C];
  std::uint64_t bit = first_bit(a);
  mask = bit << shift(b, c);
  for (std::int32_t left = slabs;; left--) {
    const std::int32_t next_b = left == 0 ? u.to : cube_of(u);
    const std::int32_t next_c = left == 0 ? v.to : cube_of(v);
    // Where both change, the nearer face first: a cube in between.
    std::int32_t middle_b = next_b, middle_c = next_c;
    if (b != next_b && c != next_c) {
      const bool b_first = u.to_face() * v.speed < v.to_face() * u.speed;
      (b_first ? middle_c : middle_b) = b_first ? c : b;
    }
    if ((((b ^ next_b) | (c ^ next_c)) >> 2) == 0) {
      mask |= bit << shift(middle_b, middle_c) | bit << shift(next_b, next_c);
    } else {
      for (const auto& [to_b, to_c] : {std::pair(middle_b, middle_c), std::pair(next_b, next_c)}) {
        if (to_b >> 2 != brick[B] || to_c >> 2 != brick[C]) list();
        brick[B] = to_b >> 2;
        brick[C] = to_c >> 2;
        mask |= bit << shift(to_b, to_c);
      }
    }
    if (left == 0) break;
    b = next_b;
    c = next_c;
    u.next_slab();
    v.next_slab();
    a += direction;
    if (a >> 2 != brick[A]) {
      list();
      brick[A] = a >> 2;
    }
    bit = first_bit(a);
    mask |= bit << shift(b, c);
  }
  list();
}

}  // namespace

CrossedCubes crossed_cubes(std::span<const Eigen::Vector3d> starts, std::span<const Eigen::Vector3d> ends,
                           Metres width, std::size_t most_bricks) {
  assert(starts.size() == ends.size() && width.value > 0.0);
  CrossedCubes crossed;
  Bricks bricks(crossed);
  for (; crossed.done < ends.size() && crossed.cubes.size() < most_bricks; crossed.done++) {
    const Path path = path_of(starts[crossed.done], ends[crossed.done], width.value);
    const auto ray = static_cast<std::uint32_t>(crossed.done);
    const std::array<double, 3> size{std::abs(path.way[0]), std::abs(path.way[1]), std::abs(path.way[2])};
    if (size[0] >= size[1] && size[0] >= size[2])
      cross<0>(path, ray, bricks);
    else if (size[1] >= size[2])
      cross<1>(path, ray, bricks);
    else
      cross<2>(path, ray, bricks);
  }
  return crossed;
}

}  // namespace ray
