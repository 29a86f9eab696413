#include <raycloud/core/trajectory.h>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>

namespace ray {
namespace {

Trajectory random_path(std::size_t most) {
  Trajectory path;
  const auto count = *rc::gen::inRange<std::size_t>(1, most);
  double time = 0.25 * *rc::gen::inRange(-1000, 1000);
  for (std::size_t i = 0; i < count; ++i) {
    path.times.push_back(time);
    path.positions.push_back(Eigen::Vector3d(*rc::gen::inRange(-99, 99), *rc::gen::inRange(-99, 99), 0.5));
    time += 0.125 * *rc::gen::inRange(1, 40);
  }
  return path;
}

// The oracle: look at every segment.
Eigen::Vector3d slow_position(const Trajectory& path, double time) {
  if (time <= path.times.front()) return path.positions.front();
  for (std::size_t i = 0; i + 1 < path.size(); ++i) {
    if (time > path.times[i + 1]) continue;
    const double f = (time - path.times[i]) / (path.times[i + 1] - path.times[i]);
    return (1.0 - f) * path.positions[i] + f * path.positions[i + 1];
  }
  return path.positions.back();
}

RC_GTEST_PROP(trajectory, position_agrees_with_a_linear_search_whatever_the_hint, ()) {
  const Trajectory path = random_path(60);
  for (int i = 0; i < 50; ++i) {
    const double time = path.times.front() + 0.01 * *rc::gen::inRange(-500, 20000);
    const auto hint = *rc::gen::inRange<std::size_t>(0, 80);
    const Eigen::Vector3d position = position_at(path, spot_at(path, time, hint));
    RC_ASSERT((position - slow_position(path, time)).norm() < 1e-12);
  }
}

RC_GTEST_PROP(trajectory, nodes_are_met_exactly_and_nothing_lies_beyond_the_ends, ()) {
  const Trajectory path = random_path(30);
  for (std::size_t i = 0; i < path.size(); ++i)
    RC_ASSERT(position_at(path, spot_at(path, path.times[i], i / 2)) == path.positions[i]);
  RC_ASSERT(position_at(path, spot_at(path, path.times.front() - 1e9)) == path.positions.front());
  RC_ASSERT(position_at(path, spot_at(path, path.times.back() + 1e9)) == path.positions.back());
}

TEST(trajectory, orientation_turns_evenly_along_the_shorter_arc) {
  const auto yaw = [](double angle) {
    return Eigen::Quaterniond(Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()));
  };
  Eigen::Quaterniond end = yaw(1.2);
  end.coeffs() *= -1.0;  // the same rotation, on the far side of the sphere
  const Trajectory path{{0.0, 2.0}, {{0, 0, 0}, {0, 0, 0}}, {yaw(0.0), end}};
  EXPECT_NEAR(orientation_at(path, spot_at(path, 0.5)).angularDistance(yaw(0.3)), 0.0, 1e-7);
}

TEST(trajectory, node_spacing_is_the_median_gap) {
  EXPECT_EQ(node_spacing({}), 0.0);
  EXPECT_EQ(node_spacing({{5.0}, {{0, 0, 0}}, {}}), 0.0);
  Trajectory path{{0.0, 1.0, 2.0, 100.0}, {}, {}};
  path.positions.resize(4);
  EXPECT_EQ(node_spacing(path), 1.0);
}

}  // namespace
}  // namespace ray
