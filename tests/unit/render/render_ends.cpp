#include "support/random_cloud.h"

#include <raycloud/core/error.h>
#include <raycloud/core/memory_stream.h>
#include <raycloud/render/render_ends.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

namespace ray {
namespace {

using test::random_cloud;

constexpr std::array kViews = {View::top, View::left, View::right, View::front, View::back};
constexpr Pixel kNothing{};
constexpr Pixel kRed{255, 0, 0, 255};
constexpr Pixel kGreen{0, 255, 0, 255};
constexpr Pixel kBlue{0, 0, 255, 255};

Rendering rendered(const RayCloud& cloud, const RenderOptions& options, unsigned threads = 1,
                   std::size_t chunk_rays = 64) {
  MemorySource source(cloud, chunk_rays);
  return render_ends({.threads = threads}, source, options);
}

const Pixel& pixel(const Image& image, std::size_t column, std::size_t row_from_top) {
  return image.pixels.at(row_from_top * image.width + column);
}

struct Dot {
  Eigen::Vector3d end;
  Pixel colour;
  bool bounded = true;
};

RayCloud cloud_of(const std::vector<Dot>& dots) {
  RayCloud cloud;
  cloud.resize(dots.size());
  for (std::size_t i = 0; i < dots.size(); i++) {
    cloud.starts[i] = {0, 0, 0};
    cloud.ends[i] = dots[i].end;
    cloud.times[i] = 0.0;
    cloud.colours[i] = {dots[i].colour.red, dots[i].colour.green, dots[i].colour.blue, 100};
    cloud.bounded[i] = dots[i].bounded ? 1 : 0;
  }
  return cloud;
}

/// Written from the table in camera.h.
Eigen::Vector3d seen_from(View view, const Eigen::Vector3d& p) {  // right, up, nearness
  switch (view) {
    case View::top:
      return {p.x(), p.y(), p.z()};
    case View::front:
      return {p.x(), p.z(), -p.y()};
    case View::back:
      return {-p.x(), p.z(), p.y()};
    case View::left:
      return {-p.y(), p.z(), -p.x()};
    case View::right:
      break;
  }
  return {p.y(), p.z(), p.x()};
}

/// The nearest end of every pixel, by sorting nothing and comparing all.
Image brute_force(const RayCloud& cloud, View view, double pixel_width, std::size_t columns,
                  std::size_t rows) {
  Bounds bounds;
  for (std::size_t i = 0; i < cloud.size(); i++) {
    if (cloud.bounded[i] != 0) bounds.add(seen_from(view, cloud.ends[i]));
  }
  using Nearest = std::tuple<double, int, int, int>;
  std::map<std::size_t, Nearest> nearest;
  for (std::size_t i = 0; i < cloud.size(); i++) {
    if (cloud.bounded[i] == 0) continue;
    const Eigen::Vector3d p = seen_from(view, cloud.ends[i]) - bounds.min;
    const auto column = std::min(static_cast<std::size_t>(std::floor(p.x() / pixel_width)), columns - 1);
    const auto row = std::min(static_cast<std::size_t>(std::floor(p.y() / pixel_width)), rows - 1);
    const Colour& c = cloud.colours[i];
    const Nearest candidate{p.z(), c.red, c.green, c.blue};
    const auto [at, is_new] = nearest.try_emplace((rows - 1 - row) * columns + column, candidate);
    at->second = std::max(at->second, candidate);
  }
  Image image{columns, rows, std::vector<Pixel>(columns * rows)};
  for (const auto& [at, best] : nearest) {
    image.pixels[at] = {static_cast<std::uint8_t>(std::get<1>(best)),
                        static_cast<std::uint8_t>(std::get<2>(best)),
                        static_cast<std::uint8_t>(std::get<3>(best)), 255};
  }
  return image;
}

RC_GTEST_PROP(RenderEnds, ShowsTheNearestEndOfEveryPixel, ()) {
  const RayCloud cloud = random_cloud(
      *rc::gen::arbitrary<std::uint64_t>(),
      {.rays = *rc::gen::inRange<std::size_t>(30, 800),
       .centre = *rc::gen::element(Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(500000, 6900000, 100))});
  RenderOptions options{.view = *rc::gen::elementOf(kViews)};
  if (*rc::gen::arbitrary<bool>()) {
    options.pixel_width = Metres{*rc::gen::element(0.5, 3.0, 1000.0)};
  } else {
    options.resolution = *rc::gen::inRange<std::size_t>(1, 60);
  }
  const Rendering out = rendered(cloud, options);
  RC_ASSERT(
      out.image.pixels ==
      brute_force(cloud, options.view, out.pixel_width.value, out.image.width, out.image.height).pixels);
  RC_ASSERT(out.counts.rays_in == cloud.size());
  RC_ASSERT(out.counts.rays_out ==
            static_cast<std::uint64_t>(std::count(cloud.bounded.begin(), cloud.bounded.end(), 1)));
}

RC_GTEST_PROP(RenderEnds, IsTheSamePictureForAllThreadsAndChunks, ()) {
  RayCloud cloud = random_cloud(*rc::gen::arbitrary<std::uint64_t>(), {.rays = 500});
  if (*rc::gen::arbitrary<bool>()) {
    for (Colour& colour : cloud.colours)
      colour.red = colour.green = colour.blue = 255;
  }
  const RenderOptions options{.view = *rc::gen::elementOf(kViews),
                              .style = *rc::gen::element(EndsStyle::ends, EndsStyle::height),
                              .resolution = 40};
  const Image expected = rendered(cloud, options, 1, 1000000).image;
  for (const unsigned threads : {1U, 2U, 3U, 8U}) {
    for (const std::size_t chunk : {1UL, 7UL, 1000000UL}) {
      RC_ASSERT(rendered(cloud, options, threads, chunk).image.pixels == expected.pixels);
    }
  }
}

TEST(RenderEnds, NoViewIsMirrored) {
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

TEST(RenderEnds, UnboundedRaysAreNeitherDrawnNorInTheFrame) {
  const RayCloud cloud = cloud_of(
      {{{0, 0, 0}, kRed}, {{1, 1, 0}, kGreen}, {{50, 50, 9}, kBlue, false}, {{0, 0, 5}, kBlue, false}});
  const Rendering out = rendered(cloud, {.resolution = 2});
  EXPECT_THAT(out.image.pixels, testing::ElementsAre(kNothing, kGreen, kRed, kNothing));
  EXPECT_EQ(out.bounds.max, Eigen::Vector3d(1, 1, 0));
}

TEST(RenderEnds, TheLongerSideHasTheResolution) {
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

TEST(RenderEnds, OneRayIsOnePixel) {
  const Image image = rendered(cloud_of({{{3, 4, 5}, kRed}}), {}).image;
  EXPECT_EQ(image.width, 1U);
  EXPECT_EQ(image.height, 1U);
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

TEST(RenderEnds, RefusesWhatCannotBeDrawn) {
  const RayCloud cloud = cloud_of({{{0, 0, 0}, kRed}, {{100000, 50000, 0}, kGreen}});
  EXPECT_EQ(code_of(cloud_of({}), {}), ErrorCode::no_data);
  EXPECT_EQ(code_of(cloud_of({{{0, 0, 0}, kRed, false}}), {}), ErrorCode::no_data);
  EXPECT_EQ(code_of(cloud, {.resolution = 0}), ErrorCode::usage);
  EXPECT_EQ(code_of(cloud, {.pixel_width = Metres{0.0}}), ErrorCode::usage);
  EXPECT_EQ(code_of(cloud, {.pixel_width = Metres{std::nan("")}}), ErrorCode::usage);
  std::string message;
  EXPECT_EQ(code_of(cloud, {.pixel_width = Metres{0.001}}, &message), ErrorCode::out_of_range);
  EXPECT_THAT(message, testing::HasSubstr("1e+08 x 5e+07 pixels"));
  EXPECT_EQ(code_of(cloud, {.pixel_width = Metres{1e-300}}), ErrorCode::out_of_range);
  EXPECT_EQ(code_of(cloud, {.resolution = ~std::size_t{0}}), ErrorCode::out_of_range);
}

int brightness(const Pixel& p) {
  return p.red + p.green + p.blue;
}

TEST(RenderEnds, AWhiteCloudIsShadedByIntensity) {
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

TEST(RenderEnds, ACloudWithoutColourOrIntensityIsShownByHeight) {
  RayCloud cloud = random_cloud(4, {.rays = 300});
  for (Colour& colour : cloud.colours)
    colour = Colour{};
  EXPECT_EQ(rendered(cloud, {.view = View::front}).image.pixels,
            rendered(cloud, {.view = View::front, .style = EndsStyle::height}).image.pixels);
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

TEST(RenderEnds, HeightGoesThroughTheRampWhateverAStrayPointDoes) {
  std::vector<Dot> dots;
  for (int i = 0; i < 1000; i++)
    dots.push_back({{i * 0.1, 0.0, i * 0.01}, kRed});
  dots.push_back({{50.0, 0.0, 5000.0}, kRed});
  const Image image =
      rendered(cloud_of(dots), {.style = EndsStyle::height, .pixel_width = Metres{0.1}}).image;
  EXPECT_EQ(image.pixels.front(), height_colour(0.0));
  EXPECT_EQ(image.pixels.back(), height_colour(1.0));
  EXPECT_NEAR(luminance(image.pixels[250]), luminance(height_colour(0.25)), 0.02);
}

}  // namespace
}  // namespace ray
