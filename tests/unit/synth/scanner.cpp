// Where scanners look.
#include "small_scene.h"

#include <raycloud/synth/scanner.h>

#include <gtest/gtest.h>

#include <array>
#include <set>

namespace ray {
namespace {

using namespace test;

TEST(ScanPlan, TimesGrowAndCoverThePathWhateverTheCount) {
  const Trajectory path = small_scene().path;
  for (const std::uint64_t count : {1u, 100u, 30'000u}) {
    const ScanPlan plan(SpinningScanner{}, path, count);
    double last = -1.0;
    for (std::uint64_t i = 0; i < count; ++i) {
      const Shot shot = plan.shot(i);
      ASSERT_GT(shot.time, last);
      ASSERT_NEAR(shot.direction.norm(), 1.0, 1e-12);
      ASSERT_EQ(shot.origin, position_at(path, spot_at(path, shot.time)));
      last = shot.time;
    }
    EXPECT_GE(last, 20.0 * (1.0 - 1.0 / static_cast<double>(count)) - 1e-9);
    EXPECT_LT(last, 20.0);
  }
}

TEST(ScanPlan, HintsDoNotChangeAShot) {
  const Trajectory path = small_scene().path;
  const ScanPlan plan(SpinningScanner{}, path, 1000);
  for (std::uint64_t i = 0; i < 1000; ++i) {
    for (const std::size_t hint : {std::size_t{0}, plan.node(i), std::size_t{4}}) {
      ASSERT_EQ(plan.shot(i, hint).origin, plan.shot(i).origin);
      ASSERT_EQ(plan.shot(i, hint).direction, plan.shot(i).direction);
    }
  }
}

/// The share of the shots that each of 6 × 8 parts of the sphere of equal solid angle gets, times 48.
std::array<double, 48> spread(const ScanPlan& plan) {
  std::array<double, 48> parts{};
  for (std::uint64_t i = 0; i < plan.count(); ++i) {
    const Eigen::Vector3d d = plan.shot(i).direction;
    const int band = std::min(5, static_cast<int>((d.z() + 1.0) * 3.0));
    const double turn = std::atan2(d.y(), d.x()) / 6.283185307179586 + 0.5;
    const int sector = std::min(7, static_cast<int>(turn * 8.0));
    parts[static_cast<std::size_t>(band * 8 + sector)] += 48.0 / static_cast<double>(plan.count());
  }
  return parts;
}

TEST(ScanPlan, ASpinningScannerSeesAllAroundEvenInASparseScan) {
  for (const int beams : {16, 32, 64, 128}) {
    for (const std::uint64_t count : {20'000u, 200'000u}) {
      for (const double share : spread(ScanPlan({.beams = beams}, small_scene().path, count))) {
        EXPECT_GT(share, 0.4) << beams << " " << count;
        EXPECT_LT(share, 2.5) << beams << " " << count;
      }
    }
  }
}

TEST(ScanPlan, OnAPathOfOneNodeItLooksAllAround) {
  Trajectory path;
  path.times = {5.0};
  path.positions = {{1, 2, 3}};
  const ScanPlan plan(SpinningScanner{}, path, 100'000);
  EXPECT_EQ(plan.shot(77'000).time, 5.0);
  for (const double share : spread(plan))
    EXPECT_GT(share, 0.4);
}

TEST(ScanPlan, AStandingScannerVisitsEachStationOnceAndSparesItsTripod) {
  const Scene scene = small_scene();
  const ScanPlan plan(StandingScanner{}, scene.path, scene.stations, 100'000);
  std::size_t changes = 0;
  for (std::uint64_t i = 0; i < plan.count(); ++i) {
    const Shot shot = plan.shot(i);
    if (i > 0 && shot.origin != plan.shot(i - 1).origin) ++changes;
    ASSERT_LT(-shot.direction.z(), std::cos(29.9 / 180.0 * 3.14159265358979));
  }
  EXPECT_EQ(changes, 2u);
  EXPECT_EQ(plan.shot(0).origin, scene.stations[0]);
  EXPECT_EQ(plan.shot(99'999).origin, scene.stations[2]);
}

TEST(ScanPlan, ARasterHasNeitherGapsNorTwins) {
  const Scene scene = small_scene();
  const ScanPlan plan(StandingScanner{}, scene.path, {scene.stations[0]}, 20'000);
  // Every direction above the tripod has a shot within a step and a half of the raster's.
  std::set<std::array<double, 3>> directions;
  for (std::uint64_t i = 0; i < plan.count(); ++i) {
    const Eigen::Vector3d d = plan.shot(i).direction;
    EXPECT_TRUE(directions.insert({d.x(), d.y(), d.z()}).second);
  }
  const double step = std::sqrt(150.0 * 360.0 / 20'000.0) / 57.3;
  for (double z = -0.85; z < 1.0; z += 0.1) {
    for (double azimuth = 0.0; azimuth < 6.28; azimuth += 0.2) {
      const double across = std::sqrt(1.0 - z * z);
      const Eigen::Vector3d wanted(across * std::cos(azimuth), across * std::sin(azimuth), z);
      double nearest = 9.0;
      for (const auto& [x, y, w] : directions)
        nearest = std::min(nearest, (Eigen::Vector3d(x, y, w) - wanted).norm());
      EXPECT_LT(nearest, 1.5 * step);
    }
  }
}

}  // namespace
}  // namespace ray
