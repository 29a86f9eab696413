#include "scene.h"
#include "support/random_cloud.h"

#include <raycloud/render/height_colour.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>

namespace ray {
namespace {

using namespace test;

/// The length of the segment from a to b inside a closed rectangle, by clipping it at each side.
double clipped_length(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& low,
                      const Eigen::Vector2d& high) {
  double from = 0.0, to = 1.0;
  for (int axis = 0; axis < 2; axis++) {
    const double step = b[axis] - a[axis];
    if (step == 0.0) {
      // On an edge it belongs to the pixel above, as points do.
      if (a[axis] < low[axis] || a[axis] >= high[axis]) return 0.0;
      continue;
    }
    const double t0 = (low[axis] - a[axis]) / step, t1 = (high[axis] - a[axis]) / step;
    from = std::max(from, std::min(t0, t1));
    to = std::min(to, std::max(t0, t1));
  }
  return std::max(0.0, to - from) * (b - a).norm();
}

Bounds bounds_of(const RayCloud& cloud, View view) {
  Bounds bounds;
  for (const auto* points : {&cloud.starts, &cloud.ends}) {
    for (const Eigen::Vector3d& point : *points)
      bounds.add(seen_from(view, point));
  }
  return bounds;
}

double projected_length(const RayCloud& cloud, View view) {
  double total = 0.0;
  for (std::size_t i = 0; i < cloud.size(); i++) {
    total += (seen_from(view, cloud.ends[i]) - seen_from(view, cloud.starts[i])).head<2>().norm();
  }
  return total;
}

double sum_of(const FloatImage& image) {
  double total = 0.0;
  for (const FloatPixel& p : image.pixels)
    total += static_cast<double>(p.green);
  return total;
}

RC_GTEST_PROP(RenderRays, AddsUpTheLengthOfEveryRayInEveryPixel, ()) {
  const RayCloud cloud = random_cloud(
      *rc::gen::arbitrary<std::uint64_t>(),
      {.rays = *rc::gen::inRange<std::size_t>(1, 60),
       .centre = *rc::gen::element(Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(500000, 6900000, 100))});
  const RenderOptions options{.view = *rc::gen::elementOf(kViews),
                              .style = RenderStyle::rays,
                              .resolution = *rc::gen::element<std::size_t>(1, 2, 15, 16, 17, 40)};
  MemorySource source(cloud, 16);
  const ValueRendering out = render_values({.threads = 2}, source, options);
  const Bounds bounds = bounds_of(cloud, options.view);
  const double width = out.pixel_width.value;
  for (std::size_t row = 0; row < out.image.height; row++) {
    for (std::size_t column = 0; column < out.image.width; column++) {
      const Eigen::Vector2d low =
          bounds.min.head<2>() + width * Eigen::Vector2d(static_cast<double>(column),
                                                         static_cast<double>(out.image.height - 1 - row));
      double expected = 0.0;
      for (std::size_t i = 0; i < cloud.size(); i++) {
        expected += clipped_length(seen_from(options.view, cloud.starts[i]).head<2>(),
                                   seen_from(options.view, cloud.ends[i]).head<2>(), low,
                                   low + Eigen::Vector2d(width, width));
      }
      const double value = static_cast<double>(out.image.pixels[row * out.image.width + column].red);
      RC_ASSERT(std::abs(value - expected) <=
                1e-5 * width * static_cast<double>(cloud.size()) + 1e-6 * expected);
    }
  }
}

RC_GTEST_PROP(RenderRays, ThePixelsAddUpToTheProjectedLengths, ()) {
  // Long and narrow as well, so that the raster is cut into bands either way.
  RayCloud cloud = random_cloud(*rc::gen::arbitrary<std::uint64_t>(), {.rays = 300});
  const Eigen::Vector3d scale(*rc::gen::element(0.0, 0.01, 1.0, 30.0),
                              *rc::gen::element(0.0, 0.01, 1.0, 30.0), *rc::gen::element(0.01, 1.0));
  for (auto* points : {&cloud.starts, &cloud.ends}) {
    for (Eigen::Vector3d& point : *points)
      point = point.cwiseProduct(scale);
  }
  const RenderOptions options{.view = *rc::gen::elementOf(kViews),
                              .style = RenderStyle::rays,
                              .resolution = *rc::gen::element<std::size_t>(1, 100, 1500)};
  const double length = projected_length(cloud, options.view);
  RC_ASSERT(std::abs(sum_of(values_of(cloud, options, 2)) - length) <= 1e-5 * length);
}

RayCloud one_ray(const Eigen::Vector3d& start, const Eigen::Vector3d& end, bool bounded) {
  RayCloud cloud = cloud_of({{end, kRed, bounded}});
  cloud.starts[0] = start;
  return cloud;
}

TEST(RenderRays, ASlantedRayHasItsLengthInThePixelsItCrosses) {
  for (const bool bounded : {true, false}) {
    const RayCloud cloud = one_ray({10, 20, 5}, {13, 24, 9}, bounded);
    const FloatImage image = values_of(cloud, {.style = RenderStyle::rays, .pixel_width = Metres{1.0}});
    ASSERT_EQ(image.width, 3U);
    ASSERT_EQ(image.height, 4U);
    EXPECT_NEAR(sum_of(image), 5.0, 1e-5);
    // 4/3 up for one to the right: from the bottom left 1.25 m in the first pixel, 1.25 · (4/3 − 1) in the
    // next.
    EXPECT_NEAR(image.pixels[3 * 3 + 0].red, 1.25, 1e-5);
    EXPECT_NEAR(image.pixels[2 * 3 + 0].red, 1.25 / 3, 1e-5);
    EXPECT_NEAR(image.pixels[2 * 3 + 1].red, 1.25 * 2 / 3, 1e-5);
    EXPECT_EQ(image.pixels[3 * 3 + 1].red, 0.0F);
    EXPECT_EQ(image.pixels[0].red, 0.0F);
  }
}

TEST(RenderRays, StraightRaysFillWholePixels) {
  const auto lengths = [](const Eigen::Vector3d& end) {
    return values_of(one_ray({0, 0, 0}, end, true), {.style = RenderStyle::rays, .pixel_width = Metres{0.5}});
  };
  for (const FloatImage& image : {lengths({50, 0, 0}), lengths({0, 50, 0}), lengths({-50, 0, 3})}) {
    ASSERT_EQ(image.pixels.size(), 100U);
    for (const FloatPixel& p : image.pixels)
      EXPECT_NEAR(p.red, 0.5, 1e-6);
  }
  const FloatImage diagonal = lengths({-20, 20, 1});
  for (std::size_t i = 0; i < 40; i++)
    EXPECT_NEAR(diagonal.pixels[i * 40 + i].red, std::sqrt(0.5), 1e-6);
}

TEST(RenderRays, ARayTowardsTheViewerHasNoLength) {
  const RayCloud cloud = one_ray({1, 2, 3}, {1, 2, 30}, true);
  const Image image = rendered(cloud, {.style = RenderStyle::rays}).image;
  EXPECT_THAT(image.pixels, testing::ElementsAre(kNothing));
}

TEST(RenderRays, MoreRaysAreBrighter) {
  // i rays along each row i of ten.
  RayCloud cloud;
  for (int row = 1; row <= 10; row++) {
    for (int i = 0; i < 1 << row; i++)
      cloud.append(one_ray({0, row * 1.0, 0}, {9.9, row * 1.0, 0}, i % 2 == 0));
  }
  const Rendering out = rendered(cloud, {.style = RenderStyle::rays, .pixel_width = Metres{1.0}});
  ASSERT_EQ(out.image.height, 9U);  // the far edge belongs to the last row
  ASSERT_TRUE(out.shown);
  EXPECT_NEAR(out.shown->darkest, 1.8, 0.2);
  EXPECT_NEAR(out.shown->brightest, 512 + 1024, 20.0);
  const auto lightness = [&](std::size_t row) {
    const Pixel& p = pixel(out.image, 4, row);
    return 2 * p.red + 7 * p.green + p.blue;
  };
  for (std::size_t row = 1; row < 9; row++)
    EXPECT_GT(lightness(row - 1), lightness(row)) << row;
  EXPECT_EQ(pixel(out.image, 4, 0), height_colour(1.0));
  EXPECT_EQ(out.counts.rays_out, cloud.size());
}

}  // namespace
}  // namespace ray
