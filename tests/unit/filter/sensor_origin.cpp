#include "support/random_cloud.h"

#include <raycloud/core/error.h>
#include <raycloud/filter/sensor_origin.h>
#include <raycloud/filter/sensor_path.h>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <map>
#include <set>

namespace ray {
namespace {

Trajectory straight(std::vector<double> times) {
  Trajectory path;
  for (const double time : times)
    path.positions.emplace_back(10.0 * time, 1.0, 2.0);
  path.times = std::move(times);
  return path;
}

RayCloud points_at(std::vector<double> times) {
  RayCloud rays;
  rays.resize(times.size());
  for (std::size_t i = 0; i < times.size(); ++i)
    rays.starts[i] = rays.ends[i] = {0.5, 0.25, -3.0};
  rays.times = std::move(times);
  return rays;
}

TEST(sensor_origin, fixed_constant_and_own) {
  RayCloud rays = points_at({1, 2});
  OriginStep(FixedSensor{{7, 8, 9}})(rays);
  EXPECT_EQ(rays.starts[1], Eigen::Vector3d(7, 8, 9));
  OriginStep(OwnOrigins{})(rays);
  EXPECT_EQ(rays.starts[1], Eigen::Vector3d(7, 8, 9));
  OriginStep(ConstantRay{{0, 0, -100}})(rays);
  EXPECT_EQ(rays.starts[0], Eigen::Vector3d(0.5, 0.25, 97.0));
  EXPECT_EQ(rays.ends[0], Eigen::Vector3d(0.5, 0.25, -3.0));
}

TEST(sensor_origin, rays_outside_by_more_than_a_spacing_are_dropped_and_counted_and_never_extrapolated) {
  RayCloud rays = points_at({-1.5, -0.5, 0.5, 3.5, 4.5, 9.0});
  const OriginCounts counts = OriginStep(MovingSensor{.trajectory = straight({0, 1, 2, 3})})(rays);
  EXPECT_EQ(counts.before, 1u);
  EXPECT_EQ(counts.after, 2u);
  EXPECT_EQ(rays.times, (std::vector<double>{-0.5, 0.5, 3.5}));
  EXPECT_EQ(rays.starts[0].x(), 0.0);
  EXPECT_EQ(rays.starts[1].x(), 5.0);
  EXPECT_EQ(rays.starts[2].x(), 30.0);
}

TEST(sensor_origin, clamped_rays_start_at_the_ends) {
  RayCloud rays = points_at({-5, 9});
  const auto counts = OriginStep(MovingSensor{.trajectory = straight({0, 1}), .clamp = true})(rays);
  EXPECT_EQ(counts.before + counts.after, 2u);
  ASSERT_EQ(rays.size(), 2u);
  EXPECT_EQ(rays.starts[0].x(), 0.0);
  EXPECT_EQ(rays.starts[1].x(), 10.0);
}

TEST(sensor_origin, one_node_places_points_of_its_time_only) {
  RayCloud rays = points_at({1.0, 1.0000001});
  const auto counts = OriginStep(MovingSensor{.trajectory = straight({1.0})})(rays);
  EXPECT_EQ(counts.after, 1u);
  EXPECT_EQ(rays.size(), 1u);
}

TEST(sensor_origin, gaps_that_hold_rays_are_counted) {
  RayCloud rays = points_at({0.5, 3.0, 20.0, 52.0});
  const auto counts = OriginStep(MovingSensor{.trajectory = straight({0, 1, 2, 3, 50, 51, 52})})(rays);
  EXPECT_EQ(counts.in_gaps, 1u);
  EXPECT_EQ(counts.longest_gap, 47.0);
}

TEST(sensor_origin, the_lever_arm_turns_with_the_sensor) {
  const auto yaw = [](double a) {
    return Eigen::Quaterniond(Eigen::AngleAxisd(a, Eigen::Vector3d::UnitZ()));
  };
  Trajectory path = straight({0, 2});
  path.orientations = {yaw(0.0), yaw(3.0)};
  RayCloud rays = points_at({1.0});
  OriginStep(MovingSensor{.trajectory = path, .lever_arm = Eigen::Vector3d(2, 0, 1)})(rays);
  const Eigen::Vector3d expected(10.0 + 2.0 * std::cos(1.5), 1.0 + 2.0 * std::sin(1.5), 3.0);
  EXPECT_LT((rays.starts[0] - expected).norm(), 1e-12);
  path.orientations.clear();
  EXPECT_THROW(OriginStep(MovingSensor{.trajectory = path, .lever_arm = Eigen::Vector3d::Zero()}), Error);
  EXPECT_THROW(OriginStep(MovingSensor{}), Error);
}

TEST(sensor_path, needs_a_positive_spacing) {
  EXPECT_THROW(SensorPath(0.0), Error);
  EXPECT_THROW(SensorPath(-1.0), Error);
  EXPECT_TRUE(SensorPath(0.1).trajectory().empty());
}

// Nodes are rays; every slot that has rays is represented; order and chunks do not matter.
RC_GTEST_PROP(sensor_path, keeps_the_earliest_ray_of_every_slot_and_the_last_of_all, ()) {
  const auto count = *rc::gen::inRange<std::size_t>(1, 200);
  RayCloud rays = points_at(*rc::gen::container<std::vector<double>>(
      count, rc::gen::map(rc::gen::inRange(-3000, 3000), [](int t) { return t * 0.007; })));
  for (std::size_t i = 0; i < count; ++i)
    rays.starts[i].x() = 3.0 * rays.times[i];
  SensorPath path(0.5);
  path.add(rays);
  const Trajectory found = path.trajectory();

  std::map<double, double> earliest;
  for (const double t : rays.times) {
    const auto slot = earliest.try_emplace(std::floor(t / 0.5), t).first;
    slot->second = std::min(slot->second, t);
  }
  std::set<double> expected{*std::max_element(rays.times.begin(), rays.times.end())};
  for (const auto& [slot, time] : earliest)
    expected.insert(time);
  RC_ASSERT(found.times == std::vector<double>(expected.begin(), expected.end()));
  for (std::size_t i = 0; i < found.size(); ++i)
    RC_ASSERT(found.positions[i].x() == 3.0 * found.times[i]);
}

// The law of export and import: what moves in straight lines at the nodes' scale comes back.
RC_GTEST_PROP(sensor_path, importing_with_it_returns_the_origins_to_the_sampling_error, ()) {
  const double spacing = *rc::gen::element(0.01, 0.1, 1.0);
  RayCloud rays = points_at({});
  rays.resize(500);
  const auto place = [](double t) {
    return Eigen::Vector3d(20.0 * std::cos(0.1 * t), 20.0 * std::sin(0.1 * t), 0.0);
  };
  for (std::size_t i = 0; i < rays.size(); ++i) {
    rays.times[i] = 0.013 * static_cast<double>(i);
    rays.starts[i] = place(rays.times[i]);
  }
  SensorPath path(spacing);
  path.add(rays);
  RayCloud back = rays;
  for (auto& start : back.starts)
    start.setZero();
  const auto counts = OriginStep(MovingSensor{.trajectory = path.trajectory()})(back);
  RC_ASSERT(counts.before + counts.after == 0u);
  RC_ASSERT(back.times == rays.times);
  const double gap = 2.0 * std::max(spacing, 0.013);
  const double sampling_error = 0.2 * gap * gap / 8.0 + 1e-12;  // acceleration 20 · 0.1² = 0.2 m/s²
  for (std::size_t i = 0; i < rays.size(); ++i)
    RC_ASSERT((back.starts[i] - rays.starts[i]).norm() <= sampling_error);
}

}  // namespace
}  // namespace ray
