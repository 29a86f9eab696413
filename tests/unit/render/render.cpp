#include "scene.h"
#include "support/random_cloud.h"

#include <raycloud/core/error.h>
#include <raycloud/render/height_colour.h>
#include <raycloud/render/render.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

namespace ray {
namespace {

using namespace test;

/// The nearest end (or start) of every pixel and `radius` pixels around it, by sorting nothing and comparing
/// all.
Image brute_force(const RayCloud& cloud, const RenderOptions& options, const Rendering& size, int radius) {
  const double pixel_width = size.pixel_width.value;
  const auto columns = static_cast<int>(size.image.width), rows = static_cast<int>(size.image.height);
  const bool starts = options.style == RenderStyle::starts;
  std::vector<std::size_t> drawn;
  for (std::size_t i = 0; i < cloud.size(); i++) {
    if (starts || cloud.bounded[i] != 0) drawn.push_back(i);
  }
  const auto seen = [&](std::size_t i) {
    return seen_from(options.view, starts ? cloud.starts[i] : cloud.ends[i]);
  };
  Bounds bounds;
  for (const std::size_t i : drawn)
    bounds.add(seen(i));
  using Nearest = std::tuple<double, int, int, int>;
  std::map<std::pair<int, int>, Nearest> nearest;
  for (const std::size_t i : drawn) {
    const Eigen::Vector3d p = (seen(i) - bounds.min) / pixel_width;
    const int column = std::min(static_cast<int>(p.x()), columns - 1);
    const int row = std::min(static_cast<int>(p.y()), rows - 1);
    const Colour& colour = cloud.colours[i];
    const Nearest candidate{seen(i).z(), colour.red, colour.green, colour.blue};
    for (int y = row - radius; y <= row + radius; y++) {
      for (int x = column - radius; x <= column + radius; x++) {
        const auto [at, is_new] = nearest.try_emplace({x, y}, candidate);
        at->second = std::max(at->second, candidate);
      }
    }
  }
  Image image{static_cast<std::size_t>(columns), static_cast<std::size_t>(rows), {}};
  for (int y = rows - 1; y >= 0; y--) {
    for (int x = 0; x < columns; x++) {
      const auto at = nearest.find({x, y});
      if (at == nearest.end()) {
        image.pixels.push_back(kNothing);
      } else {
        const auto& [nearness, red, green, blue] = at->second;
        image.pixels.push_back({static_cast<std::uint8_t>(red), static_cast<std::uint8_t>(green),
                                static_cast<std::uint8_t>(blue), 255});
      }
    }
  }
  return image;
}

RayCloud any_cloud(std::size_t least_rays, std::size_t past_rays) {
  return random_cloud(
      *rc::gen::arbitrary<std::uint64_t>(),
      {.rays = *rc::gen::inRange(least_rays, past_rays),
       .centre = *rc::gen::element(Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(500000, 6900000, 100))});
}

RC_GTEST_PROP(Render, ShowsTheNearestEndOrStartOfEveryPixel, ()) {
  const RayCloud cloud = any_cloud(30, 800);
  RenderOptions options{.view = *rc::gen::elementOf(kViews),
                        .style = *rc::gen::element(RenderStyle::ends, RenderStyle::starts)};
  if (*rc::gen::arbitrary<bool>()) {
    options.pixel_width = Metres{*rc::gen::element(0.5, 3.0, 1000.0)};
  } else {
    options.resolution = *rc::gen::inRange<std::size_t>(1, 60);
  }
  const Rendering out = rendered(cloud, options);
  const int radius = options.style == RenderStyle::starts ? 1 : 0;
  RC_ASSERT(out.image.pixels == brute_force(cloud, options, out, radius).pixels);
  RC_ASSERT(out.counts.rays_in == cloud.size());
  const auto bounded = static_cast<std::uint64_t>(std::count(cloud.bounded.begin(), cloud.bounded.end(), 1));
  RC_ASSERT(out.counts.rays_out == (options.style == RenderStyle::ends ? bounded : cloud.size()));

  const FloatImage values = values_of(cloud, options);
  const Image seen = brute_force(cloud, options, out, 0);
  for (std::size_t i = 0; i < values.pixels.size(); i++) {
    const FloatPixel& value = values.pixels[i];
    const Pixel& p = seen.pixels[i];
    RC_ASSERT(value == (FloatPixel{static_cast<float>(p.red) / 255.0F, static_cast<float>(p.green) / 255.0F,
                                   static_cast<float>(p.blue) / 255.0F}));
  }
}

RC_GTEST_PROP(Render, IsTheSamePictureForAllThreadsAndChunks, ()) {
  RayCloud cloud = any_cloud(1, 500);
  cloud.bounded[0] = 1;
  if (*rc::gen::arbitrary<bool>()) {
    for (Colour& colour : cloud.colours)
      colour.red = colour.green = colour.blue = 255;
  }
  const RenderOptions options{.view = *rc::gen::elementOf(kViews),
                              .style = *rc::gen::elementOf(kStyles),
                              .resolution = *rc::gen::element<std::size_t>(1, 40, 300)};
  const Image expected = rendered(cloud, options, 1, 1000000).image;
  const FloatImage values = values_of(cloud, options, 1, 1000000);
  for (const unsigned threads : {1U, 2U, 3U, 8U}) {
    for (const std::size_t chunk : {1UL, 7UL, 1000UL}) {
      RC_ASSERT(rendered(cloud, options, threads, chunk).image.pixels == expected.pixels);
    }
    RC_ASSERT(values_of(cloud, options, threads, 7).pixels == values.pixels);
  }
}

TEST(Render, NoViewIsMirrored) {
  // An end at the far end of each axis, on the diagonal of the other two so that none hides another.
  const RayCloud cloud =
      cloud_of({{{0, 0, 0}, {9, 9, 9, 255}}, {{2, 0, 0}, kRed}, {{0, 2, 0}, kGreen}, {{0, 0, 2}, kBlue}});
  const auto corners = [&](View view) {
    const Image image = rendered(cloud, {.view = view, .resolution = 3}).image;
    EXPECT_EQ(image.width, 3U);
    EXPECT_EQ(image.height, 3U);
    return std::array{pixel(image, 0, 0), pixel(image, 2, 0), pixel(image, 0, 2), pixel(image, 2, 2)};
  };
  // Top left, top right, bottom left, bottom right; where two ends are in one pixel, the nearer.
  EXPECT_THAT(corners(View::top), testing::ElementsAre(kGreen, kNothing, kBlue, kRed));
  EXPECT_THAT(corners(View::right), testing::ElementsAre(kBlue, kNothing, kRed, kGreen));
  EXPECT_THAT(corners(View::back), testing::ElementsAre(kNothing, kBlue, kRed, kGreen));
  EXPECT_EQ(corners(View::front)[0], kBlue);
  EXPECT_EQ(corners(View::front)[3], kRed);
  EXPECT_EQ(corners(View::left)[1], kBlue);
  EXPECT_EQ(corners(View::left)[2], kGreen);
}

TEST(Render, UnboundedRaysAreNeitherDrawnNorInTheFrame) {
  const RayCloud cloud = cloud_of(
      {{{0, 0, 0}, kRed}, {{1, 1, 0}, kGreen}, {{50, 50, 9}, kBlue, false}, {{0, 0, 5}, kBlue, false}});
  const Rendering out = rendered(cloud, {.resolution = 2});
  EXPECT_THAT(out.image.pixels, testing::ElementsAre(kNothing, kGreen, kRed, kNothing));
  EXPECT_EQ(out.bounds.max, Eigen::Vector3d(1, 1, 0));
}

TEST(Render, TheLongerSideHasTheResolution) {
  const RayCloud cloud = cloud_of({{{0, 0, 0}, kRed}, {{30, 10, 6}, kGreen}});
  Rendering out = rendered(cloud, {.resolution = 300});
  EXPECT_EQ(out.image.width, 300U);
  EXPECT_EQ(out.image.height, 100U);
  EXPECT_DOUBLE_EQ(out.pixel_width.value, 0.1);
  out = rendered(cloud, {.view = View::left, .resolution = 5});
  EXPECT_EQ(out.image.width, 5U);
  EXPECT_EQ(out.image.height, 3U);
  out = rendered(cloud, {.pixel_width = Metres{4.0}});
  EXPECT_EQ(out.image.width, 8U);
  EXPECT_EQ(out.image.height, 3U);
}

TEST(Render, OneRayIsOnePixelOfEveryStyleOfPoints) {
  for (const RenderStyle style : kStyles) {
    if (style == RenderStyle::rays) continue;
    const RayCloud cloud = cloud_of({{{3, 4, 5}, kRed}});
    const Image image = rendered(cloud, {.style = style}).image;
    ASSERT_EQ(image.pixels.size(), 1U);
    EXPECT_EQ(image.pixels[0].alpha, 255);
    if (style == RenderStyle::sum) {
      EXPECT_EQ(image.pixels[0], kRed);
    }
  }
}

/// One end in the middle of each pixel of 0.5 m, of height z(x, y).
template <class Height>
RayCloud surface(int side, const Height& z) {
  std::vector<Dot> dots;
  for (int y = 0; y < side; y++) {
    for (int x = 0; x < side; x++)
      dots.push_back({{0.25 + 0.5 * x, 0.25 + 0.5 * y, z(x, y)}, kRed});
  }
  dots.push_back({{0.0, 0.0, z(0, 0)}, kRed});
  return cloud_of(dots);
}

TEST(Render, APlaneIsAConstantImage) {
  const RayCloud plane = surface(20, [](int, int) { return 7.0; });
  for (const RenderStyle style : {RenderStyle::ends, RenderStyle::height, RenderStyle::mean}) {
    const Image image = rendered(plane, {.style = style, .pixel_width = Metres{0.5}}).image;
    ASSERT_EQ(image.pixels.size(), 400U);
    for (const Pixel& p : image.pixels)
      EXPECT_EQ(p, image.pixels[0]);
  }
}

TEST(Render, AStepHasItsEdgeAtItsPixel) {
  const RayCloud step = surface(20, [](int x, int) { return x < 13 ? 2.0 : 5.0; });
  const RenderOptions options{.style = RenderStyle::height, .pixel_width = Metres{0.5}};
  const Rendering out = rendered(step, options);
  const FloatImage values = values_of(step, options);
  ASSERT_TRUE(out.shown);
  EXPECT_DOUBLE_EQ(out.shown->darkest, 2.0);
  EXPECT_DOUBLE_EQ(out.shown->brightest, 5.0);
  for (std::size_t row = 0; row < 20; row++) {
    for (std::size_t column = 0; column < 20; column++) {
      EXPECT_EQ(pixel(out.image, column, row), height_colour(column < 13 ? 0.0 : 1.0));
      EXPECT_NEAR(values.pixels[row * 20 + column].green, column < 13 ? 0.0 : 3.0, 1e-6);
    }
  }
}

RC_GTEST_PROP(Render, ValuesOfHeightAreMetresAboveTheLowestEnd, ()) {
  const RayCloud cloud = any_cloud(30, 300);
  const RenderOptions options{.style = RenderStyle::height,
                              .resolution = *rc::gen::inRange<std::size_t>(1, 40)};
  MemorySource source(cloud);
  const ValueRendering out = render_values({}, source, options);
  std::map<std::size_t, double> highest;
  for (std::size_t i = 0; i < cloud.size(); i++) {
    if (cloud.bounded[i] == 0) continue;
    const Eigen::Vector3d p = (cloud.ends[i] - out.bounds.min) / out.pixel_width.value;
    const std::size_t column = std::min(static_cast<std::size_t>(p.x()), out.image.width - 1);
    const std::size_t row = std::min(static_cast<std::size_t>(p.y()), out.image.height - 1);
    double& height = highest[(out.image.height - 1 - row) * out.image.width + column];
    height = std::max(height, cloud.ends[i].z() - out.bounds.min.z());
  }
  for (std::size_t i = 0; i < out.image.pixels.size(); i++)
    RC_ASSERT(std::abs(out.image.pixels[i].red - highest[i]) < 1e-5);
}

ErrorCode code_of(const RayCloud& cloud, const RenderOptions& options, std::string* message = nullptr) {
  try {
    static_cast<void>(rendered(cloud, options));
  } catch (const Error& error) {
    if (message != nullptr) *message = error.what();
    return error.code();
  }
  ADD_FAILURE() << "nothing was thrown";
  return ErrorCode::cancelled;
}

TEST(Render, RefusesWhatCannotBeDrawn) {
  const RayCloud cloud = cloud_of({{{0, 0, 0}, kRed}, {{100000, 50000, 0}, kGreen}});
  const RayCloud unbounded = cloud_of({{{0, 0, 0}, kRed, false}});
  for (const RenderStyle style : kStyles) {
    EXPECT_EQ(code_of(cloud_of({}), {.style = style}), ErrorCode::no_data);
    if (style == RenderStyle::starts || style == RenderStyle::rays) {
      EXPECT_EQ(rendered(unbounded, {.style = style}).image.pixels.size(), 1U);
    } else {
      EXPECT_EQ(code_of(unbounded, {.style = style}), ErrorCode::no_data);
    }
  }
  EXPECT_EQ(code_of(cloud, {.resolution = 0}), ErrorCode::usage);
  EXPECT_EQ(code_of(cloud, {.pixel_width = Metres{0.0}}), ErrorCode::usage);
  EXPECT_EQ(code_of(cloud, {.pixel_width = Metres{std::nan("")}}), ErrorCode::usage);
  std::string message;
  EXPECT_EQ(code_of(cloud, {.pixel_width = Metres{0.001}}, &message), ErrorCode::out_of_range);
  EXPECT_THAT(message, testing::HasSubstr("1e+08 x 5e+07 pixels"));
  EXPECT_EQ(code_of(cloud, {.pixel_width = Metres{1e-300}}), ErrorCode::out_of_range);
  EXPECT_EQ(code_of(cloud, {.resolution = 101, .longest_side = 100}, &message), ErrorCode::out_of_range);
  EXPECT_THAT(message, testing::HasSubstr("101 x 51 pixels (a side may have 100)"));
  for (const RenderStyle style : kStyles) {
    if (style == RenderStyle::starts) continue;  // all at one place
    EXPECT_EQ(code_of(cloud, {.style = style, .resolution = ~std::size_t{0}}), ErrorCode::out_of_range);
  }
}

int brightness(const Pixel& p) {
  return p.red + p.green + p.blue;
}

TEST(Render, AWhiteCloudIsShadedByIntensity) {
  const Pixel white{255, 255, 255, 255};
  RayCloud cloud = cloud_of({{{0, 0, 0}, white}, {{1, 0, 0}, white}, {{2, 0, 0}, white}});
  cloud.colours[0].intensity = 3;
  cloud.colours[1].intensity = 7;
  cloud.colours[2].intensity = 250;
  const Image image = rendered(cloud, {.resolution = 3}).image;
  EXPECT_LT(brightness(image.pixels[0]) + 100, brightness(image.pixels[1]));
  EXPECT_LT(brightness(image.pixels[1]) + 100, brightness(image.pixels[2]));
  for (const Pixel& p : image.pixels) {
    EXPECT_EQ(p.red, p.blue);
    EXPECT_GT(p.red, 50);
  }
}

TEST(Render, ACloudWithoutColourOrIntensityIsShownByHeight) {
  RayCloud cloud = random_cloud(4, {.rays = 300});
  for (Colour& colour : cloud.colours)
    colour = Colour{};
  EXPECT_EQ(rendered(cloud, {.view = View::front}).image.pixels,
            rendered(cloud, {.view = View::front, .style = RenderStyle::height}).image.pixels);
}

double luminance(const Pixel& p) {
  const auto linear = [](std::uint8_t v) { return std::pow(v / 255.0, 2.2); };
  return 0.2126 * linear(p.red) + 0.7152 * linear(p.green) + 0.0722 * linear(p.blue);
}

TEST(HeightColour, GetsLighterAllTheWayUp) {
  for (int i = 1; i <= 20; i++) {
    EXPECT_GT(luminance(height_colour(i / 20.0)), luminance(height_colour((i - 1) / 20.0))) << i;
  }
  EXPECT_EQ(height_colour(-1.0), height_colour(0.0));
  EXPECT_EQ(height_colour(2.0), height_colour(1.0));
}

TEST(Render, HeightGoesThroughTheRampWhateverAStrayPointDoes) {
  std::vector<Dot> dots;
  for (int i = 0; i < 1000; i++)
    dots.push_back({{i * 0.1, 0.0, i * 0.01}, kRed});
  dots.push_back({{50.0, 0.0, 5000.0}, kRed});
  const Image image =
      rendered(cloud_of(dots), {.style = RenderStyle::height, .pixel_width = Metres{0.1}}).image;
  EXPECT_EQ(image.pixels.front(), height_colour(0.0));
  EXPECT_EQ(image.pixels.back(), height_colour(1.0));
  EXPECT_NEAR(luminance(image.pixels[250]), luminance(height_colour(0.25)), 0.02);
}

}  // namespace
}  // namespace ray
