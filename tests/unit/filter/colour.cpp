#include "support/random_cloud.h"

#include <raycloud/core/error.h>
#include <raycloud/core/memory_stream.h>
#include <raycloud/filter/colour.h>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <array>
#include <cmath>

namespace ray {
namespace {

using test::random_cloud;
using test::same_bits;

RayCloud coloured(const RayCloud& cloud, const Colouring& colouring, unsigned threads = 1,
                  std::size_t chunk_rays = 100) {
  MemorySource source(cloud, chunk_rays);
  MemorySink sink(source.info().extras);
  const StreamCounts counts = colour_rays(Context{.threads = threads}, source, sink, colouring);
  EXPECT_EQ(counts.rays_in, cloud.size());
  EXPECT_EQ(counts.rays_out, cloud.size());
  return sink.cloud();
}

bool same_rgb(const Colour& a, const Colour& b) {
  return a.red == b.red && a.green == b.green && a.blue == b.blue;
}

/// Red and blue above, black and white below.
Image four_pixels() {
  return {.width = 2,
          .height = 2,
          .pixels = {{255, 0, 0, 255}, {0, 0, 255, 255}, {0, 0, 0, 255}, {255, 255, 255, 255}}};
}

std::array<Colouring, 6> every_colouring() {
  return {ColourByTime{},          ColourByHeight{},  ColourByIntensity{},
          OneColour{{1, 2, 3, 4}}, SetIntensity{100}, ColourByImage{four_pixels()}};
}

RC_GTEST_PROP(ColourRays, NothingElseChangesWhateverTheThreadsAndChunks, ()) {
  const RayCloud cloud =
      random_cloud(*rc::gen::arbitrary<std::uint64_t>(),
                   {.rays = *rc::gen::inRange<std::size_t>(0, 200), .extras = test::schema_of_every_type()});
  for (const Colouring& colouring : every_colouring()) {
    const RayCloud expected = coloured(cloud, colouring, 1, 1000000);
    RayCloud other = expected;
    other.colours = cloud.colours;
    RC_ASSERT(same_bits(other, cloud));
    for (std::size_t i = 0; i < cloud.size(); ++i)
      RC_ASSERT(std::holds_alternative<SetIntensity>(colouring) ||
                expected.colours[i].intensity == cloud.colours[i].intensity);
    for (const unsigned threads : {1U, 2U, 3U, 8U})
      for (const std::size_t chunk : {1UL, 7UL, 1000UL})
        RC_ASSERT(same_bits(coloured(cloud, colouring, threads, chunk), expected));
  }
}

TEST(ColourByTime, RedGreenBlueEachMinute) {
  RayCloud cloud = random_cloud(1, {.rays = 7});
  // The second minute of a large clock and a time before its zero are no different.
  cloud.times = {0.0, 20.0, 40.0, 60.0, 1.2e9 + 20.0, -20.0, 10.0};
  const RayCloud out = coloured(cloud, ColourByTime{});
  const Colour red{255, 0, 0}, green{0, 255, 0}, blue{0, 0, 255}, yellow{255, 255, 0};
  const std::array<Colour, 7> expected{red, green, blue, red, green, blue, yellow};
  for (std::size_t i = 0; i < 7; ++i) {
    // 20 / 60 is not a number that a double holds, so the neighbour of a hue is right too.
    EXPECT_NEAR(out.colours[i].red, expected[i].red, 1) << i;
    EXPECT_NEAR(out.colours[i].green, expected[i].green, 1) << i;
    EXPECT_NEAR(out.colours[i].blue, expected[i].blue, 1) << i;
  }
}

TEST(ColourByHeight, RepeatsEveryTenMetres) {
  RayCloud cloud = random_cloud(1, {.rays = 4});
  for (const double base : {0.0, 10.0, -30.0, 8000.0}) {
    for (std::size_t i = 0; i < 4; ++i)
      cloud.ends[i].z() = base + 2.5 * static_cast<double>(i);
    const RayCloud out = coloured(cloud, ColourByHeight{});
    EXPECT_TRUE(same_rgb(out.colours[0], {255, 0, 0})) << base;
    EXPECT_GT(out.colours[1].green, out.colours[1].blue) << base;
    EXPECT_TRUE(same_rgb(out.colours[2], {0, 255, 255})) << base;  // opposite of red
    EXPECT_GT(out.colours[3].blue, out.colours[3].green) << base;
  }
}

TEST(HueColour, ChangesByOneStepOfOneChannelAtMost) {
  Colour last = hue_colour(0.0);
  constexpr int kSteps = 20000;
  for (int i = 1; i <= kSteps; ++i) {
    const Colour next = hue_colour(static_cast<double>(i) / kSteps);
    const int change =
        std::abs(next.red - last.red) + std::abs(next.green - last.green) + std::abs(next.blue - last.blue);
    EXPECT_LE(change, 1) << i;
    last = next;
  }
  EXPECT_TRUE(same_rgb(last, {255, 0, 0}));
  EXPECT_TRUE(same_rgb(hue_colour(std::nextafter(0.0, -1.0)), {255, 0, 0}) ||
              hue_colour(std::nextafter(0.0, -1.0)).blue == 1);
}

TEST(ColourByIntensity, GreyAndBlackForWhatHitNothing) {
  RayCloud cloud = random_cloud(1, {.rays = 2});
  cloud.colours = {{1, 2, 3, 77}, {1, 2, 3, 88}};
  cloud.bounded = {1, 0};
  const RayCloud out = coloured(cloud, ColourByIntensity{});
  EXPECT_TRUE(same_rgb(out.colours[0], {77, 77, 77}));
  EXPECT_TRUE(same_rgb(out.colours[1], {0, 0, 0}));
}

TEST(SetIntensity, UnboundedStaysUnboundedAndZeroMakesSo) {
  RayCloud cloud = random_cloud(1, {.rays = 2});
  cloud.bounded = {1, 0};
  const RayCloud bright = coloured(cloud, SetIntensity{200});
  EXPECT_EQ(bright.bounded, (std::vector<std::uint8_t>{1, 0}));
  EXPECT_EQ(bright.colours[0].intensity, 200);
  const RayCloud none = coloured(cloud, SetIntensity{0});
  EXPECT_EQ(none.bounded, (std::vector<std::uint8_t>{0, 0}));
}

TEST(ColourByImage, LiesOnTheBoundedEndsAsSeenFromAbove) {
  RayCloud cloud = random_cloud(1, {.rays = 6});
  cloud.ends = {{0, 0, 5}, {4, 0, 1}, {0, 4, 2}, {4, 4, 3}, {-9, 1, 0}, {1, 1.9, 0}};
  cloud.bounded = {1, 1, 1, 1, 0, 0};
  const RayCloud out = coloured(cloud, ColourByImage{four_pixels()});
  EXPECT_TRUE(same_rgb(out.colours[0], {0, 0, 0}));
  EXPECT_TRUE(same_rgb(out.colours[1], {255, 255, 255}));
  EXPECT_TRUE(same_rgb(out.colours[2], {255, 0, 0}));
  EXPECT_TRUE(same_rgb(out.colours[3], {0, 0, 255}));
  EXPECT_TRUE(same_rgb(out.colours[4], cloud.colours[4])) << "outside";
  EXPECT_TRUE(same_rgb(out.colours[5], {0, 0, 0}));
}

TEST(ColourByImage, NarrowImagesAreNotStretchedAndTransparentOnesLeaveTheColour) {
  RayCloud cloud = random_cloud(1, {.rays = 3});
  cloud.bounded = {1, 1, 1};
  cloud.ends = {{100, 0, 0}, {104, 1, 0}, {103, 0.5, 0}};
  // Two pixels of 2 m beside each other, though the cloud is only 1 m deep.
  Image image{.width = 2, .height = 1, .pixels = {{9, 9, 9, 255}, {7, 7, 7, 0}}};
  const RayCloud out = coloured(cloud, ColourByImage{image});
  EXPECT_TRUE(same_rgb(out.colours[0], {9, 9, 9}));
  EXPECT_TRUE(same_rgb(out.colours[1], cloud.colours[1]));
  EXPECT_TRUE(same_rgb(out.colours[2], cloud.colours[2]));
}

TEST(ColourByImage, OnePointAndNoRaysAndNoPixels) {
  const RayCloud one = random_cloud(1, {.rays = 1});
  EXPECT_EQ(coloured(one, ColourByImage{four_pixels()}).size(), 1U);
  EXPECT_EQ(coloured(RayCloud{}, ColourByImage{four_pixels()}).size(), 0U);
  EXPECT_THROW(coloured(one, ColourByImage{}), Error);
}

}  // namespace
}  // namespace ray
