#include "support/random_cloud.h"

#include <raycloud/core/lanes.h>
#include <raycloud/core/memory_stream.h>
#include <raycloud/filter/denoise.h>

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace ray {
namespace {

double normal_deviate(const RandomStream& random, std::uint64_t i, std::uint64_t draw) {
  return std::sqrt(-2.0 * std::log(1.0 - random.uniform(i, draw))) *
         std::cos(2.0 * std::numbers::pi * random.uniform(i, draw + 1));
}

/// A floor seen from above it, with 1 cm of noise.
RayCloud noisy_floor(std::size_t rays, double noise = 0.01) {
  const RandomStream random(17, "floor");
  RayCloud cloud;
  cloud.resize(rays);
  for (std::size_t i = 0; i < rays; ++i) {
    cloud.starts[i] = {5.0, 5.0, 3.0};
    cloud.ends[i] = {10.0 * random.uniform(i, 0), 10.0 * random.uniform(i, 1),
                     noise * normal_deviate(random, i, 2)};
    cloud.times[i] = static_cast<double>(i);
    cloud.bounded[i] = 1;
  }
  return cloud;
}

RayCloud without_outliers(const RayCloud& cloud, double sigmas, const Context& context = {},
                          std::size_t chunk = 1000) {
  MemorySource source(cloud, chunk);
  MemorySink sink(source.info().extras);
  static_cast<void>(remove_noise(context, source, sink, OutsideNeighbours{sigmas}));
  return sink.cloud();
}

/// The tails of the normal distribution beyond 1, 2 and 3 standard deviations, to a fifth, and a half at 3.
TEST(OutsideNeighbours, RemovesTheTailsOfGaussianNoise) {
  const RayCloud cloud = noisy_floor(60000);
  const auto removed = [&](double sigmas) {
    return 1.0 -
           static_cast<double>(without_outliers(cloud, sigmas).size()) / static_cast<double>(cloud.size());
  };
  EXPECT_NEAR(removed(1.0), 0.317, 0.06);
  EXPECT_NEAR(removed(2.0), 0.0455, 0.009);
  EXPECT_NEAR(removed(3.0), 0.0027, 0.0014);
}

TEST(OutsideNeighbours, PointsOffTheSurfaceGo) {
  RayCloud cloud = noisy_floor(30000);
  const RandomStream random(18, "outliers");
  for (std::size_t i = 0; i < cloud.size(); i += 100)
    cloud.ends[i].z() = 0.1 + 0.5 * random.uniform(i, 0);
  const RayCloud after = without_outliers(cloud, 3.0);
  std::size_t left = 0;
  for (std::size_t i = 0; i < after.size(); ++i)
    left += static_cast<std::size_t>(after.times[i]) % 100 == 0 ? 1 : 0;
  EXPECT_LT(left, 30U);  // of 300
  EXPECT_GT(after.size(), 30000U - 300U - 180U);
}

/// A ball of them, each with others all around: nearly every ray to the floor passes them.
TEST(OutsideNeighbours, DustInTheWayOfOtherRaysGoes) {
  RayCloud cloud = noisy_floor(60000);
  const RandomStream random(19, "dust");
  for (std::size_t i = 0; i < cloud.size(); i += 100)
    cloud.ends[i] =
        cloud.starts[i] + (cloud.ends[i] - cloud.starts[i]).normalized() * (0.3 + 2.0 * random.uniform(i, 0));
  const RayCloud after = without_outliers(cloud, 3.0);
  std::size_t left = 0;
  for (std::size_t i = 0; i < after.size(); ++i)
    left += static_cast<std::size_t>(after.times[i]) % 100 == 0 ? 1 : 0;
  EXPECT_LT(left, 120U);  // of 600
  EXPECT_GT(after.size(), 60000U - 600U - 360U);
}

/// Rays from one place into a raster of directions, 10 mrad apart: half of them meet a near wall, the others
/// one behind it. Every other ray along the edge of the near one meets both, and ends between (times below
/// 1).
RayCloud room_with_an_edge() {
  constexpr int kSide = 160;
  const RandomStream random(21, "edge");
  RayCloud cloud;
  cloud.resize(static_cast<std::size_t>(kSide) * kSide);
  for (int row = 0; row < kSide; ++row)
    for (int column = 0; column < kSide; ++column) {
      const auto i = static_cast<std::size_t>(row * kSide + column);
      const Eigen::Vector3d direction =
          Eigen::Vector3d(0.01 * (column - kSide / 2) + 0.005, 0.01 * (row - kSide / 2), 1.0).normalized();
      const bool mixed = column == kSide / 2 && row % 2 == 0;
      const double depth = mixed ? 2.2 + 1.6 * random.uniform(i, 0) : column < kSide / 2 ? 2.0 : 4.0;
      const double range = depth / direction.z() + 0.005 * normal_deviate(random, i, 1);
      cloud.starts[i].setZero();
      cloud.ends[i] = range * direction;
      cloud.times[i] = (mixed ? 0.0 : 1.0) + 1e-6 * static_cast<double>(i);
      cloud.bounded[i] = 1;
    }
  return cloud;
}

/// They lie on a line as seen from the sensor, as points of a wire do, and one sees all others from aside.
TEST(OutsideNeighbours, EndsBetweenTwoSurfacesGo) {
  const RayCloud after = without_outliers(room_with_an_edge(), 3.0);
  const auto left =
      std::count_if(after.times.begin(), after.times.end(), [](double time) { return time < 1.0; });
  EXPECT_LE(left, 16);  // of 80
  EXPECT_GT(after.size(), 25600U - 80U - 150U);
}

/// A floor of 12 m by 12 m, a wire over it in which every 8 cm is met, and dust (times from 1e6 and 2e6).
RayCloud floor_under_a_wire() {
  constexpr std::size_t kFloor = 40000, kWire = 150, kDust = 400;
  const RandomStream random(22, "wire");
  RayCloud cloud;
  cloud.resize(kFloor + kWire + kDust);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    cloud.starts[i] = {6.0, 4.0 + 0.5 * random.uniform(i, 9), 4.0};
    Eigen::Vector3d& end = cloud.ends[i];
    end = {12.0 * random.uniform(i, 0), 12.0 * random.uniform(i, 1), 0.0};
    cloud.times[i] = static_cast<double>(i);
    if (i >= kFloor && i < kFloor + kWire) {
      cloud.times[i] = 1e6 + static_cast<double>(i);
      end = {0.08 * (static_cast<double>(i - kFloor) + random.uniform(i, 2)),
             6.0 + 0.004 * random.uniform(i, 3), 1.5};
    }
    if (i >= kFloor + kWire) {
      cloud.times[i] = 2e6 + static_cast<double>(i);
      end = cloud.starts[i] + (0.3 + 0.5 * random.uniform(i, 4)) * (end - cloud.starts[i]);
    }
    end += 0.01 * normal_deviate(random, i, 7) * (end - cloud.starts[i]).normalized();
    cloud.bounded[i] = 1;
  }
  return cloud;
}

TEST(OutsideNeighbours, AWireStaysAndDustAroundItGoes) {
  const RayCloud after = without_outliers(floor_under_a_wire(), 3.0);
  const auto left = [&](double from, double to) {
    return std::count_if(after.times.begin(), after.times.end(),
                         [&](double time) { return time >= from && time < to; });
  };
  EXPECT_GE(left(1e6, 2e6), 145);  // of 150
  EXPECT_LE(left(2e6, 3e6), 40);   // of 400
  EXPECT_GE(left(0.0, 1e6), 40000 - 250);
}

TEST(OutsideNeighbours, WiresAndEdgesAreTheSameInAnyBlocks) {
  RayCloud cloud = floor_under_a_wire();
  cloud.append(room_with_an_edge());
  const RayCloud expected = without_outliers(cloud, 3.0, {.threads = 1});
  EXPECT_TRUE(
      test::same_bits(without_outliers(cloud, 3.0, {.threads = 3, .memory = 1500000}, 777), expected));
}

TEST(OutsideNeighbours, SameBytesForAnyThreadsChunksMemoryAndLanes) {
  RayCloud cloud = noisy_floor(20000, 0.05);
  for (std::size_t i = 0; i < cloud.size(); i += 7)
    cloud.ends[i].z() += 0.01 * static_cast<double>(i % 91);
  for (std::size_t i = 3; i < cloud.size(); i += 11)
    cloud.bounded[i] = 0;
  const RayCloud expected = without_outliers(cloud, 2.0, {.threads = 1});
  EXPECT_LT(expected.size(), cloud.size());
  for (const unsigned threads : {2U, 3U, 8U})
    EXPECT_TRUE(test::same_bits(without_outliers(cloud, 2.0, {.threads = threads}, 7), expected));
  for (const std::size_t memory : {1000000UL, 100000UL})
    EXPECT_TRUE(test::same_bits(without_outliers(cloud, 2.0, {.threads = 2, .memory = memory}), expected));
  for (const LaneSet most : {LaneSet::kPlain, LaneSet::kAvx2}) {
    const FewerLanes fewer(most);
    EXPECT_TRUE(test::same_bits(without_outliers(cloud, 2.0, {}), expected));
  }
}

TEST(OutsideNeighbours, AFarOutlierGoesAndOddCloudsStay) {
  RayCloud cloud = noisy_floor(5000, 0.001);
  cloud.ends[77] = {1e7, 0.0, 0.0};
  const RayCloud after = without_outliers(cloud, 4.0);
  EXPECT_TRUE(
      std::none_of(after.ends.begin(), after.ends.end(), [](const auto& end) { return end.x() > 100.0; }));
  EXPECT_GT(after.size(), 4950U);
  RayCloud few = noisy_floor(4);
  EXPECT_TRUE(test::same_bits(without_outliers(few, 1.0), few));
  RayCloud free = noisy_floor(100);
  free.bounded.assign(100, 0);
  EXPECT_TRUE(test::same_bits(without_outliers(free, 1.0), free));
}

}  // namespace
}  // namespace ray
