#include <raycloud/exec/random.h>
#include <raycloud/spatial/nearest_point.h>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <limits>

namespace ray {
namespace {

constexpr double kNone = std::numeric_limits<double>::infinity();

/// Clustered for a power above 1; on a grid of tenths, so with equal points and distances, for a power of 0.
std::vector<SeenPoint> points_near(const Eigen::Vector3d& origin, std::size_t count, int power,
                                   std::uint64_t seed) {
  const RandomStream random(seed, "points");
  std::vector<SeenPoint> points(count);
  for (std::size_t i = 0; i < count; ++i)
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      const double uniform = 2.0 * random.uniform(i, static_cast<std::uint64_t>(axis)) - 1.0;
      points[i].end[axis] =
          origin[axis] + (power == 0 ? std::round(5.0 * uniform) / 10.0 : std::pow(uniform, power));
    }
  return points;
}

double by_all_pairs(const std::vector<SeenPoint>& points, const Eigen::Vector3d& from, double within2) {
  double nearest2 = kNone;
  for (const SeenPoint& point : points) {
    const Eigen::Vector3d d = point.end - from;
    nearest2 = std::min(nearest2, d.x() * d.x() + d.y() * d.y() + d.z() * d.z());
  }
  return nearest2 <= within2 ? nearest2 : kNone;
}

RC_GTEST_PROP(NearestPoint, IsThatOfAllPairs, ()) {
  const Eigen::Vector3d origin =
      *rc::gen::element(Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(5e5, 6.9e6, 100.0));
  const int power = *rc::gen::element(0, 1, 5);
  const auto seed = *rc::gen::arbitrary<std::uint64_t>();
  const auto points = points_near(origin, *rc::gen::inRange<std::size_t>(0, 500), power, seed);
  const auto others = points_near(origin, 100, *rc::gen::element(0, 1, 5), seed + 1);
  const double within = *rc::gen::element(0.0, 0.1, 0.2, 0.5, 100.0);
  const PointTree tree({}, points);
  NearestPoint nearest(tree);
  for (const auto* from : {&others, &points})
    for (const SeenPoint& point : *from)
      RC_ASSERT(nearest.distance2(point.end, within * within) ==
                by_all_pairs(points, point.end, within * within));
}

TEST(NearestPoint, FindsWhatIsExactlyAtTheDistance) {
  const std::vector<SeenPoint> points{{{0.1, 0.0, 0.0}, {}}, {{7.0, 0.0, 0.0}, {}}};
  const PointTree tree({}, points);
  NearestPoint nearest(tree);
  EXPECT_EQ(nearest.distance2({0, 0, 0}, 0.1 * 0.1), 0.1 * 0.1);
  EXPECT_EQ(nearest.distance2({0, 0, 0}, std::nextafter(0.1 * 0.1, 0.0)), kNone);
  EXPECT_EQ(nearest.distance2({7, 0, 0}, 0.0), 0.0);
}

}  // namespace
}  // namespace ray
