// Whether the share of the hits among hits and passes is the opacity of what is there.

#include <raycloud/exec/random.h>
#include <raycloud/volume/free_space.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace ray {
namespace {

constexpr double kFreePath = 6.0;  // m

/// Rays through a cube of 2 m, from 4 m before its middle, of which every piece is as likely to stop one.
RayCloud scan_of_haze(std::uint64_t seed, std::size_t rays) {
  constexpr double kBefore = 4.0, kLongest = 8.0;
  const RandomStream random(seed, "haze");
  RayCloud cloud;
  cloud.resize(rays);
  for (std::size_t i = 0; i < rays; ++i) {
    const auto coordinate = [&](std::uint64_t draw) { return 2.0 * random.uniform(i, draw) - 1.0; };
    const Eigen::Vector3d through(coordinate(0), coordinate(1), coordinate(2));
    const Eigen::Vector3d way = Eigen::Vector3d(coordinate(3), coordinate(4), coordinate(5)).normalized();
    const double range = -kFreePath * std::log(1.0 - random.uniform(i, 6));
    cloud.starts[i] = through - kBefore * way;
    cloud.ends[i] = cloud.starts[i] + std::min(range, kLongest) * way;
    cloud.times[i] = 0.001 * static_cast<double>(i);
    cloud.bounded[i] = range < kLongest ? 1 : 0;
  }
  return cloud;
}

/// The share of the rays which reach an ellipsoid that is to end in it.
double expected_opacity(const Ellipsoid& ellipsoid, const RayCloud& rays) {
  double sum = 0.0, count = 0.0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const Chord chord = chord_of(ellipsoid, rays.starts[i], rays.ends[i]);
    if (chord.miss2 > 1.0 || chord.enters <= 0.0 || chord.enters >= 1.0) continue;
    const double length = (chord.leaves - chord.enters) * (rays.ends[i] - rays.starts[i]).norm();
    sum += 1.0 - std::exp(-length / kFreePath);
    count += 1.0;
  }
  return sum / count;
}

TEST(Opacity, isTheAnalyticOne) {
  const RayCloud rays = scan_of_haze(1, 60'000);
  const RandomStream random(2, "places");
  std::vector<Ellipsoid> ellipsoids(50);
  for (std::size_t i = 0; i < ellipsoids.size(); ++i) {
    for (std::uint64_t axis = 0; axis < 3; ++axis) {
      const auto row = static_cast<Eigen::Index>(axis);
      ellipsoids[i].centre[row] = 1.4 * random.uniform(i, axis) - 0.7;
      const double semi = 0.1 + 0.2 * random.uniform(i, 3 + axis);
      ellipsoids[i].shape(row, row) = static_cast<double>(static_cast<float>(1.0 / (semi * semi)));
    }
  }
  EllipsoidTree tree({}, ellipsoids.size(), [&](std::size_t i) { return ellipsoids[i].centre; });
  for (std::size_t i = 0; i < ellipsoids.size(); ++i)
    tree.set(i, ellipsoids[i]);
  tree.close({});
  const TimeScale scale(rays.times.front(), rays.times.back());
  std::vector<Evidence> evidence(tree.size());
  HitTimes times(tree.size());
  times.add(tree, rays, scale);
  times.find_episodes({}, 0.0, evidence);
  add_passes(tree, rays, {}, scale, evidence);
  double found = 0.0, expected = 0.0;
  for (std::uint32_t slot = 0; slot < evidence.size(); ++slot) {
    const double hits = evidence[slot].hits;
    ASSERT_GT(hits + evidence[slot].crossings, 100.0);
    found += hits / (hits + evidence[slot].crossings);
    expected += expected_opacity(tree.at_slot(slot), rays);
  }
  EXPECT_NEAR(found, expected, 0.03 * expected);
}

}  // namespace
}  // namespace ray
