#include "seen_through.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <limits>

namespace ray {
namespace {

constexpr std::int64_t kBrickSide = 8;         // cubes of a brick
constexpr std::int64_t kMostBricks = 1 << 18;  // of an outlier's ray, the beginning will do

struct CubeRange {
  std::int64_t low, high;
};

/// Calls `visit(cube, in, out)` for the cubes along start + t · direction with t from `from` to `to`, and
/// between which t they are crossed; only those within the ranges, and `most` at most.
template <class Visit>
void each_cube(const Eigen::Vector3d& start, const Eigen::Vector3d& direction, double from, double to,
               double width, const std::array<CubeRange, 3>& ranges, std::int64_t most, const Visit& visit) {
  std::array<std::int64_t, 3> cube{}, step{};
  std::array<double, 3> next{}, each{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<Eigen::Index>(axis);
    const auto [low, high] = ranges[axis];
    const double at = std::floor((start[a] + from * direction[a]) / width);
    cube[axis] =
        static_cast<std::int64_t>(std::clamp(at, static_cast<double>(low), static_cast<double>(high)));
    if (direction[a] == 0.0) {
      next[axis] = each[axis] = std::numeric_limits<double>::infinity();
      continue;
    }
    step[axis] = direction[a] > 0.0 ? 1 : -1;
    each[axis] = width / std::abs(direction[a]);
    next[axis] =
        (static_cast<double>(cube[axis] + (step[axis] > 0 ? 1 : 0)) * width - start[a]) / direction[a];
  }
  for (double in = from; most > 0; --most) {
    const std::size_t axis = next[0] <= next[1] && next[0] <= next[2] ? 0 : next[1] <= next[2] ? 1 : 2;
    const double out = std::clamp(next[axis], in, to);
    visit(VoxelIndex{cube[0], cube[1], cube[2]}, in, out);
    if (next[axis] >= to) return;
    in = out;
    cube[axis] += step[axis];
    next[axis] += each[axis];
    if (cube[axis] < ranges[axis].low || cube[axis] > ranges[axis].high) return;
  }
}

std::int64_t brick_of(std::int64_t cube) {
  return cube >> 3;
}
std::size_t in_brick(std::int64_t cube) {
  return static_cast<std::size_t>(cube & (kBrickSide - 1));
}
std::uint64_t bit_of(const VoxelIndex& cube) {
  return std::uint64_t{1} << (in_brick(cube.x) + kBrickSide * in_brick(cube.y));
}

}  // namespace

/// The cubes that a ball touches, and their bricks, which are made where there are none.
template <class Visit>
void SeenThrough::each_cube_of_ball(const Eigen::Vector3d& point, const Visit& visit) {
  const double reach = radius_ * (1.0 + 1e-9);
  const Eigen::Vector3d corner = Eigen::Vector3d::Constant(reach);
  const VoxelIndex low = voxel_index(point - corner, {width_});
  const VoxelIndex high = voxel_index(point + corner, {width_});
  const auto apart = [&](double at, std::int64_t cube) {
    const double from = static_cast<double>(cube) * width_;
    return std::max({from - at, at - (from + width_), 0.0});
  };
  VoxelIndex cube;
  for (cube.z = low.z; cube.z <= high.z; ++cube.z)
    for (cube.y = low.y; cube.y <= high.y; ++cube.y)
      for (cube.x = low.x; cube.x <= high.x; ++cube.x) {
        const Eigen::Vector3d away(apart(point.x(), cube.x), apart(point.y(), cube.y),
                                   apart(point.z(), cube.z));
        if (away.squaredNorm() > reach * reach) continue;
        const VoxelPlace place = voxel_place({brick_of(cube.x), brick_of(cube.y), brick_of(cube.z)});
        const auto added = numbers_.block(place.block).add(place.key);
        if (added.is_new) {
          bricks_.emplace_back();
          numbers_of_bricks_.push_back({brick_of(cube.x), brick_of(cube.y), brick_of(cube.z)});
          *added.value = static_cast<std::uint32_t>(bricks_.size());
        }
        visit(Cube{*added.value - 1, in_brick(cube.z), bit_of(cube)});
      }
}

std::uint32_t SeenThrough::list_of(const Cube& cube) const {
  const Brick& brick = bricks_[cube.brick];
  return brick.first[cube.layer] +
         static_cast<std::uint32_t>(std::popcount(brick.cubes[cube.layer] & (cube.bit - 1)));
}

SeenThrough::SeenThrough(std::vector<Eigen::Vector3d> points, double radius)
    : points_(std::move(points)), passes_(points_.size()), radius_(radius), width_(2.0 * radius) {
  for (const Eigen::Vector3d& point : points_)
    each_cube_of_ball(point, [&](const Cube& cube) { bricks_[cube.brick].cubes[cube.layer] |= cube.bit; });
  mark_bricks();
  std::uint32_t lists = 0;
  for (Brick& brick : bricks_)
    for (std::size_t layer = 0; layer < brick.cubes.size(); ++layer) {
      brick.first[layer] = lists;
      lists += static_cast<std::uint32_t>(std::popcount(brick.cubes[layer]));
    }
  // The length of each list, then where it ends; filling it from behind leaves where it begins.
  list_begins_.resize(lists + 1);
  for (const Eigen::Vector3d& point : points_)
    each_cube_of_ball(point, [&](const Cube& cube) { ++list_begins_[list_of(cube)]; });
  std::uint32_t sum = 0;
  for (std::uint32_t& begin : list_begins_)
    begin = sum += begin;
  listed_.resize(sum);
  for (std::size_t i = 0; i < points_.size(); ++i)
    each_cube_of_ball(points_[i], [&](const Cube& cube) {
      listed_[--list_begins_[list_of(cube)]] = static_cast<std::uint32_t>(i);
    });
}

std::uint64_t SeenThrough::hash_of(const VoxelIndex& number) {
  std::uint64_t hash = static_cast<std::uint64_t>(number.x) * 0x9e3779b97f4a7c15 +
                       static_cast<std::uint64_t>(number.y) * 0xc2b2ae3d27d4eb4f +
                       static_cast<std::uint64_t>(number.z) * 0x165667b19e3779f9;
  hash ^= hash >> 32;
  hash *= 0xd6e8feb86659fd93;
  return hash >> 24;
}

/// Sixteen bits for each brick, so that most others are known to be empty by one look.
void SeenThrough::mark_bricks() {
  maybe_.resize(std::bit_ceil(bricks_.size() / 4 + 1));
  for (const VoxelIndex& number : numbers_of_bricks_) {
    const std::uint64_t hash = hash_of(number) & (64 * maybe_.size() - 1);
    maybe_[hash / 64] |= std::uint64_t{1} << (hash % 64);
  }
  numbers_of_bricks_ = std::vector<VoxelIndex>();
}

void SeenThrough::add(const Eigen::Vector3d& start, const Eigen::Vector3d& end, bool bounded) {
  if (points_.empty()) return;
  const double length = (end - start).norm();
  const double to = bounded ? length - radius_ : length;
  if (!(to > 0.0)) return;
  const Eigen::Vector3d direction = (end - start) / length;
  constexpr std::int64_t kFar = std::int64_t{1} << 58;
  const CubeRange all{-kFar, kFar};
  each_cube(start, direction, 0.0, to, kBrickSide * width_, {all, all, all}, kMostBricks,
            [&](const VoxelIndex& number, double in, double out) {
              visit_brick(number, start, direction, in, out);
            });
}

void SeenThrough::visit_brick(const VoxelIndex& number, const Eigen::Vector3d& start,
                              const Eigen::Vector3d& direction, double in, double out) {
  if (!may_have(number)) return;
  const VoxelPlace place = voxel_place(number);
  const KeyTable<std::uint32_t>* block = numbers_.find_block(place.block);
  const std::uint32_t* found = block == nullptr ? nullptr : block->find(place.key);
  if (found == nullptr) return;
  const Brick& brick = bricks_[*found - 1];
  const auto range = [](std::int64_t of_brick) {
    return CubeRange{kBrickSide * of_brick, kBrickSide * of_brick + kBrickSide - 1};
  };
  each_cube(start, direction, in, out, width_, {range(number.x), range(number.y), range(number.z)},
            4 * kBrickSide, [&](const VoxelIndex& cube, double enters, double leaves) {
              const std::size_t layer = in_brick(cube.z);
              const std::uint64_t bit = bit_of(cube);
              if ((brick.cubes[layer] & bit) == 0) return;
              const std::uint32_t list = list_of({*found - 1, layer, bit});
              for (std::uint32_t i = list_begins_[list]; i < list_begins_[list + 1]; ++i) {
                const std::uint32_t point = listed_[i];
                const Eigen::Vector3d offset = points_[point] - start;
                const double nearest = offset.dot(direction);  // is in one cube, so that each ray counts once
                if (nearest < enters || nearest >= leaves) continue;
                if (offset.squaredNorm() - nearest * nearest < radius_ * radius_)
                  std::atomic_ref(passes_[point]).fetch_add(1, std::memory_order_relaxed);
              }
            });
}

}  // namespace ray
