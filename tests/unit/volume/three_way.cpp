/// Two branches of a map: whatever one of them changed is in the result.

#include "support/random_cloud.h"

#include <raycloud/core/error.h>
#include <raycloud/core/memory_stream.h>
#include <raycloud/exec/stream.h>
#include <raycloud/volume/merge_clouds.h>
#include <raycloud/volume/three_way.h>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cstring>
#include <map>
#include <set>
#include <string>

namespace ray {
namespace {

using namespace test;

struct Branches {
  RayCloud base, one, two;
};

/// The kept rays and, after them, the merge of what was added.
RayCloud merged_branches(const Branches& of, CloudMerge kind, const Context& context = {},
                         std::size_t chunk_rays = 100) {
  MemorySource base(of.base, chunk_rays), one(of.one, chunk_rays), two(of.two, chunk_rays);
  const ThreeWay parts(context, {&base, &one, &two},
                       three_way_columns({schema_of(of.base), schema_of(of.one), schema_of(of.two)}));
  MemorySink result(schema_of(of.base)), differences(schema_of(of.base));
  stream_each(context, *parts.kept(), result, [](const RayCloud&) {});
  const auto added1 = parts.added(0), added2 = parts.added(1);
  const std::array<RaySource*, 2> added{added1.get(), added2.get()};
  const MergeCounts counts = merge_clouds(context, added, result, &differences, {.merge = kind, .rays = 2.0});
  EXPECT_EQ(parts.counts().kept + counts.combined, result.cloud().size());
  EXPECT_EQ(parts.counts().base, of.base.size());
  return result.cloud();
}

/// How often each ray is there, by all its bytes.
using Multiset = std::map<std::string, int>;
Multiset multiset_of(const RayCloud& cloud) {
  Multiset rays;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    std::string bytes;
    const auto add = [&](const void* data, std::size_t size) {
      bytes.append(static_cast<const char*>(data), size);
    };
    add(cloud.starts[i].data(), sizeof cloud.starts[i]);
    add(cloud.ends[i].data(), sizeof cloud.ends[i]);
    add(&cloud.times[i], sizeof cloud.times[i]);
    add(&cloud.colours[i], sizeof cloud.colours[i]);
    add(&cloud.bounded[i], 1);
    for (const Column& column : cloud.extras)
      add(column.data() + i * column.stride(), column.stride());
    ++rays[bytes];
  }
  return rays;
}

int times_in(const Multiset& rays, const std::string& ray) {
  const auto found = rays.find(ray);
  return found == rays.end() ? 0 : found->second;
}

/// Removes, copies, recolours, moves and adds rays, of `more` too, and turns the order round.
RayCloud edited(const RayCloud& base, const RayCloud& more) {
  RayCloud cloud = base;
  const auto some_of = [](std::size_t size) {
    return *rc::gen::container<std::vector<std::uint32_t>>(
        *rc::gen::inRange<std::size_t>(0, 8),
        rc::gen::inRange<std::uint32_t>(0, static_cast<std::uint32_t>(size)));
  };
  if (!cloud.empty()) {
    RayCloud copies;
    copies.assign_rows(cloud, some_of(cloud.size()));
    for (const std::uint32_t row : some_of(cloud.size()))
      cloud.colours[row].red ^= 1;
    for (const std::uint32_t row : some_of(cloud.size()))
      cloud.ends[row].x() = std::nextafter(cloud.ends[row].x(), 1e9);
    for (const std::uint32_t row : some_of(cloud.size()))
      cloud.extras[0].values<double>()[row] += 1.0;
    std::vector<std::uint8_t> stays(cloud.size(), 1);
    for (const std::uint32_t row : some_of(cloud.size()))
      stays[row] = 0;
    cloud.select(stays);
    cloud.append(copies);
  }
  RayCloud added;
  added.assign_rows(more, some_of(more.size()));
  cloud.append(added);
  if (*rc::gen::element(false, true)) {
    std::vector<std::uint32_t> backwards(cloud.size());
    for (std::uint32_t i = 0; i < backwards.size(); ++i)
      backwards[i] = static_cast<std::uint32_t>(backwards.size()) - 1 - i;
    RayCloud turned;
    turned.assign_rows(cloud, backwards);
    cloud = turned;
  }
  return cloud;
}

Branches random_branches() {
  const std::vector<ColumnInfo> extras{{"mine", ScalarType::float64}};
  const auto cloud = [&](std::size_t most) {
    return random_cloud(
        *rc::gen::arbitrary<std::uint64_t>(),
        {.rays = *rc::gen::inRange<std::size_t>(0, most), .half_extent = 3.0, .extras = extras});
  };
  RayCloud base = cloud(60);
  base.append(cloud(3));
  if (base.size() > 2) {  // some rays twice
    RayCloud copies;
    const std::array<std::uint32_t, 3> rows{0, 1, 1};
    copies.assign_rows(base, rows);
    base.append(copies);
  }
  RayCloud more = random_cloud(17, {.rays = 12, .half_extent = 3.0, .extras = extras});
  more.append(base);
  const RayCloud one = edited(base, more), two = edited(base, more);
  return {base, one, two};
}

RC_GTEST_PROP(ThreeWay, everyChangeThatDoesNotConflictIsInTheResult, ()) {
  const Branches branches = random_branches();
  const Multiset base = multiset_of(branches.base), one = multiset_of(branches.one),
                 two = multiset_of(branches.two);
  const RayCloud result = merged_branches(branches, CloudMerge::all);
  const Multiset merged = multiset_of(result);
  std::set<std::string> rays;
  for (const Multiset* of : {&base, &one, &two, &merged})
    for (const auto& [ray, count] : *of)
      rays.insert(ray);
  for (const std::string& ray : rays) {
    const int before = times_in(base, ray), after = times_in(merged, ray);
    const int by_one = times_in(one, ray) - before, by_two = times_in(two, ray) - before;
    if (by_one == 0 || by_two == 0 || (by_one > 0) != (by_two > 0))
      RC_ASSERT(after == before + by_one + by_two);
    else if (by_one > 0)  // both added it: identical additions come once
      RC_ASSERT(after == before + std::max(by_one, by_two));
    else
      RC_ASSERT(after == before + std::min(by_one, by_two));
  }
  for (const unsigned threads : {1U, 8U})
    for (const std::size_t chunk : {1UL, 1000000UL})
      RC_ASSERT(same_bits(merged_branches(branches, CloudMerge::all, {.threads = threads}, chunk), result));
}

RC_GTEST_PROP(ThreeWay, aBranchThatIsTheBaseChangesNothing, ()) {
  Branches branches = random_branches();
  branches.two = branches.base;
  for (const CloudMerge kind : {CloudMerge::all, CloudMerge::min, CloudMerge::max, CloudMerge::order})
    RC_ASSERT(multiset_of(merged_branches(branches, kind)) == multiset_of(branches.one));
  std::swap(branches.one, branches.two);
  RC_ASSERT(multiset_of(merged_branches(branches, CloudMerge::all)) == multiset_of(branches.two));
}

RC_GTEST_PROP(ThreeWay, branchesWithTheSameChangesAreTheResult, ()) {
  Branches branches = random_branches();
  branches.two = branches.one;
  for (const CloudMerge kind : {CloudMerge::all, CloudMerge::min, CloudMerge::max})
    RC_ASSERT(multiset_of(merged_branches(branches, kind)) == multiset_of(branches.one));
}

TEST(ThreeWay, aBranchThatDeletedEverything) {
  const std::vector<ColumnInfo> extras{{"mine", ScalarType::float64}};
  Branches branches;
  branches.base = random_cloud(1, {.rays = 50, .extras = extras});
  branches.one.set_schema(extras);
  branches.two = branches.base;
  const RayCloud added = random_cloud(2, {.rays = 5, .extras = extras});
  branches.two.append(added);
  EXPECT_TRUE(same_bits(merged_branches(branches, CloudMerge::all), added));
}

TEST(ThreeWay, unchangedRaysKeepTheOrderOfTheBase) {
  const std::vector<ColumnInfo> extras{{"mine", ScalarType::float64}};
  const RayCloud base = random_cloud(1, {.rays = 50, .extras = extras});
  EXPECT_TRUE(same_bits(merged_branches({base, base, base}, CloudMerge::min), base));
}

TEST(ThreeWay, columns) {
  const ColumnInfo a{"a", ScalarType::uint8}, b{"b", ScalarType::uint8}, c{"c", ScalarType::uint8};
  using Names = std::vector<std::string>;
  ThreeWayColumns columns = three_way_columns({{{a, b}, {a, b}, {a, b}}});
  EXPECT_EQ(columns.compared, (Names{"a", "b"}));
  EXPECT_EQ(columns.result, columns.compared);
  EXPECT_EQ(columns.kept_from, 0U);
  columns = three_way_columns({{{a, b}, {a, b}, {a, c}}});  // one added, one taken out
  EXPECT_EQ(columns.compared, Names{"a"});
  EXPECT_EQ(columns.result, (Names{"a", "c"}));
  EXPECT_EQ(columns.kept_from, 2U);
  columns = three_way_columns({{{a}, {b, a, c}, {a, c}}});
  EXPECT_EQ(columns.result, (Names{"a", "b", "c"}));
  EXPECT_EQ(columns.kept_from, 1U);
  EXPECT_THROW(static_cast<void>(three_way_columns({{{}, {a}, {b}}})), Error);
}

/// What is added to a map by both branches is merged, what was there is not touched.
TEST(ThreeWay, onlyAdditionsAreMerged) {
  Branches branches;
  RayCloud wall;  // in z = 0, hit from above
  RayCloud through;
  const RandomStream random(1, "wall");
  for (RayCloud* cloud : {&wall, &through}) {
    cloud->resize(4000);
    for (std::size_t i = 0; i < cloud->size(); ++i) {
      const bool passes = cloud == &through;
      const Eigen::Vector3d at(2.0 * random.uniform(i, passes ? 2 : 0),
                               2.0 * random.uniform(i, passes ? 3 : 1), 0.0);
      cloud->starts[i] = at + Eigen::Vector3d(0.2 * static_cast<double>(i % 7) - 0.6, 0.1, 3.0);
      cloud->ends[i] = passes ? at - 0.5 * (cloud->starts[i] - at) : at;
      cloud->times[i] = 0.01 * static_cast<double>(i) + (passes ? 100.0 : 0.0);
      cloud->bounded[i] = 1;
    }
  }
  branches.base = branches.one = branches.two = wall;
  branches.two.append(through);
  // What sees through the base is no conflict between the branches.
  EXPECT_EQ(merged_branches(branches, CloudMerge::min).size(), 8000U);
  // But it is if a branch has added the wall.
  branches.base = RayCloud();
  branches.two = through;
  const RayCloud merged = merged_branches(branches, CloudMerge::min);
  EXPECT_LT(merged.size(), 4100U);
  EXPECT_GE(merged.size(), 4000U);
}

}  // namespace
}  // namespace ray
