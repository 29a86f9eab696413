#include "support/random_cloud.h"

#include <raycloud/core/error.h>
#include <raycloud/core/memory_stream.h>
#include <raycloud/core/ray_cloud.h>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <limits>

namespace ray {
namespace {

using test::random_cloud;
using test::same_bits;

RayCloud any_cloud(std::size_t max_rays = 200) {
  return random_cloud(
      *rc::gen::arbitrary<std::uint64_t>(),
      {.rays = *rc::gen::inRange<std::size_t>(0, max_rays), .extras = test::schema_of_every_type()});
}

TEST(ScalarType, KnowsItsCppTypeSizeAndName) {
  for (const ScalarType type : test::kAllScalarTypes) {
    visit_scalar(type, [&]<class T>() {
      EXPECT_EQ(scalar_type_of<T>(), type);
      EXPECT_EQ(size_of(type), sizeof(T));
    });
  }
  EXPECT_EQ(name_of(ScalarType::uint16), "uint16");
  EXPECT_EQ(name_of(ScalarType::float64), "float64");
}

RC_GTEST_PROP(RayCloud, SelectKeepsTheMaskedRowsOfEveryColumnInOrder, ()) {
  const RayCloud cloud = any_cloud();
  const auto mask =
      *rc::gen::container<std::vector<std::uint8_t>>(cloud.size(), rc::gen::inRange<std::uint8_t>(0, 3));
  RayCloud kept = cloud;
  kept.select(mask);
  // The oracle goes ray by ray through single-row clouds.
  RayCloud expected;
  expected.set_schema(schema_of(cloud));
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (mask[i] == 0) continue;
    MemorySource one(cloud, 1);
    RawChunk raw{{}, i, 1};
    RayCloud row;
    one.decode(raw, row);
    expected.append(row);
  }
  RC_ASSERT(same_bits(kept, expected));
}

RC_GTEST_PROP(RayCloud, KeepsRowsInTheirOrderAndInAnyOther, ()) {
  const RayCloud cloud = any_cloud();
  auto rows = *rc::gen::container<std::vector<std::uint32_t>>(
      rc::gen::inRange<std::uint32_t>(0, static_cast<std::uint32_t>(cloud.size()) + 1));
  std::erase(rows, static_cast<std::uint32_t>(cloud.size()));
  if (*rc::gen::arbitrary<bool>()) std::sort(rows.begin(), rows.end());
  if (*rc::gen::arbitrary<bool>()) rows.erase(std::unique(rows.begin(), rows.end()), rows.end());
  // The oracle goes ray by ray through single-row clouds.
  RayCloud expected;
  expected.set_schema(schema_of(cloud));
  for (const std::uint32_t i : rows) {
    MemorySource one(cloud, 1);
    RayCloud row;
    one.decode(RawChunk{{}, i, 1}, row);
    expected.append(row);
  }
  RayCloud kept = cloud;
  kept.keep_rows(rows);
  RC_ASSERT(same_bits(kept, expected));
  RayCloud assigned = any_cloud();
  assigned.assign_rows(cloud, rows);
  RC_ASSERT(same_bits(assigned, expected));
}

RC_GTEST_PROP(RayCloud, AppendingTheTwoSidesOfASplitGivesTheCloud, ()) {
  const RayCloud cloud = any_cloud();
  const std::size_t cut = *rc::gen::inRange<std::size_t>(0, cloud.size() + 1);
  RayCloud head = cloud;
  RayCloud tail = cloud;
  std::vector<std::uint8_t> first(cloud.size());
  std::fill_n(first.begin(), cut, std::uint8_t{1});
  head.select(first);
  for (auto& keep : first)
    keep ^= 1;
  tail.select(first);
  head.append(tail);
  RC_ASSERT(same_bits(head, cloud));
}

TEST(RayCloud, AppendMatchesColumnsByNameAndFillsMissingOnesWithZero) {
  RayCloud a = random_cloud(1, {.rays = 2, .extras = {{"classification", ScalarType::uint8}}});
  const RayCloud b = random_cloud(2, {.rays = 3, .extras = {{"tree_id", ScalarType::int32}}});
  const std::uint8_t class_of_first = a.extra("classification")->values<std::uint8_t>()[0];
  a.append(b);
  ASSERT_EQ(a.size(), 5U);
  EXPECT_EQ(a.extra("classification")->values<std::uint8_t>()[0], class_of_first);
  EXPECT_EQ(a.extra("classification")->values<std::uint8_t>()[4], 0);
  EXPECT_EQ(a.extra("tree_id")->values<std::int32_t>()[1], 0);
  EXPECT_EQ(a.extra("tree_id")->values<std::int32_t>()[2], b.extra("tree_id")->values<std::int32_t>()[0]);
}

TEST(RayCloud, AppendRefusesOneNameWithTwoTypes) {
  RayCloud a = random_cloud(1, {.rays = 1, .extras = {{"id", ScalarType::uint8}}});
  const RayCloud b = random_cloud(2, {.rays = 1, .extras = {{"id", ScalarType::int32}}});
  EXPECT_THROW(a.append(b), Error);
}

RC_GTEST_PROP(MemoryStream, RoundTripKeepsEveryBitForEveryChunkSize, ()) {
  const RayCloud cloud = any_cloud();
  MemorySource source(cloud, *rc::gen::element<std::size_t>(1, 7, 1000000));
  MemorySink sink(source.info().extras);
  RawChunk raw;
  RayCloud rays;
  while (source.fetch(raw)) {
    RC_ASSERT(source.decode(raw, rays) == 0U);
    sink.encode(rays, raw);
    sink.write(raw);
  }
  sink.finish();
  RC_ASSERT(sink.finished());
  RC_ASSERT(same_bits(sink.cloud(), cloud));
}

TEST(MemoryStream, LeavesOutAndCountsRaysThatAreNotFinite) {
  RayCloud cloud = random_cloud(3, {.rays = 10});
  cloud.ends[2].y() = std::numeric_limits<double>::quiet_NaN();
  cloud.starts[5].z() = std::numeric_limits<double>::infinity();
  cloud.times[9] = std::numeric_limits<double>::quiet_NaN();
  MemorySource source(cloud);
  RawChunk raw;
  RayCloud rays;
  ASSERT_TRUE(source.fetch(raw));
  EXPECT_EQ(source.decode(raw, rays), 3U);
  EXPECT_EQ(rays.size(), 7U);
  EXPECT_EQ(rays.ends[2], cloud.ends[3]);
}

}  // namespace
}  // namespace ray
