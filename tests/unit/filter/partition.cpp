#include "split_support.h"

#include <cmath>
#include <limits>
#include <set>

namespace ray {
namespace {

using namespace test;

std::vector<RayCloud> clouds_of(const std::map<PartKey, RayCloud>& parts) {
  std::vector<RayCloud> clouds;
  for (const auto& [key, cloud] : parts)
    clouds.push_back(cloud);
  return clouds;
}

const std::vector<GridOptions>& grids() {
  static const std::vector<GridOptions> all{{.widths = {2, 2, 2}},
                                            {.widths = {0, 0, 3.5}},
                                            {.widths = {4, 0.7, 0}, .period = 0.25},
                                            {.widths = {0, 0, 0}, .period = 0.1},
                                            {.widths = {100, 100, 100}}};
  return all;
}

RC_GTEST_PROP(PartitionByGrid, PiecesAreInTheirCellsAndTheLawHolds, ()) {
  const auto seed = *rc::gen::arbitrary<std::uint64_t>();
  const RayCloud cloud = numbered_cloud(seed, *rc::gen::inRange<std::size_t>(0, 60));
  for (const GridOptions& grid : grids()) {
    const auto parts = partition(cloud, *partition_by_grid(grid));
    for (const auto& [key, part] : parts) {
      RC_ASSERT(!part.empty());
      for (std::size_t i = 0; i < part.size(); ++i) {
        for (int axis = 0; axis < 3; ++axis) {
          const double width = grid.widths[axis];
          const auto index = static_cast<double>(key[static_cast<std::size_t>(axis)]);
          if (width == 0.0) RC_ASSERT(index == 0.0);
          if (width == 0.0) continue;
          for (const double t : {0.0, 0.2, 0.5, 0.9, 1.0}) {
            const double x = (1 - t) * part.starts[i][axis] + t * part.ends[i][axis];
            RC_ASSERT(std::abs(x - index * width) <= 0.5 * width + 1e-9);
          }
          // A bounded end belongs to one cell exactly: the lower border is in it.
          const double end = part.ends[i][axis];
          if (part.bounded[i] != 0) RC_ASSERT(std::floor(end / width + 0.5) == index);
        }
        if (grid.period > 0.0) {
          RC_ASSERT(std::floor(part.times[i] / grid.period + 0.5) == static_cast<double>(key[3]));
        }
      }
    }
    expect_law(cloud, clouds_of(parts));
    if (grid.widths.norm() > 0.0 && !cloud.empty()) expect_restored(cloud, joined(clouds_of(parts)));
  }
}

RC_GTEST_PROP(PartitionByGrid, DoesNotDependOnThreadsAndChunks, ()) {
  const RayCloud cloud = numbered_cloud(*rc::gen::arbitrary<std::uint64_t>(), 80);
  for (const GridOptions& grid :
       {GridOptions{.widths = {3, 3, 0}}, GridOptions{.widths = {5, 5, 5}, .overlap = 1.0}}) {
    const PartitionRulePtr rule = partition_by_grid(grid);
    const auto expected = partition(cloud, *rule, {.threads = 1}, 1000000);
    for (const unsigned threads : {1U, 2U, 3U, 8U}) {
      for (const std::size_t chunk : {1UL, 7UL, 1000UL}) {
        const auto parts = partition(cloud, *rule, {.threads = threads}, chunk);
        RC_ASSERT(parts.size() == expected.size());
        for (const auto& [key, part] : parts)
          RC_ASSERT(same_bits(part, expected.at(key)));
      }
    }
  }
}

TEST(PartitionByGrid, ManyRaysOfFewAndOfManyCellsComeInOrder) {
  const RayCloud cloud = random_cloud(4, {.rays = 60000, .half_extent = 30.0});
  for (const double width : {1.0, 25.0}) {
    const PartitionRulePtr rule = partition_by_grid({.widths = {width, width, 0}, .period = 1000});
    const auto parts = partition(cloud, *rule, {.threads = 2}, 8192);
    EXPECT_GT(parts.size(), width == 1.0 ? 3600U : 8U);
    std::size_t bounded = 0;
    for (const auto& [key, part] : parts) {
      EXPECT_TRUE(std::is_sorted(part.times.begin(), part.times.end()));
      bounded += static_cast<std::size_t>(std::count(part.bounded.begin(), part.bounded.end(), 1));
    }
    EXPECT_EQ(bounded, static_cast<std::size_t>(std::count(cloud.bounded.begin(), cloud.bounded.end(), 1)));
  }
}

RC_GTEST_PROP(PartitionByGridWithOverlap, EachCellIsTheInsideOfItsGrownBox, ()) {
  const RayCloud cloud = numbered_cloud(*rc::gen::arbitrary<std::uint64_t>(), 40);
  const double width = 6.0, overlap = 1.5;
  const auto parts =
      partition(cloud, *partition_by_grid({.widths = {width, width, width}, .overlap = overlap}));
  for (std::int64_t x = -4; x <= 4; ++x) {
    for (std::int64_t y = -4; y <= 4; ++y) {
      for (std::int64_t z = -4; z <= 4; ++z) {
        const Eigen::Vector3d centre =
            width * Eigen::Vector3d(static_cast<double>(x), static_cast<double>(y), static_cast<double>(z));
        const auto rule =
            split_by_box(centre, Eigen::Vector3d::Constant(0.5 * (width + overlap)), Precision::double_);
        const RayCloud expected = split(cloud, *rule).inside;
        const auto part = parts.find({x, y, z, 0});
        if (part == parts.end()) {
          RC_ASSERT(expected.empty());
        } else {
          RC_ASSERT(same_bits(part->second, expected));
        }
      }
    }
  }
}

TEST(PartitionByGrid, RefusesWhatMakesNoSense) {
  const double nan = std::nan("");
  for (const GridOptions& bad :
       {GridOptions{}, GridOptions{.widths = {-1, 1, 1}}, GridOptions{.widths = {1, nan, 1}},
        GridOptions{.widths = {1, HUGE_VAL, 1}}, GridOptions{.widths = {1, 1, 1}, .period = -1.0},
        GridOptions{.widths = {1, 1, 1}, .overlap = -0.1}, GridOptions{.widths = {1, 1, 1}, .overlap = 1.1},
        GridOptions{.widths = {1, 1, 1}, .overlap = nan}}) {
    EXPECT_EQ(code_of([&] { static_cast<void>(partition_by_grid(bad)); }), ErrorCode::usage);
  }
  const RayCloud cloud = random_cloud(2, {.rays = 100});
  const auto refused = [&](const GridOptions& grid) {
    return code_of([&] { static_cast<void>(partition(cloud, *partition_by_grid(grid))); });
  };
  EXPECT_EQ(refused({.widths = {1e-300, 0, 0}}), ErrorCode::out_of_range);
  EXPECT_EQ(refused({.widths = {1e-6, 0, 0}}), ErrorCode::out_of_range);
  EXPECT_EQ(refused({.widths = {1e-6, 0, 0}, .overlap = 1e-7}), ErrorCode::out_of_range);
}

TEST(Partition, RefusesMoreThanTheMostParts) {
  RayCloud cloud = random_cloud(2, {.rays = kMostParts + 1});
  for (std::size_t i = 0; i < cloud.size(); ++i)
    cloud.times[i] = static_cast<double>(i);
  const PartitionRulePtr rule = partition_by_grid({.period = 1.0});
  EXPECT_EQ(code_of([&] { static_cast<void>(partition(cloud, *rule)); }), ErrorCode::out_of_range);
}

RC_GTEST_PROP(PartitionByColour, OneForEachColour, ()) {
  RayCloud cloud =
      numbered_cloud(*rc::gen::arbitrary<std::uint64_t>(), *rc::gen::inRange<std::size_t>(0, 100));
  std::set<PartKey> colours;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    Colour& colour = cloud.colours[i];
    colour.red = static_cast<std::uint8_t>(i % 3);
    colour.green = static_cast<std::uint8_t>(colour.green % 2);
    colour.blue = 255;
    colours.insert({colour.red, colour.green, colour.blue, 0});
  }
  const auto parts = partition(cloud, *partition_by_colour(), {.threads = 2}, 13);
  RC_ASSERT(parts.size() == colours.size());
  for (const auto& [key, part] : parts) {
    RayCloud expected = cloud;
    std::vector<std::uint8_t> mask;
    for (const Colour& c : cloud.colours)
      mask.push_back(PartKey{c.red, c.green, c.blue, 0} == key ? 1 : 0);
    expected.select(mask);
    RC_ASSERT(same_bits(part, expected));
  }
  MemorySource source(cloud, 9);
  RC_ASSERT(count_colours(Context{}, source) == colours.size());
}

}  // namespace
}  // namespace ray
