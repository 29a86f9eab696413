#include <raycloud/exec/random.h>
#include <raycloud/exec/space_cuts.h>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <limits>
#include <numeric>

namespace ray {
namespace {

/// Spread evenly, on a coarse lattice (many twice), in one place, or along a line.
std::vector<Eigen::Vector3d> points_to_cut(std::size_t count) {
  const RandomStream random(*rc::gen::arbitrary<std::uint64_t>(), "points to cut");
  const auto kind = *rc::gen::inRange(0, 4);
  const Eigen::Vector3d origin =
      *rc::gen::element(Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(5e5, -6.9e6, 100));
  std::vector<Eigen::Vector3d> points(count);
  for (std::size_t i = 0; i < count; ++i) {
    Eigen::Vector3d p(random.uniform(i, 0), random.uniform(i, 1), random.uniform(i, 2));
    if (kind == 1) p = (p * 3.0).array().floor();
    if (kind == 2) p.setOnes();
    if (kind == 3) p = {p.x(), 0.0, 0.0};
    points[i] = origin + p;
  }
  return points;
}

RC_GTEST_PROP(SpaceCuts, PartsNearHoldEveryPointWithinReach, ()) {
  const std::vector<Eigen::Vector3d> points = points_to_cut(*rc::gen::inRange<std::size_t>(1, 200));
  const auto sampled = *rc::gen::inRange<std::size_t>(0, points.size() + 1);
  const auto parts = *rc::gen::inRange<std::size_t>(0, 70);
  const SpaceCuts cuts({points.begin(), points.begin() + static_cast<std::ptrdiff_t>(sampled)}, parts);
  RC_ASSERT(cuts.parts() >= (sampled == 0 ? 1 : parts));
  RC_ASSERT(cuts.parts() <= std::max<std::size_t>(2 * parts, 1));
  const double reach = *rc::gen::element(0.0, 1e-9, 0.1, 1.0, 100.0, std::numeric_limits<double>::infinity());
  std::vector<std::uint32_t> near;
  for (const Eigen::Vector3d& point : points) {
    RC_ASSERT(cuts.part_of(point) < cuts.parts());
    cuts.parts_near(point, reach, near);
    RC_ASSERT(std::adjacent_find(near.begin(), near.end(), std::greater_equal<>()) == near.end());
    for (const Eigen::Vector3d& other : points)
      if ((other - point).norm() <= reach)
        RC_ASSERT(std::binary_search(near.begin(), near.end(), cuts.part_of(other)));
  }
}

RC_GTEST_PROP(SpaceCuts, ThePartOfAPointIsTheOneWhoseBoxHoldsIt, ()) {
  const std::vector<Eigen::Vector3d> points = points_to_cut(*rc::gen::inRange<std::size_t>(1, 200));
  const SpaceCuts cuts(points, *rc::gen::inRange<std::size_t>(0, 70));
  for (const Eigen::Vector3d& point : points) {
    std::size_t holding = 0;
    for (std::size_t part = 0; part < cuts.parts(); ++part) {
      const Eigen::AlignedBox3d box = cuts.box_of(part);
      const bool inside =
          (point.array() >= box.min().array()).all() && (point.array() < box.max().array()).all();
      RC_ASSERT(!inside || part == cuts.part_of(point));
      holding += inside ? 1 : 0;
    }
    RC_ASSERT(holding == 1U);
  }
}

TEST(SpaceCuts, PointsExactlyAtReachAcrossACut) {
  // Each pair is as far apart as the reach, by numbers that are rounded: 0.1 has no end in binary.
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i < 64; ++i)
    points.emplace_back(1e6 + 0.1 * i, 0, 0);
  const SpaceCuts cuts(points, 64);
  std::vector<std::uint32_t> near;
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    const double reach = points[i + 1].x() - points[i].x();
    cuts.parts_near(points[i], reach, near);
    EXPECT_TRUE(std::binary_search(near.begin(), near.end(), cuts.part_of(points[i + 1])));
    cuts.parts_near(points[i + 1], reach, near);
    EXPECT_TRUE(std::binary_search(near.begin(), near.end(), cuts.part_of(points[i])));
  }
}

TEST(SpaceCuts, PartsHoldAboutAsManyPointsEach) {
  const RandomStream random(1, "even parts");
  std::vector<Eigen::Vector3d> points(6400);
  for (std::size_t i = 0; i < points.size(); ++i)
    points[i] = {random.uniform(i, 0), 9.0 * random.uniform(i, 1) * random.uniform(i, 2), 0.0};
  const SpaceCuts cuts(points, 64);
  ASSERT_EQ(cuts.parts(), 64U);
  std::vector<int> counts(64);
  for (const Eigen::Vector3d& point : points)
    ++counts[cuts.part_of(point)];
  for (const int count : counts)
    EXPECT_EQ(count, 100);
  std::vector<std::uint32_t> near;
  cuts.parts_near(points[0], 0.001, near);
  EXPECT_LE(near.size(), 8U);
}

}  // namespace
}  // namespace ray
