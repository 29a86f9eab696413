#include <raycloud/exec/random.h>
#include <raycloud/spatial/point_spacing.h>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <Eigen/Geometry>
#include <vector>

namespace ray {
namespace {

std::vector<Eigen::Vector3d> tilted_grid(const RandomStream& random, double spacing, int side) {
  const Eigen::Vector3d axis(random.uniform(0) - 0.5, random.uniform(1) - 0.5, random.uniform(2) - 0.5);
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(6.0 * random.uniform(3), axis.normalized()).matrix();
  std::vector<Eigen::Vector3d> points;
  for (int x = 0; x < side; x++) {
    for (int y = 0; y < side; y++)
      points.push_back(turn * Eigen::Vector3d(x * spacing, y * spacing, 0.0));
  }
  return points;
}

RC_GTEST_PROP(EstimateSpacing, OfAGridOnAPlaneIsItsSpacing, ()) {
  const RandomStream random(*rc::gen::arbitrary<std::uint64_t>(), "spacing");
  const double spacing = *rc::gen::element(0.01, 0.037, 0.5);
  const auto points = tilted_grid(random, spacing, *rc::gen::inRange(60, 200));
  const double estimate = estimate_spacing(points, points.size()).value;
  RC_ASSERT(estimate > spacing / 1.5);
  RC_ASSERT(estimate < spacing * 1.5);
}

TEST(EstimateSpacing, OfASampleIsThatOfTheWhole) {
  const auto points = tilted_grid(RandomStream(3, "spacing"), 0.1, 300);
  std::vector<Eigen::Vector3d> tenth;
  for (std::size_t i = 0; i < points.size(); i++) {
    if (RandomStream(4, "tenth").below(10, i) == 0) tenth.push_back(points[i]);
  }
  EXPECT_NEAR(estimate_spacing(tenth, points.size()).value, 0.1, 0.05);
}

TEST(EstimateSpacing, ScalesWithTheCloudAndIgnoresItsPlace) {
  auto points = tilted_grid(RandomStream(5, "spacing"), 0.25, 100);
  const double before = estimate_spacing(points, points.size()).value;
  for (Eigen::Vector3d& point : points)
    point *= 4.0;
  EXPECT_DOUBLE_EQ(estimate_spacing(points, points.size()).value, 4.0 * before);
  for (Eigen::Vector3d& point : points)
    point += Eigen::Vector3d(500000.0, 6900000.0, 100.0);
  EXPECT_NEAR(estimate_spacing(points, points.size()).value, 4.0 * before, 0.05 * before);
}

TEST(EstimateSpacing, IsUnknownWhereThereIsNoSurface) {
  EXPECT_EQ(estimate_spacing({}, 0).value, 0.0);
  const std::vector<Eigen::Vector3d> one_place(1000, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(estimate_spacing(one_place, 1000).value, 0.0);
}

TEST(EstimateSpacing, EndsForPlacesFarApart) {
  std::vector<Eigen::Vector3d> two_places(1000, Eigen::Vector3d(1, 2, 3));
  two_places.resize(2000, Eigen::Vector3d(1e6, 2, 3));
  EXPECT_GT(estimate_spacing(two_places, 2000).value, 0.0);
}

}  // namespace
}  // namespace ray
