#include <raycloud/core/error.h>
#include <raycloud/exec/random.h>
#include <raycloud/spatial/crossed_cubes.h>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <vector>

namespace ray {
namespace {

constexpr std::size_t kAll = std::numeric_limits<std::size_t>::max();
using Cubes = std::set<VoxelIndex>;

/// Recovers which brick a key stands for from all bricks that it may be.
class BrickOf {
 public:
  BrickOf(const Eigen::Vector3d& a, const Eigen::Vector3d& b, double width) {
    const VoxelIndex from = voxel_index(a.cwiseMin(b), {width}), to = voxel_index(a.cwiseMax(b), {width});
    for (auto x = from.x >> 2; x <= to.x >> 2; x++)
      for (auto y = from.y >> 2; y <= to.y >> 2; y++)
        for (auto z = from.z >> 2; z <= to.z >> 2; z++) {
          const VoxelPlace place = voxel_place({x, y, z});
          bricks_[{place.block, place.key}] = {x, y, z};
        }
  }
  [[nodiscard]] const VoxelIndex& operator()(const VoxelIndex& block, std::uint64_t key) const {
    return bricks_.at({block, key});
  }

 private:
  std::map<std::pair<VoxelIndex, std::uint64_t>, VoxelIndex> bricks_;
};

Cubes cubes_of(const Eigen::Vector3d& start, const Eigen::Vector3d& end, double width) {
  const CrossedCubes crossed = crossed_cubes({&start, 1}, {&end, 1}, {width}, kAll);
  EXPECT_EQ(crossed.done, 1U);
  const BrickOf brick_of(start, end, width);
  Cubes cubes;
  std::size_t i = 0;
  for (const VoxelKeys::Run& run : crossed.bricks.runs) {
    for (; i < run.end; i++) {
      const VoxelIndex brick = brick_of(run.block, crossed.bricks.keys[i]);
      for (int bit = 0; bit < 64; bit++) {
        if ((crossed.cubes[i] >> bit & 1) == 0) continue;
        cubes.insert({4 * brick.x + (bit & 3), 4 * brick.y + (bit >> 2 & 3), 4 * brick.z + (bit >> 4)});
      }
    }
  }
  return cubes;
}

/// Whether the segment meets the cube made larger by `margin` widths on each side.
bool meets(const Eigen::Vector3d& start, const Eigen::Vector3d& end, const VoxelIndex& cube, double width,
           double margin) {
  const Eigen::Vector3d low =
      Eigen::Vector3d(static_cast<double>(cube.x), static_cast<double>(cube.y), static_cast<double>(cube.z));
  double from = 0.0, to = 1.0;
  for (int axis = 0; axis < 3; axis++) {
    const double p = start[axis] / width, d = end[axis] / width - p;
    const double a = low[axis] - margin, b = low[axis] + 1.0 + margin;
    if (d == 0.0) {
      if (p < a || p > b) return false;
      continue;
    }
    from = std::max(from, std::min((a - p) / d, (b - p) / d));
    to = std::min(to, std::max((a - p) / d, (b - p) / d));
  }
  return from <= to;
}

struct Ray {
  Eigen::Vector3d start, end;
};

Ray random_ray(const RandomStream& random, std::uint64_t i) {
  const Eigen::Vector3d centre = std::array<Eigen::Vector3d, 3>{
      Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(500000, 6900000, 30),
      Eigen::Vector3d(209715.2, -209715.2, 209715.2)}[random.below(3, i, 0)];  // a corner of blocks
  Ray ray;
  const double extent = std::array<double, 4>{0.01, 0.3, 2.0, 8.0}[random.below(4, i, 1)];
  for (int axis = 0; axis < 3; axis++) {
    const auto draw = static_cast<std::uint64_t>(2 + 3 * axis);
    const auto coordinate = [&](std::uint64_t d) {
      const double value = centre[axis] + extent * (2.0 * random.uniform(i, d) - 1.0);
      return random.below(6, i, 40 + d) == 0 ? std::round(value / 0.1) * 0.1 : value;  // on a face
    };
    ray.start[axis] = coordinate(draw);
    ray.end[axis] = random.below(8, i, draw + 1) == 0 ? ray.start[axis] : coordinate(draw + 2);
  }
  return ray;
}

RC_GTEST_PROP(CrossedCubes, AreThoseThatTheSegmentMeets, ()) {
  const double width = 0.1;
  const Ray ray = random_ray(RandomStream(*rc::gen::arbitrary<std::uint64_t>(), "rays"), 0);
  const Cubes cubes = cubes_of(ray.start, ray.end, width);
  const VoxelIndex first = voxel_index(ray.start, {width}), last = voxel_index(ray.end, {width});
  RC_ASSERT(cubes.count(first) == 1U);
  RC_ASSERT(cubes.count(last) == 1U);
  // Face by face: as many cubes as faces, and one.
  RC_ASSERT(cubes.size() ==
            1U + static_cast<std::size_t>(std::abs(last.x - first.x) + std::abs(last.y - first.y) +
                                          std::abs(last.z - first.z)));
  const double far = ray.end.cwiseAbs().maxCoeff() / width;
  const double margin = 1e-7 + 4e-16 * far;
  for (const VoxelIndex& cube : cubes)
    RC_ASSERT(meets(ray.start, ray.end, cube, width, margin));
  // And no cube that the ray goes well into is missing.
  for (int sample = 0; sample <= 2000; sample++) {
    const Eigen::Vector3d p = ray.start + sample / 2000.0 * (ray.end - ray.start);
    const Eigen::Array3d q = p.array() / width;
    if (((q - q.round()).abs() < 10.0 * margin).any()) continue;
    RC_ASSERT(cubes.count(voxel_index(p, {width})) == 1U);
  }
}

TEST(CrossedCubes, AnUnmovedRayIsInOneCube) {
  EXPECT_EQ(cubes_of({0.25, -0.25, 7.0}, {0.25, -0.25, 7.0}, 0.5), (Cubes{{0, -1, 14}}));
}

TEST(CrossedCubes, AlongAnAxisAndOnItsFaces) {
  EXPECT_EQ(cubes_of({0.0, 0.0, 0.0}, {3.0, 0.0, 0.0}, 1.0),
            (Cubes{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}}));
  EXPECT_EQ(cubes_of({-0.5, 0.0, 5.0}, {-3.5, 0.0, 5.0}, 1.0),
            (Cubes{{-1, 0, 5}, {-2, 0, 5}, {-3, 0, 5}, {-4, 0, 5}}));
}

/// The first ray through a cube is told, whatever was listed before.
RC_GTEST_PROP(CrossedCubes, OfManyRaysTellTheFirstOfEachCube, ()) {
  const RandomStream random(*rc::gen::arbitrary<std::uint64_t>(), "fan");
  const double width = 0.25;
  std::vector<Eigen::Vector3d> starts, ends;
  for (std::uint64_t i = 0; i < 60; i++) {
    starts.emplace_back(0.1, 0.1, 0.1);
    ends.emplace_back(5.0 * random.uniform(i, 0), 3.0 * random.uniform(i, 1), 2.0 * random.uniform(i, 2));
  }
  std::vector<std::uint8_t> expected;
  Cubes seen;
  for (std::size_t i = 0; i < ends.size(); i++) {
    const std::size_t before = seen.size();
    seen.merge(cubes_of(starts[i], ends[i], width));
    expected.push_back(seen.size() > before ? 1 : 0);
  }
  for (const std::size_t most : {std::size_t{1}, std::size_t{30}, kAll}) {
    std::vector<std::uint8_t> kept(ends.size());
    std::map<std::uint64_t, std::uint64_t> known;
    for (std::size_t done = 0; done < ends.size();) {
      const CrossedCubes crossed =
          crossed_cubes(std::span(starts).subspan(done), std::span(ends).subspan(done), {width}, most);
      for (std::size_t k = 0; k < crossed.cubes.size(); k++) {
        std::uint64_t& cubes = known[crossed.bricks.keys[k]];
        if ((crossed.cubes[k] & ~cubes) != 0) kept[done + crossed.rays[k]] = 1;
        cubes |= crossed.cubes[k];
      }
      RC_ASSERT(crossed.done > 0U);
      done += crossed.done;
    }
    RC_ASSERT(kept == expected);
  }
}

TEST(CrossedCubes, RefuseRaysOfTooManyCubes) {
  const Eigen::Vector3d start(0, 0, 0), end(2e9, 0, 0);
  EXPECT_THROW(static_cast<void>(crossed_cubes({&start, 1}, {&end, 1}, {1.0}, kAll)), Error);
  const Eigen::Vector3d farther(1e300, 0, 0);
  EXPECT_THROW(static_cast<void>(crossed_cubes({&start, 1}, {&farther, 1}, {1.0}, kAll)), Error);
}

}  // namespace
}  // namespace ray
