#include "support/random_cloud.h"

#include <raycloud/core/lanes.h>
#include <raycloud/core/memory_stream.h>
#include <raycloud/filter/smooth.h>

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

namespace ray {
namespace {

double gaussian(const RandomStream& random, std::uint64_t i, std::uint64_t draw) {
  return std::sqrt(-2.0 * std::log(1.0 - random.uniform(i, draw))) *
         std::cos(2.0 * std::numbers::pi * random.uniform(i, draw + 1));
}

struct Sample {
  Eigen::Vector3d point;
  Eigen::Vector3d sensor;
};

/// Rays that end at points of a surface but for noise along them.
RayCloud scan(std::size_t rays, double noise,
              const std::function<Sample(const RandomStream&, std::size_t)>& sample) {
  const RandomStream random(11, "smoothing");
  RayCloud cloud;
  cloud.resize(rays);
  for (std::size_t i = 0; i < rays; ++i) {
    const Sample at = sample(random, i);
    cloud.starts[i] = at.sensor;
    cloud.ends[i] = at.point + noise * gaussian(random, i, 100) * (at.sensor - at.point).normalized();
    cloud.times[i] = static_cast<double>(i);
    cloud.bounded[i] = 1;
  }
  return cloud;
}

RayCloud smoothed(const RayCloud& cloud, const Context& context = {}, std::size_t chunk = 1000) {
  MemorySource source(cloud, chunk);
  MemorySink sink(source.info().extras);
  const StreamCounts counts = smooth_rays(context, source, sink);
  EXPECT_EQ(counts.rays_out, cloud.size());
  return sink.cloud();
}

struct Errors {
  double mean = 0.0;
  double rms = 0.0;
};

Errors errors(const RayCloud& cloud, const std::function<double(const Eigen::Vector3d&)>& height,
              const std::function<bool(const Eigen::Vector3d&)>& counts) {
  double sum = 0.0, sum2 = 0.0, n = 0.0;
  for (const Eigen::Vector3d& end : cloud.ends) {
    if (!counts(end)) continue;
    const double h = height(end);
    sum += h;
    sum2 += h * h;
    n += 1.0;
  }
  return {sum / n, std::sqrt(sum2 / n)};
}

TEST(SmoothRays, APlaneLosesItsNoise) {
  const RayCloud cloud = scan(20000, 0.02, [](const RandomStream& random, std::size_t i) {
    return Sample{{7.0 * random.uniform(i, 0), 7.0 * random.uniform(i, 1), 0.0}, {3.5, 3.5, 3.0}};
  });
  const auto height = [](const Eigen::Vector3d& p) { return p.z(); };
  const auto inside = [](const Eigen::Vector3d& p) {
    return p.x() > 0.5 && p.x() < 6.5 && p.y() > 0.5 && p.y() < 6.5;
  };
  const double before = errors(cloud, height, inside).rms;
  EXPECT_GT(before / errors(smoothed(cloud), height, inside).rms, 4.5);
}

TEST(SmoothRays, ATrunkKeepsItsRadius) {
  const RayCloud cloud = scan(27000, 0.01, [](const RandomStream& random, std::size_t i) {
    const double angle = 2.0 * std::numbers::pi * random.uniform(i, 0), z = 20.0 * random.uniform(i, 1);
    const Eigen::Vector3d out(std::cos(angle), std::sin(angle), 0.0);
    return Sample{0.2 * out + Eigen::Vector3d(0.0, 0.0, z), 5.0 * out + Eigen::Vector3d(0.0, 0.0, z)};
  });
  const auto height = [](const Eigen::Vector3d& p) { return p.head<2>().norm() - 0.2; };
  const auto all = [](const Eigen::Vector3d&) { return true; };
  const Errors after = errors(smoothed(cloud), height, all);
  EXPECT_LT(std::abs(after.mean), 0.001);
  EXPECT_LT(after.rms, 0.01 / 3.0);
}

TEST(SmoothRays, TheSidesOfAThinWallStayApart) {
  const auto side_of = [](std::size_t i) { return i % 2 == 0 ? 1.0 : -1.0; };
  const RayCloud cloud = scan(40000, 0.01, [&](const RandomStream& random, std::size_t i) {
    return Sample{{7.0 * random.uniform(i, 0), 7.0 * random.uniform(i, 1), 0.03 * side_of(i)},
                  {3.5, 3.5, 3.0 * side_of(i)}};
  });
  const RayCloud after = smoothed(cloud);
  std::size_t wrong = 0;
  double before2 = 0.0, after2 = 0.0;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    before2 += std::pow(cloud.ends[i].z() - 0.03 * side_of(i), 2);
    after2 += std::pow(after.ends[i].z() - 0.03 * side_of(i), 2);
    wrong += after.ends[i].z() * side_of(i) < 0.0 ? 1 : 0;
  }
  EXPECT_LT(wrong, cloud.size() / 200);
  EXPECT_GT(std::sqrt(before2 / after2), 2.5);
}

TEST(SmoothRays, StartsAndTheRestStay) {
  const RayCloud cloud = test::random_cloud(5, {.rays = 3000, .extras = test::schema_of_every_type()});
  RayCloud after = smoothed(cloud);
  for (std::size_t i = 0; i < cloud.size(); ++i)
    EXPECT_TRUE(cloud.bounded[i] != 0 || after.ends[i] == cloud.ends[i]);
  after.ends = cloud.ends;
  EXPECT_TRUE(test::same_bits(after, cloud));
}

TEST(SmoothRays, SameBytesForAnyThreadsChunksMemoryAndLanes) {
  const RayCloud cloud = scan(8000, 0.02, [](const RandomStream& random, std::size_t i) {
    const double x = 30.0 * random.uniform(i, 0);
    return Sample{{x, 2.0 * random.uniform(i, 1), i % 3 == 0 ? 0.06 : 0.3 * std::sin(x)},
                  {15.0, 1.0, i % 3 == 0 ? -5.0 : 5.0}};
  });
  const RayCloud expected = smoothed(cloud, {.threads = 1});
  for (const unsigned threads : {2U, 3U, 8U})
    EXPECT_TRUE(test::same_bits(smoothed(cloud, {.threads = threads}, 7), expected));
  for (const std::size_t memory : {1000000UL, 100000UL})
    EXPECT_TRUE(test::same_bits(smoothed(cloud, {.threads = 2, .memory = memory}), expected));
  for (const LaneSet most : {LaneSet::kPlain, LaneSet::kAvx2}) {
    const FewerLanes fewer(most);
    EXPECT_TRUE(test::same_bits(smoothed(cloud, {}), expected));
  }
}

TEST(SmoothRays, OddCloudsStayAsTheyAre) {
  RayCloud cloud;
  EXPECT_TRUE(smoothed(cloud).empty());
  cloud.resize(3);
  cloud.starts.assign(3, {0.0, 0.0, 1.0});
  cloud.ends = {{0.0, 0.0, 0.0}, {1.0, 0.0, 0.1}, {0.0, 1.0, -0.1}};
  cloud.times.assign(3, 0.0);
  cloud.bounded = {1, 1, 0};
  EXPECT_TRUE(test::same_bits(smoothed(cloud), cloud));
  RayCloud same;  // all in one place
  same.resize(1000);
  same.starts.assign(1000, {0.0, 0.0, 1.0});
  same.ends.assign(1000, {5.0, 5.0, 5.0});
  same.times.assign(1000, 0.0);
  same.bounded.assign(1000, 1);
  EXPECT_TRUE(test::same_bits(smoothed(same), same));
}

}  // namespace
}  // namespace ray
