#include <raycloud/exec/random.h>
#include <raycloud/filter/origin_audit.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace ray {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

// Distance from `start` along `direction` to the first of a floor and many pillars (1 m wide boxes, 5 m
// apart).
double range_in_hall(const Eigen::Vector3d& start, const Eigen::Vector3d& direction) {
  double nearest = direction.z() < 0.0 ? std::min(-start.z() / direction.z(), 60.0) : 60.0;
  for (int i = -6; i <= 6; ++i)
    for (int j = -6; j <= 6; ++j) {
      const Eigen::Array2d low(5.0 * i + 2.0, 5.0 * j + 2.0);
      const Eigen::Array2d near_side = (low - start.head<2>().array()) / direction.head<2>().array();
      const Eigen::Array2d far_side = (low + 1.0 - start.head<2>().array()) / direction.head<2>().array();
      const double enter = near_side.min(far_side).maxCoeff();
      const double leave = near_side.max(far_side).minCoeff();
      if (enter > 0.0 && enter < leave && start.z() + enter * direction.z() < 4.0)
        nearest = std::min(nearest, enter);
    }
  return nearest;
}

// A sensor that goes straight through the hall at 1 m/s, scanning all round.
RayCloud hall(std::size_t count = 60000) {
  const RandomStream random(3, "hall");
  RayCloud rays;
  rays.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    const double time = 8.0 * static_cast<double>(i) / static_cast<double>(count);
    const double angle = 2.0 * std::numbers::pi * random.uniform(i, 0);
    const double rise = 0.7 * random.uniform(i, 1) - 0.5;
    const Eigen::Vector3d direction = Eigen::Vector3d(std::cos(angle), std::sin(angle), rise).normalized();
    rays.starts[i] = {-4.0 + time, 0.2 * time, 1.5};
    rays.ends[i] = rays.starts[i] + direction * range_in_hall(rays.starts[i], direction);
    rays.times[i] = time;
    rays.bounded[i] = 1;
  }
  return rays;
}

OriginFindings audit(const RayCloud& rays, const AuditOptions& options = {}) {
  OriginAudit audit;
  audit.add(rays);
  return audit.findings({}, options);
}

TEST(origin_audit, right_origins_are_not_suspected) {
  const OriginFindings found = audit(hall());
  EXPECT_THAT(found.findings, IsEmpty());
  EXPECT_NEAR(found.path_length, 8.0 * std::hypot(1.0, 0.2), 0.1);
  EXPECT_NEAR(found.median_speed, std::hypot(1.0, 0.2), 0.01);
  EXPECT_THAT(audit({}).findings, IsEmpty());
}

TEST(origin_audit, shifted_origins_are_told_with_the_way_back) {
  RayCloud rays = hall();
  for (auto& start : rays.starts)
    start.y() += 1.0;
  EXPECT_THAT(audit(rays).findings, Contains(HasSubstr("by 1 m along -y")));
}

TEST(origin_audit, a_wrong_clock_is_told) {
  RayCloud rays = hall();
  for (std::size_t i = 0; i < rays.size(); ++i)
    rays.starts[i] = {-4.0 + rays.times[i] + 2.9, 0.2 * (rays.times[i] + 2.9), 1.5};
  EXPECT_THAT(audit(rays).findings, Contains(HasSubstr("changing the clock by -2.9")));
}

TEST(origin_audit, one_origin_while_time_passes) {
  RayCloud rays = hall(1000);
  for (auto& start : rays.starts)
    start = rays.starts[0];
  EXPECT_THAT(audit(rays).findings, Contains(HasSubstr("all rays start at one point")));
  EXPECT_THAT(audit(rays, {.origins_by_request = true}).findings,
              ::testing::Not(Contains(HasSubstr("one point"))));
}

TEST(origin_audit, one_vector_for_all) {
  RayCloud rays = hall(100);
  for (std::size_t i = 0; i < rays.size(); ++i)
    rays.starts[i] = rays.ends[i] + Eigen::Vector3d(0, 0, 50);
  EXPECT_THAT(audit(rays).findings, ::testing::ElementsAre(HasSubstr("the same vector")));
  EXPECT_THAT(audit(rays, {.origins_by_request = true}).findings, IsEmpty());
}

TEST(origin_audit, rays_without_length_and_rays_too_long) {
  RayCloud rays = hall(1000);
  for (std::size_t i = 0; i < 100; ++i)
    rays.starts[i * 10] = rays.ends[i * 10];
  EXPECT_THAT(audit(rays).findings, Contains(HasSubstr("10.0 % of the rays have no length")));
  rays = hall(1000);
  for (std::size_t i = 0; i < 6; ++i)
    rays.ends[i * 100].x() += 1000.0;
  const OriginFindings found = audit(rays);
  EXPECT_NEAR(found.too_long, 0.006, 1e-9);
  EXPECT_THAT(found.findings, Contains(HasSubstr("0.60 % of the rays are longer")));
}

TEST(origin_audit, jumps_of_the_sensor_are_counted) {
  RayCloud rays = hall(4000);
  for (std::size_t i = 2000; i < 2100; ++i)
    rays.starts[i].x() += 30.0;
  const OriginFindings found = audit(rays);
  EXPECT_EQ(found.jumps, 2u);
  EXPECT_THAT(found.findings, Contains(HasSubstr("jumps 2 times, 30.")));
  EXPECT_EQ(audit(rays, {.real_times = false}).jumps, 0u);
}

TEST(origin_audit, neither_chunks_nor_threads_matter) {
  RayCloud rays = hall(5000);
  for (auto& start : rays.starts)
    start.y() += 1.0;
  const OriginFindings whole = audit(rays);
  OriginAudit parts;
  for (std::size_t begin = 0; begin < rays.size(); begin += 7) {
    RayCloud part;
    part.resize(std::min<std::size_t>(7, rays.size() - begin));
    for (std::size_t i = 0; i < part.size(); ++i) {
      part.starts[i] = rays.starts[begin + i];
      part.ends[i] = rays.ends[begin + i];
      part.times[i] = rays.times[begin + i];
      part.bounded[i] = rays.bounded[begin + i];
    }
    parts.add(part);
  }
  for (const unsigned threads : {1u, 2u, 8u}) {
    const OriginFindings found = parts.findings({.threads = threads});
    EXPECT_EQ(found.findings, whole.findings);
    EXPECT_EQ(found.through, whole.through);
    EXPECT_EQ(found.path_length, whole.path_length);
  }
}

}  // namespace
}  // namespace ray
