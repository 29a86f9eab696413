#include "support/random_cloud.h"

#include <raycloud/core/memory_stream.h>
#include <raycloud/filter/colour.h>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <array>
#include <cmath>
#include <cstdlib>

namespace ray {
namespace {

using test::random_cloud;
using test::same_bits;

RayCloud surface_coloured(const Context& context, const RayCloud& cloud, const Colouring& colouring,
                          Shading shading = Shading::none, std::size_t chunk_rays = 100) {
  MemorySource source(cloud, chunk_rays);
  MemorySink sink(source.info().extras);
  const StreamCounts counts = colour_rays(context, source, sink, colouring, shading);
  EXPECT_EQ(counts.rays_in, cloud.size());
  EXPECT_EQ(counts.rays_out, cloud.size());
  return sink.cloud();
}

/// `place(u, v)` for random u and v in [0, 1), seen from `sensor`, in white.
template <class Place>
RayCloud scanned(std::size_t count, const Eigen::Vector3d& sensor, const Place& place) {
  const RandomStream random(7, "scanned surface");
  RayCloud cloud;
  cloud.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    cloud.ends[i] = place(random.uniform(i, 0), random.uniform(i, 1));
    cloud.starts[i] = sensor;
    cloud.colours[i] = {200, 200, 200, 255};
    cloud.bounded[i] = 1;
  }
  return cloud;
}

RayCloud level_plane(std::size_t count) {
  return scanned(count, {0.5, 0.5, 20.0}, [](double u, double v) { return Eigen::Vector3d(u, v, 0.0); });
}

struct MeanColour {
  double red = 0.0, green = 0.0, blue = 0.0;
};

template <class Choose>
MeanColour mean_where(const RayCloud& cloud, const Choose& choose) {
  MeanColour mean;
  double count = 0.0;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (!choose(cloud.ends[i])) continue;
    mean.red += cloud.colours[i].red;
    mean.green += cloud.colours[i].green;
    mean.blue += cloud.colours[i].blue;
    ++count;
  }
  EXPECT_GT(count, 0.0);
  return {mean.red / count, mean.green / count, mean.blue / count};
}

constexpr auto kEverywhere = [](const Eigen::Vector3d&) { return true; };

bool is_rgb(const Colour& colour, int red, int green, int blue) {
  return colour.red == red && colour.green == green && colour.blue == blue;
}

RC_GTEST_PROP(ColourBySurface, SameBitsWhateverTheThreadsChunksAndMemory, ()) {
  const auto rays = *rc::gen::element<std::size_t>(0, 1, 3, 15, 18, 100, 900);
  RayCloud cloud =
      random_cloud(*rc::gen::arbitrary<std::uint64_t>(),
                   {.rays = rays,
                    .centre = *rc::gen::element(Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(5e5, 6.9e6, 100)),
                    .extras = test::schema_of_every_type()});
  if (*rc::gen::arbitrary<bool>())  // places twice, and nearest neighbours that are equally near
    for (Eigen::Vector3d& end : cloud.ends)
      end = (end / 4.0).array().round() * 4.0;
  const Colouring colouring =
      *rc::gen::element<Colouring>(ColourByShape{}, ColourByNormal{}, ColourByBranches{}, ColourByHeight{});
  for (const Shading shading : {Shading::none, Shading::lit}) {
    const RayCloud expected = surface_coloured({.threads = 1}, cloud, colouring, shading, 1000000);
    RayCloud other = expected;
    other.colours = cloud.colours;
    RC_ASSERT(same_bits(other, cloud));
    for (std::size_t i = 0; i < cloud.size(); ++i)
      RC_ASSERT(expected.colours[i].intensity == cloud.colours[i].intensity);
    const auto same = [&](const Context& context, std::size_t chunk) {
      return same_bits(surface_coloured(context, cloud, colouring, shading, chunk), expected);
    };
    for (const unsigned threads : {1U, 2U, 3U, 8U})
      for (const std::size_t chunk : {1UL, 7UL, 1000UL})
        RC_ASSERT(same({.threads = threads}, chunk));
    // Several blocks.
    RC_ASSERT(same({.threads = 1, .memory = 30000}, 7));
    RC_ASSERT(same({.threads = 2, .memory = 30000}, 1));
    RC_ASSERT(same({.threads = 8, .memory = 30000}, 1000));
  }
}

TEST(ColourBySurface, ASurfaceInManyBlocksHasNoSeams) {
  const RayCloud cloud = scanned(8000, {0, 0, 20}, [](double u, double v) {
    return Eigen::Vector3d(20 * u, 10 * v, std::sin(4.0 * u) + 0.3 * std::cos(9.0 * v));
  });
  for (const Colouring& colouring : std::array<Colouring, 2>{ColourByShape{}, OneColour{{200, 100, 50}}}) {
    const RayCloud whole = surface_coloured({}, cloud, colouring, Shading::lit, 8192);
    EXPECT_TRUE(same_bits(surface_coloured({.memory = 50000}, cloud, colouring, Shading::lit, 999), whole));
  }
}

TEST(ColourByNormal, LevelGroundFromAboveAndBelow) {
  RayCloud cloud = level_plane(2000);
  for (const Colour& colour : surface_coloured({}, cloud, ColourByNormal{}).colours)
    ASSERT_TRUE(is_rgb(colour, 128, 128, 255));
  for (Eigen::Vector3d& start : cloud.starts)
    start.z() = -20.0;
  for (const Colour& colour : surface_coloured({}, cloud, ColourByNormal{}).colours)
    ASSERT_TRUE(is_rgb(colour, 128, 128, 0));
}

TEST(ColourByNormal, TheSidesOfAThinWallAreOpposite) {
  // 2 cm thick, with points every 4 cm: the nearest neighbours are on both sides.
  RayCloud cloud =
      scanned(4000, {0, 0, 0}, [](double u, double v) { return Eigen::Vector3d(2.5 * u, 0, v); });
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const double side = i % 2 == 0 ? 1.0 : -1.0;
    cloud.ends[i].y() = 0.01 * side;
    cloud.starts[i] = {1.0, 10.0 * side, 0.5};
  }
  const RayCloud out = surface_coloured({}, cloud, ColourByNormal{});
  for (std::size_t i = 0; i < out.size(); ++i) {
    ASSERT_NEAR(out.colours[i].red, 128, 1);
    ASSERT_NEAR(out.colours[i].green, i % 2 == 0 ? 255 : 0, 1);
    ASSERT_NEAR(out.colours[i].blue, 128, 1);
  }
}

TEST(ColourByShape, PlanesAreBlueLinesGreenAndBallsRed) {
  const MeanColour plane = mean_where(surface_coloured({}, level_plane(2000), ColourByShape{}), kEverywhere);
  EXPECT_EQ(plane.red, 0.0);
  EXPECT_GT(plane.blue, 180.0);
  const RayCloud line = scanned(
      500, {5, 5, 5}, [](double u, double) { return Eigen::Vector3d(10.0 * u, 20.0 * u, -10.0 * u); });
  for (const Colour& colour : surface_coloured({}, line, ColourByShape{}).colours)
    ASSERT_TRUE(is_rgb(colour, 0, 255, 0));
  RayCloud ball = random_cloud(3, {.rays = 3000, .half_extent = 1.0});
  for (Eigen::Vector3d& start : ball.starts)
    start = {0, 0, 1000};
  const MeanColour cloud = mean_where(surface_coloured({}, ball, ColourByShape{}), kEverywhere);
  EXPECT_GT(cloud.red, cloud.green);
  EXPECT_GT(cloud.red, cloud.blue);
}

TEST(ColourByBranches, HueByTheAxisAndDarkWhereThereIsNone) {
  const RayCloud lying =
      scanned(500, {5, 5, 5}, [](double u, double) { return Eigen::Vector3d(10 * u, 0, 1); });
  const RayCloud upright =
      scanned(500, {5, 5, 5}, [](double u, double) { return Eigen::Vector3d(0, 1, 10 * u); });
  const RayCloud oblique =
      scanned(500, {5, 5, 5}, [](double u, double) { return Eigen::Vector3d(5 * u, 0, 5 * u); });
  for (const Colour& colour : surface_coloured({}, lying, ColourByBranches{}).colours)
    ASSERT_TRUE(is_rgb(colour, 255, 0, 0));
  for (const Colour& colour : surface_coloured({}, upright, ColourByBranches{}).colours)
    ASSERT_TRUE(is_rgb(colour, 0, 255, 0));
  for (const Colour& colour : surface_coloured({}, oblique, ColourByBranches{}).colours)
    ASSERT_TRUE(colour.red > 250 && colour.green > 250 && colour.blue < 5);
  const MeanColour plane =
      mean_where(surface_coloured({}, level_plane(2000), ColourByBranches{}), kEverywhere);
  EXPECT_LT(plane.red + plane.green + plane.blue, 200.0);
}

TEST(Lit, LevelGroundKeepsItsColourAndWhatFacesAwayIsDarkerButNotBlack) {
  RayCloud cloud = level_plane(2000);
  const RayCloud out = surface_coloured({}, cloud, OneColour{{10, 100, 255}}, Shading::lit);
  for (const Colour& colour : out.colours)
    ASSERT_TRUE(is_rgb(colour, 10, 100, 255));
  for (Eigen::Vector3d& start : cloud.starts)
    start.z() = -20.0;
  for (const Colour& colour : surface_coloured({}, cloud, OneColour{{200, 200, 200}}, Shading::lit).colours)
    ASSERT_TRUE(colour.red > 60 && colour.red < 140) << int{colour.red};
}

TEST(Lit, RidgesAreBrighterAndHollowsDarker) {
  const auto roof = [](double sign) {
    return scanned(20000, {1, 1, 50}, [sign](double u, double v) {
      return Eigen::Vector3d(2 * u, 2 * v, -0.7 * sign * std::abs(2 * v - 1));
    });
  };
  const auto middle = [](const Eigen::Vector3d& p) { return std::abs(p.y() - 1) < 0.02; };
  const auto beside = [](const Eigen::Vector3d& p) { return std::abs(std::abs(p.y() - 1) - 0.5) < 0.2; };
  for (const double sign : {1.0, -1.0}) {
    const RayCloud out = surface_coloured({}, roof(sign), OneColour{{100, 100, 100}}, Shading::lit);
    const double change = mean_where(out, middle).red - mean_where(out, beside).red;
    EXPECT_GT(sign * change, 10.0);
  }
}

TEST(ColourBySurface, RaysWithoutASurface) {
  RayCloud cloud = level_plane(40);
  for (std::size_t i = 0; i < 20; ++i)
    cloud.bounded[i] = 0;
  // Far from everything else; the sensor is along x.
  cloud.ends[20] = {1000, 0, 0};
  cloud.starts[20] = {1010, 0, 0};
  RayCloud out = surface_coloured({}, cloud, ColourByNormal{});
  EXPECT_TRUE(is_rgb(out.colours[0], 0, 0, 0));
  EXPECT_TRUE(is_rgb(out.colours[20], 255, 128, 128));
  EXPECT_TRUE(is_rgb(surface_coloured({}, cloud, ColourByShape{}).colours[20], 85, 85, 85));
  EXPECT_TRUE(is_rgb(surface_coloured({}, cloud, ColourByBranches{}).colours[20], 51, 51, 51));
  out = surface_coloured({}, cloud, OneColour{{9, 99, 199}}, Shading::lit);
  EXPECT_TRUE(is_rgb(out.colours[0], 9, 99, 199)) << "unbounded: not shaded";
  EXPECT_LT(out.colours[20].blue, 199);
  EXPECT_GT(out.colours[20].blue, 80);
}

TEST(Lit, WhereAlphaChangesWhatIsBounded) {
  RayCloud cloud = level_plane(100);
  cloud.bounded[5] = 0;
  for (const std::uint8_t intensity : {std::uint8_t{0}, std::uint8_t{7}}) {
    const RayCloud out = surface_coloured({}, cloud, SetIntensity{intensity}, Shading::lit);
    for (std::size_t i = 0; i < 100; ++i) {
      EXPECT_TRUE(is_rgb(out.colours[i], 200, 200, 200));
      EXPECT_EQ(out.bounded[i], i != 5 && intensity != 0 ? 1 : 0);
    }
  }
}

}  // namespace
}  // namespace ray
