#include "scene.h"
#include "support/random_cloud.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace ray {
namespace {

using namespace test;

struct Sum {
  double red = 0, green = 0, blue = 0, count = 0;
};

/// By the pixel, from the top left.
std::map<std::size_t, Sum> sums_of(const RayCloud& cloud, const RenderFacts& facts, View view,
                                   std::size_t columns, std::size_t rows) {
  Bounds bounds;
  for (std::size_t i = 0; i < cloud.size(); i++) {
    if (cloud.bounded[i] != 0) bounds.add(seen_from(view, cloud.ends[i]));
  }
  std::map<std::size_t, Sum> sums;
  for (std::size_t i = 0; i < cloud.size(); i++) {
    if (cloud.bounded[i] == 0) continue;
    const Eigen::Vector3d p = seen_from(view, cloud.ends[i]) - bounds.min;
    const auto column = std::min(static_cast<std::size_t>(p.x() / facts.pixel_width.value), columns - 1);
    const auto row = std::min(static_cast<std::size_t>(p.y() / facts.pixel_width.value), rows - 1);
    Sum& sum = sums[(rows - 1 - row) * columns + column];
    sum.red += cloud.colours[i].red;
    sum.green += cloud.colours[i].green;
    sum.blue += cloud.colours[i].blue;
    sum.count++;
  }
  return sums;
}

RC_GTEST_PROP(RenderMean, IsTheMeanColourOfEveryPixel, ()) {
  const RayCloud cloud =
      random_cloud(*rc::gen::arbitrary<std::uint64_t>(), {.rays = *rc::gen::inRange<std::size_t>(30, 800)});
  const RenderOptions options{.view = *rc::gen::elementOf(kViews),
                              .style = RenderStyle::mean,
                              .resolution = *rc::gen::inRange<std::size_t>(1, 30)};
  const Rendering out = rendered(cloud, options);
  const FloatImage values = values_of(cloud, options);
  const auto sums = sums_of(cloud, out, options.view, out.image.width, out.image.height);
  for (std::size_t i = 0; i < out.image.pixels.size(); i++) {
    const auto at = sums.find(i);
    const Pixel& p = out.image.pixels[i];
    RC_ASSERT(p.alpha == (at == sums.end() ? 0 : 255));
    if (at == sums.end()) continue;
    const Sum& sum = at->second;
    RC_ASSERT(std::abs(p.red - sum.red / sum.count) <= 0.5);
    RC_ASSERT(std::abs(p.green - sum.green / sum.count) <= 0.5);
    RC_ASSERT(std::abs(p.blue - sum.blue / sum.count) <= 0.5);
    RC_ASSERT(std::abs(values.pixels[i].green - sum.green / sum.count / 255.0) < 1e-6);
  }
}

RC_GTEST_PROP(RenderSum, IsTheSumOfTheColoursOfEveryPixel, ()) {
  const RayCloud cloud =
      random_cloud(*rc::gen::arbitrary<std::uint64_t>(), {.rays = *rc::gen::inRange<std::size_t>(30, 800)});
  const RenderOptions options{.view = *rc::gen::elementOf(kViews),
                              .style = RenderStyle::sum,
                              .resolution = *rc::gen::inRange<std::size_t>(1, 30)};
  const Rendering out = rendered(cloud, options);
  const FloatImage values = values_of(cloud, options);
  auto sums = sums_of(cloud, out, options.view, out.image.width, out.image.height);
  RC_ASSERT(out.shown.has_value());
  RC_ASSERT(out.shown->darkest == 0.0);
  std::size_t brighter = 0;
  for (std::size_t i = 0; i < values.pixels.size(); i++) {
    const Sum& sum = sums[i];
    RC_ASSERT(std::abs(values.pixels[i].red - sum.red / 255.0) < 1e-4);
    RC_ASSERT(std::abs(values.pixels[i].blue - sum.blue / 255.0) < 1e-4);
    const Pixel& p = out.image.pixels[i];
    const double shown = sum.green / out.shown->brightest;
    RC_ASSERT(std::abs(p.green - std::min(shown, 255.0)) <= 0.5 + 1e-9);
    if (std::max({sum.red, sum.green, sum.blue}) / 255.0 > out.shown->brightest * 1.01) brighter++;
  }
  RC_ASSERT(brighter * 10 <= sums.size());
}

TEST(RenderSum, OfAWhiteCloudCountsItsEnds) {
  RayCloud cloud = random_cloud(11, {.rays = 5000});
  for (Colour& colour : cloud.colours)
    colour.red = colour.green = colour.blue = 255;
  const auto bounded = std::count(cloud.bounded.begin(), cloud.bounded.end(), 1);
  for (const View view : kViews) {
    double total = 0.0;
    for (const FloatPixel& p :
         values_of(cloud, {.view = view, .style = RenderStyle::sum, .resolution = 64}).pixels)
      total += static_cast<double>(p.red);
    EXPECT_EQ(total, static_cast<double>(bounded));
  }
}

TEST(RenderSum, BlackEndsAreOpaque) {
  const Pixel black{0, 0, 0, 255};
  const Image image = rendered(cloud_of({{{0, 0, 0}, black}, {{2, 0, 0}, black}}),
                               {.style = RenderStyle::sum, .resolution = 3})
                          .image;
  EXPECT_THAT(image.pixels, testing::ElementsAre(black, kNothing, black));
}

TEST(RenderMean, IsExactForManyEnds) {
  std::vector<Dot> dots(70000, Dot{{1, 1, 1}, {255, 254, 0, 255}});
  dots.resize(140000, Dot{{1, 1, 1}, {255, 255, 1, 255}});
  const FloatImage values = values_of(cloud_of(dots), {.style = RenderStyle::mean}, 2, 1000);
  EXPECT_EQ(values.pixels[0].red, 1.0F);
  EXPECT_NEAR(values.pixels[0].green, 254.5 / 255.0, 1e-7);
  EXPECT_NEAR(values.pixels[0].blue, 0.5 / 255.0, 1e-9);
}

}  // namespace
}  // namespace ray
