#include "support/random_cloud.h"

#include <raycloud/core/error.h>
#include <raycloud/core/memory_stream.h>
#include <raycloud/filter/denoise.h>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <limits>

namespace ray {
namespace {

using test::random_cloud;
using test::same_bits;

RayCloud denoised(const RayCloud& cloud, const Noise& noise, unsigned threads = 1,
                  std::size_t chunk_rays = 100) {
  MemorySource source(cloud, chunk_rays);
  MemorySink sink(source.info().extras);
  const Denoised done = remove_noise(Context{.threads = threads}, source, sink, noise);
  EXPECT_EQ(done.counts.rays_in, cloud.size());
  EXPECT_EQ(done.counts.rays_out, sink.cloud().size());
  return sink.cloud();
}

/// By looking at all pairs.
RayCloud without_far(const RayCloud& cloud, double distance, unsigned min_neighbours) {
  std::vector<std::uint8_t> mask(cloud.size(), 1);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (cloud.bounded[i] == 0) continue;
    unsigned near = 0;
    for (std::size_t j = 0; j < cloud.size(); ++j) {
      if (i == j || cloud.bounded[j] == 0) continue;
      const double dx = cloud.ends[i].x() - cloud.ends[j].x(), dy = cloud.ends[i].y() - cloud.ends[j].y(),
                   dz = cloud.ends[i].z() - cloud.ends[j].z();
      if (dx * dx + dy * dy + dz * dz <= distance * distance) ++near;
    }
    mask[i] = near >= min_neighbours ? 1 : 0;
  }
  RayCloud rest = cloud;
  rest.select(mask);
  return rest;
}

void expect_oracle(const RayCloud& cloud, double distance, unsigned min_neighbours) {
  const RayCloud expected = without_far(cloud, distance, min_neighbours);
  const Noise noise = FarFromOthers{{distance}, min_neighbours};
  for (const unsigned threads : {1U, 2U, 3U, 8U})
    for (const std::size_t chunk : {1UL, 7UL, 1000000UL})
      ASSERT_TRUE(same_bits(denoised(cloud, noise, threads, chunk), expected))
          << distance << " m, " << min_neighbours << " neighbours, " << cloud.size() << " rays";
}

Eigen::Vector3d somewhere(std::uint64_t kind) {
  if (kind == 0) return {0, 0, 0};
  return kind == 1 ? Eigen::Vector3d(500000.25, 6900000.5, 123.4) : Eigen::Vector3d(-3e6, 2.0, -1e7);
}

RC_GTEST_PROP(FarFromOthers, AsByLookingAtAllPairs, ()) {
  const auto seed = *rc::gen::arbitrary<std::uint64_t>();
  const RandomStream random(seed, "far");
  const double distance = std::pow(10.0, 5.0 * random.uniform(0) - 3.0);  // 1 mm to 100 m
  const auto min_neighbours = *rc::gen::inRange(1U, 6U);
  RayCloud cloud = random_cloud(seed, {.rays = *rc::gen::inRange<std::size_t>(0, 300),
                                       .centre = somewhere(random.below(3, 1)),
                                       .half_extent = distance * (0.5 + 5.0 * random.uniform(2)),
                                       .extras = test::schema_of_every_type()});
  // Clusters, doubles, and neighbours at exactly the distance along an axis.
  for (std::size_t i = 1; i < cloud.size(); ++i) {
    const std::uint64_t kind = random.below(8, i, 10);
    const Eigen::Vector3d other = cloud.ends[random.below(i, i, 11)];
    if (kind == 0) cloud.ends[i] = other;
    if (kind == 1) cloud.ends[i] = other + 0.1 * (cloud.ends[i] - other);
    if (kind == 2) cloud.ends[i] = other + distance * Eigen::Vector3d::Unit(static_cast<int>(i % 3));
    if (kind == 3)  // on a lattice of the distance itself
      cloud.ends[i] = (cloud.ends[i] / distance).array().round() * distance;
  }
  if (cloud.size() > 10 && random.below(4, 3) == 0) cloud.ends[5] = {1e7, 0, 0};
  expect_oracle(cloud, distance, min_neighbours);
}

TEST(FarFromOthers, ExactlyAtTheDistanceIsNear) {
  RayCloud cloud = random_cloud(1, {.rays = 2});
  cloud.bounded = {1, 1};
  cloud.ends = {{1, 2, 3}, {1.5, 2, 3}};
  EXPECT_EQ(denoised(cloud, FarFromOthers{{0.5}, 1}).size(), 2U);
  EXPECT_EQ(denoised(cloud, FarFromOthers{{std::nextafter(0.5, 0.0)}, 1}).size(), 0U);
}

TEST(FarFromOthers, UnboundedRaysStayAndCountForNobody) {
  RayCloud cloud = random_cloud(1, {.rays = 3});
  cloud.ends = {{1, 2, 3}, {1, 2, 3}, {1, 2, 3}};
  cloud.bounded = {0, 1, 0};
  EXPECT_EQ(denoised(cloud, FarFromOthers{{0.5}, 1}).bounded, (std::vector<std::uint8_t>{0, 0}));
  cloud.bounded = {0, 0, 0};
  EXPECT_TRUE(same_bits(denoised(cloud, FarFromOthers{{0.5}, 1}), cloud));
}

TEST(FarFromOthers, ManyIdenticalPointsInNoTime) {
  RayCloud cloud = random_cloud(1, {.rays = 300000});
  std::fill(cloud.ends.begin(), cloud.ends.end(), Eigen::Vector3d(500000.1, 6900000.2, 3.0));
  std::fill(cloud.bounded.begin(), cloud.bounded.end(), std::uint8_t{1});
  cloud.ends[7] = {500000.1, 6900000.2, 3.03};  // beside all of them, but alone in its cell
  EXPECT_EQ(denoised(cloud, FarFromOthers{{0.04}, 5}, 2, 100000).size(), cloud.size());
  EXPECT_EQ(denoised(cloud, FarFromOthers{{0.02}, 5}, 2, 100000).size(), cloud.size() - 1);
}

TEST(FarFromOthers, FewPoints) {
  EXPECT_EQ(denoised(RayCloud{}, FarFromOthers{{0.04}, 1}).size(), 0U);
  RayCloud one = random_cloud(1, {.rays = 1});
  one.bounded = {1};
  EXPECT_EQ(denoised(one, FarFromOthers{{0.04}, 1}).size(), 0U);
  EXPECT_EQ(denoised(one, FarFromOthers{{0.04}, 0}).size(), 1U);
}

TEST(RemoveNoise, RefusesWhatIsNotAboveZero) {
  const RayCloud cloud = random_cloud(1, {.rays = 3});
  for (const double bad : {0.0, -1.0, std::numeric_limits<double>::infinity(), std::nan("")}) {
    EXPECT_THROW(denoised(cloud, FarFromOthers{{bad}, 1}), Error) << bad;
    EXPECT_THROW(denoised(cloud, OnRangeEdges{{bad}}), Error) << bad;
    EXPECT_THROW(denoised(cloud, OutsideNeighbours{bad}), Error) << bad;
  }
  EXPECT_THROW(denoised(cloud, FarFromOthers{{1e-12}, 1}), Error) << "cells beyond counting";
}

}  // namespace
}  // namespace ray
