/// Comparing clouds: a room in which a box went and another came, and a cupboard that hides a corner.

#include "support/random_cloud.h"

#include <raycloud/core/error.h>
#include <raycloud/core/memory_stream.h>
#include <raycloud/exec/random.h>
#include <raycloud/volume/compare_clouds.h>
#include <raycloud/volume/merge_clouds.h>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace ray {
namespace {

using namespace test;

constexpr double kNowhere = std::numeric_limits<double>::infinity();

CloudComparison compared(const RayCloud& first, const RayCloud& second, const DifferenceRule& rule = {},
                         const Context& context = {}, std::size_t chunk_rays = 1000) {
  MemorySource a(first, chunk_rays), b(second, chunk_rays);
  return compare_clouds(context, a, b, rule);
}

RayCloud written(const RayCloud& rays, const CloudComparison& comparison, std::size_t cloud,
                 std::size_t chunk_rays = 1000) {
  MemorySource source(rays, chunk_rays);
  MemorySink sink(difference_columns(schema_of(rays)));
  const StreamCounts counts =
      write_differences({}, source, comparison.clouds[cloud], comparison.distance, sink);
  EXPECT_EQ(counts.rays_in, counts.rays_out);
  return sink.cloud();
}

std::size_t ends_of(const CloudComparison& comparison, Difference difference) {
  return comparison.of(difference).rays;
}

// The room, 6 x 5 x 2.5 m, without a ceiling.

struct Box {
  Eigen::Vector3d min, max;
};
const Box kRoom{{0, 0, 0}, {6, 5, 2.5}};
const Box kCupboard{{3.8, 3, 0}, {5.2, 3.6, 2.4}};
const Box kChair{{1.5, 1.5, 0.3}, {2.1, 2.1, 1.1}};
const Box kParcel{{3.0, 1.0, 0.4}, {3.5, 1.6, 1.2}};
const Box kHidden{{4.5, 3.65, 0.2}, {4.8, 3.8, 1.0}};  // behind the cupboard

/// Where a ray enters and leaves a box, in lengths of `way`; entering last if it misses.
std::pair<double, double> cross(const Box& box, const Eigen::Vector3d& start, const Eigen::Vector3d& way) {
  const Eigen::Array3d a = (box.min - start).array() / way.array(),
                       b = (box.max - start).array() / way.array();
  return {a.min(b).maxCoeff(), a.max(b).minCoeff()};
}

enum RoomLabel : std::uint8_t { kRoomWall = 0, kOpen = 255 };  // boxes are 1, 2 …

/// A sensor that walks along a wall in half a minute sees the boxes, with 1 cm of noise.
RayCloud room_scan(const std::vector<Box>& boxes, std::uint64_t seed, std::size_t rays = 40000) {
  const RandomStream random(seed, "room");
  RayCloud cloud;
  cloud.set_schema({{"label", ScalarType::uint8}});
  cloud.resize(rays);
  for (std::size_t i = 0; i < rays; ++i) {
    const double part = static_cast<double>(i) / static_cast<double>(rays);
    const Eigen::Vector3d start(0.5 + 3.0 * part, 0.5, 1.4);
    const double angle = 2.0 * std::numbers::pi * random.uniform(i, 0), z = 2.0 * random.uniform(i, 1) - 1.0;
    const double around = std::sqrt(1.0 - z * z);
    const Eigen::Vector3d way(around * std::cos(angle), around * std::sin(angle), z);
    double range = cross(kRoom, start, way).second;
    std::uint8_t label = start.z() + range * z > kRoom.max.z() - 1e-6 ? kOpen : kRoomWall;
    for (std::size_t box = 0; box < boxes.size(); ++box) {
      const auto [enters, leaves] = cross(boxes[box], start, way);
      if (enters < leaves && enters > 0.0 && enters < range) {
        range = enters;
        label = static_cast<std::uint8_t>(box + 1);
      }
    }
    const double noise = 0.02 * (random.uniform(i, 2) + random.uniform(i, 3) - 1.0);
    cloud.starts[i] = start;
    cloud.ends[i] = start + (range + noise) * way;
    cloud.times[i] = 1e5 * static_cast<double>(seed) + 30.0 * part;
    cloud.bounded[i] = label == kOpen ? 0 : 1;
    cloud.colours[i] = {10, 20, 200, static_cast<std::uint8_t>(label == kOpen ? 0 : 77)};
    cloud.extras[0].values<std::uint8_t>()[i] = label;
  }
  return cloud;
}

const RayCloud& monday() {
  static const RayCloud cloud = room_scan({kCupboard, kChair}, 1);
  return cloud;
}
const RayCloud& tuesday() {
  static const RayCloud cloud = room_scan({kCupboard, kParcel}, 2);
  return cloud;
}
constexpr DifferenceRule kTenCentimetres{.distance = 0.1};
constexpr std::uint8_t kSecondBox = 2;

/// How many ends with, and without, a label are of a class.
std::pair<std::size_t, std::size_t> of_class(const RayCloud& cloud, const ComparedEnds& ends,
                                             std::uint8_t label, Difference difference) {
  std::pair<std::size_t, std::size_t> counts;
  const auto labels = cloud.extra("label")->values<std::uint8_t>();
  for (std::size_t i = 0, next = 0; i < cloud.size(); ++i)
    if (cloud.bounded[i] != 0 && ends.differences[next++] == difference)
      ++(labels[i] == label ? counts.first : counts.second);
  return counts;
}

std::size_t labelled(const RayCloud& cloud, std::uint8_t label) {
  const auto labels = cloud.extra("label")->values<std::uint8_t>();
  return static_cast<std::size_t>(std::count(labels.begin(), labels.end(), label));
}

TEST(CompareClouds, ThingsThatWentAndCameAreFound) {
  const CloudComparison comparison = compared(monday(), tuesday(), kTenCentimetres);
  const auto [gone, not_gone] = of_class(monday(), comparison.clouds[0], kSecondBox, Difference::removed);
  const auto [come, not_come] = of_class(tuesday(), comparison.clouds[1], kSecondBox, Difference::added);
  EXPECT_GE(100 * gone, 95 * labelled(monday(), kSecondBox));
  EXPECT_GE(100 * come, 95 * labelled(tuesday(), kSecondBox));
  EXPECT_LE(1000 * (not_gone + not_come), gone + come);
  EXPECT_EQ(ends_of(comparison, Difference::removed), gone + not_gone);
  EXPECT_EQ(ends_of(comparison, Difference::added), come + not_come);
}

TEST(CompareClouds, WhatIsHiddenIsNoDifference) {
  const RayCloud before = room_scan({kHidden}, 3), after = room_scan({kCupboard}, 4);
  const CloudComparison comparison = compared(before, after, {.distance = 0.1, .rays = 1.0});
  const auto [hidden, others] = of_class(before, comparison.clouds[0], 1, Difference::unobserved);
  EXPECT_GT(hidden, 30U);
  EXPECT_GT(others, 500U);                                  // of the walls in its shadow
  EXPECT_EQ(ends_of(comparison, Difference::removed), 0U);  // by whatever number of rays
  // The first scan saw through the cupboard's place. Some ends of the floor are of its foot.
  const auto [cupboard, more] = of_class(after, comparison.clouds[1], 1, Difference::added);
  EXPECT_GE(100 * cupboard, 95 * labelled(after, 1));
  EXPECT_LE(100 * more, cupboard);
}

TEST(CompareClouds, ACloudIsAsItIs) {
  const CloudComparison comparison = compared(monday(), monday());
  EXPECT_EQ(ends_of(comparison, Difference::same), 2 * comparison.clouds[0].differences.size());
  EXPECT_EQ(comparison.similarity, 1.0);
  EXPECT_EQ(comparison.distance, usual_distance(0.0, comparison.distance / 3.0));
  for (const float distance : comparison.clouds[0].distances)
    ASSERT_EQ(distance, 0.0F);
}

TEST(CompareClouds, StaticScenesAreTheSameWithinTheUsualDistance) {
  const CloudComparison comparison = compared(monday(), room_scan({kCupboard, kChair}, 9));
  const double ends =
      static_cast<double>(comparison.clouds[0].differences.size() + comparison.clouds[1].differences.size());
  EXPECT_GE(static_cast<double>(ends_of(comparison, Difference::same)), 0.97 * ends);
  EXPECT_EQ(ends_of(comparison, Difference::removed) + ends_of(comparison, Difference::added), 0U);
}

TEST(CompareClouds, ExchangedCloudsExchangeRemovedAndAdded) {
  const CloudComparison one = compared(monday(), tuesday(), kTenCentimetres);
  const CloudComparison other = compared(tuesday(), monday(), kTenCentimetres);
  for (const auto& [a, b] : {std::pair{Difference::removed, Difference::added},
                             {Difference::added, Difference::removed},
                             {Difference::same, Difference::same},
                             {Difference::unobserved, Difference::unobserved}}) {
    EXPECT_GT(one.of(a).rays, 0U);
    EXPECT_EQ(one.of(a).rays, other.of(b).rays);
    EXPECT_NEAR(one.of(a).area, other.of(b).area, 1e-9 * one.of(a).area);
    EXPECT_EQ(one.of(a).volume, other.of(b).volume);
  }
  EXPECT_NEAR(*one.similarity, *other.similarity, 1e-12);
  EXPECT_EQ(one.clouds[0].distances, other.clouds[1].distances);
}

TEST(CompareClouds, CloudsFarApartHaveNothingInCommon) {
  RayCloud moved = monday();
  moved.transform(translation_pose({100.0, 0.0, 0.0}));
  const CloudComparison comparison = compared(monday(), moved);
  EXPECT_EQ(ends_of(comparison, Difference::unobserved), 2 * comparison.clouds[0].differences.size());
  EXPECT_FALSE(comparison.similarity);
  EXPECT_EQ(comparison.clouds[0].distances.front(), kNowhere);
}

/// Those that raycombine min would take out, unless they are within the distance.
TEST(CompareClouds, AgreesWithMerging) {
  const CloudComparison comparison = compared(monday(), tuesday(), {.distance = 0.1, .rays = 7.0});
  MemorySource a(monday()), b(tuesday());
  const std::array<RaySource*, 2> clouds{&a, &b};
  MemorySink stays(schema_of(monday())), gone(schema_of(monday()));
  merge_clouds({}, clouds, stays, &gone, {.merge = CloudMerge::min, .rays = 7.0});
  std::vector<double> expected, found;  // times, which no two rays share
  for (std::size_t i = 0; i < gone.cloud().size(); ++i)
    expected.push_back(gone.cloud().times[i]);
  std::size_t near = 0;
  for (std::size_t cloud = 0; cloud < 2; ++cloud) {
    const RayCloud& rays = cloud == 0 ? monday() : tuesday();
    for (std::size_t i = 0, next = 0; i < rays.size(); ++i) {
      if (rays.bounded[i] == 0) continue;
      const Difference difference = comparison.clouds[cloud].differences[next++];
      if (difference == Difference::removed || difference == Difference::added) {
        found.push_back(rays.times[i]);
      } else if (difference == Difference::same) {
        near += std::erase(expected, rays.times[i]);
      }
    }
  }
  EXPECT_GT(found.size(), 1000U);
  EXPECT_LT(near, found.size() / 10);
  EXPECT_EQ(found, expected);
}

TEST(CompareClouds, NeitherThreadsNorChunksMatter) {
  const CloudComparison first = compared(monday(), tuesday(), kTenCentimetres, {.threads = 1});
  const RayCloud before = written(monday(), first, 0);
  for (const unsigned threads : {2U, 8U})
    for (const std::size_t chunk : {std::size_t{7}, std::size_t{1000000}}) {
      const CloudComparison other =
          compared(monday(), tuesday(), kTenCentimetres, {.threads = threads}, chunk);
      for (std::size_t cloud = 0; cloud < 2; ++cloud) {
        EXPECT_EQ(first.clouds[cloud].differences, other.clouds[cloud].differences);
        EXPECT_EQ(first.clouds[cloud].distances, other.clouds[cloud].distances);
      }
      for (std::size_t kind = 0; kind < kDifferences; ++kind) {
        EXPECT_EQ(first.totals[kind].area, other.totals[kind].area);
        EXPECT_EQ(first.totals[kind].volume, other.totals[kind].volume);
      }
      EXPECT_TRUE(same_bits(before, written(monday(), other, 0, chunk)));
    }
}

TEST(CompareClouds, TheOrderOfTheRaysDoesNotMatter) {
  // So few that no sample of them is taken.
  const RayCloud a = room_scan({kChair}, 5, 4000), b = room_scan({}, 6, 4000);
  RayCloud backwards = a;
  std::vector<std::uint32_t> rows(a.size());
  for (std::size_t i = 0; i < rows.size(); ++i)
    rows[i] = static_cast<std::uint32_t>(rows.size() - 1 - i);
  backwards.keep_rows(rows);
  const CloudComparison one = compared(a, b, {.distance = 0.1, .rays = 3.0});
  CloudComparison other = compared(backwards, b, {.distance = 0.1, .rays = 3.0});
  EXPECT_GT(ends_of(one, Difference::removed), 20U);
  std::reverse(other.clouds[0].differences.begin(), other.clouds[0].differences.end());
  EXPECT_EQ(one.clouds[0].differences, other.clouds[0].differences);
  EXPECT_EQ(one.clouds[1].differences, other.clouds[1].differences);
  EXPECT_NEAR(*one.similarity, *other.similarity, 1e-12);
}

/// Ellipsoids are rounded, so that places which just enough rays see through may change.
TEST(CompareClouds, MovingBothChangesNoClass) {
  const CloudComparison before = compared(monday(), tuesday(), kTenCentimetres);
  RayCloud a = monday(), b = tuesday();
  Pose pose = rotation_pose({0.2, 0.4, 0.5});
  pose.translation = {500.0, -300.0, 20.0};
  a.transform(pose);
  b.transform(pose);
  const CloudComparison after = compared(a, b, kTenCentimetres);
  std::size_t other_class = 0;
  for (std::size_t cloud = 0; cloud < 2; ++cloud)
    for (std::size_t i = 0; i < before.clouds[cloud].differences.size(); ++i) {
      const Difference one = before.clouds[cloud].differences[i], two = after.clouds[cloud].differences[i];
      ASSERT_EQ(one == Difference::same, two == Difference::same);
      other_class += one != two ? 1 : 0;
    }
  EXPECT_LE(other_class, 3U);
}

RC_GTEST_PROP(CompareClouds, SameAreEndsWithAnEndOfTheOtherWithinTheDistance, ()) {
  const auto seed = *rc::gen::arbitrary<std::uint64_t>();
  const Eigen::Vector3d centre =
      *rc::gen::element(Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(5e5, 6.9e6, 100.0));
  const double extent = *rc::gen::element(0.01, 0.5, 3.0);
  RayCloud clouds[2] = {
      random_cloud(seed,
                   {.rays = *rc::gen::inRange<std::size_t>(0, 200), .centre = centre, .half_extent = extent}),
      random_cloud(seed + 1, {.rays = 150, .centre = centre, .half_extent = extent})};
  if (*rc::gen::arbitrary<bool>())
    for (RayCloud& cloud : clouds)
      for (Eigen::Vector3d& end : cloud.ends)
        end = (end * 8.0).array().round() / 8.0;  // so that many are exactly at the distance
  const double distance = *rc::gen::element(0.125, 0.25, 0.03, 2.0);
  const CloudComparison comparison = compared(clouds[0], clouds[1], {.distance = distance});
  for (std::size_t own = 0; own < 2; ++own)
    for (std::size_t i = 0, next = 0; i < clouds[own].size(); ++i) {
      if (clouds[own].bounded[i] == 0) continue;
      double nearest2 = kNowhere;
      for (std::size_t j = 0; j < clouds[1 - own].size(); ++j) {
        if (clouds[1 - own].bounded[j] == 0) continue;
        const Eigen::Vector3d d = clouds[1 - own].ends[j] - clouds[own].ends[i];
        nearest2 = std::min(nearest2, d.x() * d.x() + d.y() * d.y() + d.z() * d.z());
      }
      RC_ASSERT((comparison.clouds[own].differences[next] == Difference::same) ==
                (nearest2 <= distance * distance));
      const double shown = nearest2 <= 4.0 * distance * distance ? std::sqrt(nearest2) : kNowhere;
      RC_ASSERT(comparison.clouds[own].distances[next++] == static_cast<float>(shown));
    }
}

/// Random points of a square of 4 m, denser on one side; in one of two clouds a smaller one before it.
TEST(CompareClouds, AreasAreThoseOfTheSurfaces) {
  const auto squares = [](bool both, std::uint64_t seed) {
    const RandomStream random(seed, "squares");
    RayCloud cloud;
    cloud.resize(40000);
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      const double x = random.uniform(i, 0);
      const Eigen::Vector3d end(4.0 * x * x, 4.0 * random.uniform(i, 1), 0.0);
      const Eigen::Vector3d start(2.0, 2.0, 3.0 + random.uniform(i, 2));
      const Eigen::Vector3d at = start + (start.z() - 1.0) / start.z() * (end - start);
      const bool on_small = both && (at - Eigen::Vector3d(2, 2, 1)).lpNorm<Eigen::Infinity>() < 0.5;
      cloud.starts[i] = start;
      cloud.ends[i] = on_small ? at : end;
      cloud.bounded[i] = 1;
      cloud.times[i] = static_cast<double>(i) * 1e-3;
    }
    return cloud;
  };
  const CloudComparison alike = compared(squares(false, 1), squares(false, 2), {.distance = 0.15});
  EXPECT_NEAR(alike.of(Difference::same).area, 16.0, 0.5);
  const CloudComparison comparison = compared(squares(true, 1), squares(false, 2), {.distance = 0.15});
  EXPECT_NEAR(comparison.of(Difference::removed).area, 1.0, 0.1);
  EXPECT_EQ(comparison.of(Difference::added).area, 0.0);
  // A shadow of 2 m² is only in the second cloud.
  const double same = comparison.of(Difference::same).area;
  EXPECT_NEAR(same, 15.0, 0.5);
  EXPECT_DOUBLE_EQ(*comparison.similarity, same / (same + comparison.of(Difference::removed).area));
  // One layer of cubes, or two where the plane is their border.
  const double layer = comparison.of(Difference::removed).volume / comparison.distance;
  EXPECT_GT(layer, 0.9);
  EXPECT_LT(layer, 1.5);
}

TEST(CompareClouds, ColoursShowTheDifference) {
  std::size_t part = 0, full = 0;
  for (const double at : {0.1, 0.5}) {
    const CloudComparison comparison = compared(monday(), tuesday(), {.distance = at});
    const RayCloud result = written(tuesday(), comparison, 1);
    const auto column = result.extra("difference")->values<std::uint8_t>();
    for (std::size_t i = 0, next = 0; i < result.size(); ++i) {
      const Colour& colour = result.colours[i];
      const Colour& before = tuesday().colours[i];
      ASSERT_EQ(colour.intensity, before.intensity);
      if (result.bounded[i] == 0) {
        ASSERT_EQ(column[i], 0);
        ASSERT_EQ(colour, before);
        continue;
      }
      const double times_distance = static_cast<double>(comparison.clouds[1].distances[next]) / at;
      const Difference difference = comparison.clouds[1].differences[next++];
      ASSERT_EQ(column[i], static_cast<std::uint8_t>(difference));
      if (difference == Difference::same) {
        ASSERT_EQ(colour, before);
      } else if (difference == Difference::unobserved) {
        ASSERT_EQ(colour, (Colour{128, 128, 128, 77}));
      } else if (times_distance >= 2.0) {
        ASSERT_EQ(colour, (Colour{0, 255, 127, 77}));
        ++full;
      } else {
        // Half-way at the distance.
        ASSERT_NEAR(colour.red, 10.0 - 5.0 * times_distance, 1.0);
        ASSERT_NEAR(colour.green, 20.0 + 117.5 * times_distance, 1.0);
        ASSERT_NEAR(colour.blue, 200.0 - 36.5 * times_distance, 1.0);
        ++part;
      }
    }
  }
  EXPECT_GT(full, 100U);
  EXPECT_GT(part, 100U);
}

TEST(CompareClouds, OnlyColoursAndTheColumnChange) {
  const CloudComparison comparison = compared(monday(), tuesday(), kTenCentimetres);
  RayCloud result = written(monday(), comparison, 0);
  const auto reds = std::count(result.colours.begin(), result.colours.end(), Colour{255, 0, 127, 77});
  EXPECT_GT(reds, 100);
  // A second comparison replaces the column.
  const auto column = result.extra("difference")->values<std::uint8_t>();
  const std::vector<std::uint8_t> once(column.begin(), column.end());
  std::fill(column.begin(), column.end(), std::uint8_t{9});
  const RayCloud again = written(result, comparison, 0);
  const auto twice = again.extra("difference")->values<std::uint8_t>();
  EXPECT_TRUE(std::equal(once.begin(), once.end(), twice.begin(), twice.end()));
  EXPECT_EQ(again.extras.size(), 2U);
  result.colours = monday().colours;
  result.extras.pop_back();
  EXPECT_TRUE(same_bits(result, monday()));
}

TEST(CompareClouds, CloudsOfWhichNothingCanBeTold) {
  RayCloud none, unbounded, one, not_finite;
  one.resize(1);
  one.bounded[0] = 1;
  one.starts[0] = {0, 0, 2};
  one.ends[0] = {0, 0, 0};
  one.times[0] = 0.0;
  unbounded = one;
  unbounded.bounded[0] = 0;
  not_finite = one;
  not_finite.append(one);
  not_finite.ends[0].x() = std::numeric_limits<double>::quiet_NaN();
  for (const RayCloud* cloud : {&none, &unbounded}) {
    EXPECT_FALSE(compared(*cloud, *cloud).similarity);
    EXPECT_FALSE(compared(*cloud, one).similarity);
    EXPECT_EQ(ends_of(compared(one, *cloud), Difference::unobserved), 1U);
  }
  EXPECT_EQ(compared(one, one).similarity, 1.0);
  const CloudComparison comparison = compared(not_finite, one);
  EXPECT_EQ(comparison.dropped, 1U);
  EXPECT_EQ(ends_of(comparison, Difference::same), 2U);
  const auto code_of = [&](const DifferenceRule& rule) {
    try {
      static_cast<void>(compared(one, one, rule));
    } catch (const Error& error) {
      return error.code();
    }
    return ErrorCode::no_data;
  };
  EXPECT_EQ(code_of({.distance = -1.0}), ErrorCode::usage);
  EXPECT_EQ(code_of({.distance = kNowhere}), ErrorCode::usage);
  EXPECT_EQ(code_of({.rays = 0.0}), ErrorCode::usage);
  EXPECT_THROW(static_cast<void>(difference_columns({{"difference", ScalarType::float32}})), Error);
}

}  // namespace
}  // namespace ray
