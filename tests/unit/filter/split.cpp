#include "split_support.h"

#include <cmath>
#include <functional>
#include <limits>

namespace ray {
namespace {

using namespace test;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// A region as a rule, and as an oracle for a point: negative inside, positive outside, about the distance
/// from the border.
struct Region {
  std::string name;
  SplitRulePtr rule;
  std::function<double(const Eigen::Vector3d&)> depth;
};

std::vector<Region> regions(Precision stored) {
  std::vector<Region> all;
  for (const Eigen::Vector3d& p :
       {Eigen::Vector3d(0, 0, 2), Eigen::Vector3d(-3, 0, 0), Eigen::Vector3d(1, -2, 0.5)}) {
    const bool oblique = (p.array() != 0.0).count() > 1;
    all.push_back({oblique ? "oblique plane" : "plane", split_by_plane(p, stored),
                   [p](const Eigen::Vector3d& x) { return (x - p).dot(p) / p.norm(); }});
  }
  const Eigen::Vector3d centre(1, -2, 0), radii(4, 5, 3);
  all.push_back({"box", split_by_box(centre, radii, stored),
                 [=](const Eigen::Vector3d& x) { return ((x - centre).cwiseAbs() - radii).maxCoeff(); }});
  for (const Eigen::Vector3d& b : {Eigen::Vector3d(6, 2, 5), Eigen::Vector3d(-1, -2, 0)}) {
    const Eigen::Vector3d a(-1, -2, 0);
    all.push_back({"capsule", split_by_capsule(a, b, {3.0}, stored), [=](const Eigen::Vector3d& x) {
                     // The nearest of many points of the axis: slow and plain.
                     double nearest = HUGE_VAL;
                     for (int k = 0; k <= 2000; ++k)
                       nearest = std::min(nearest, (x - a - k / 2000.0 * (b - a)).norm());
                     return nearest - 3.0;
                   }});
  }
  return all;
}

/// Samples along every piece lie where the oracle says, but for a film at the border.
void expect_on_side(const RayCloud& pieces, const Region& region, double sign) {
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    for (const double t : {0.0, 0.01, 0.3, 0.5, 0.77, 0.99, 1.0}) {
      const Eigen::Vector3d x = pieces.starts[i] + t * (pieces.ends[i] - pieces.starts[i]);
      RC_ASSERT(sign * region.depth(x) < 1e-4);
    }
  }
}

RC_GTEST_PROP(SplitByRegion, PiecesAreOnTheirSideAndTheLawHolds, ()) {
  const auto seed = *rc::gen::arbitrary<std::uint64_t>();
  const RayCloud cloud = numbered_cloud(seed, *rc::gen::inRange<std::size_t>(0, 40));
  const auto stored = *rc::gen::element(Precision::single, Precision::double_);
  for (const Region& region : regions(stored)) {
    const Halves halves = split(cloud, *region.rule);
    expect_on_side(halves.inside, region, 1.0);
    expect_on_side(halves.outside, region, -1.0);
    const RayCloud all = together({halves.inside, halves.outside});
    RC_ASSERT(lines_of(all, true) == lines_of(cloud, true));
    // A cut rounded to float is off the line by that.
    const double rounding = stored == Precision::single ? 1e-6 : 1e-12;
    RC_ASSERT(std::abs(total_length(all) - total_length(cloud)) <
              rounding * (1.0 + 100.0 * static_cast<double>(cloud.size())));
    RC_ASSERT(halves.counts.inside == halves.inside.size());
    RC_ASSERT(halves.counts.outside == halves.outside.size());
  }
}

RC_GTEST_PROP(SplitByRegion, JoiningRestoresEveryRay, ()) {
  const auto seed = *rc::gen::arbitrary<std::uint64_t>();
  const RayCloud cloud = numbered_cloud(seed, *rc::gen::inRange<std::size_t>(0, 80));
  for (const Region& region : regions(*rc::gen::element(Precision::single, Precision::double_))) {
    const Halves halves = split(cloud, *region.rule);
    expect_restored(cloud, joined({halves.inside, halves.outside}));
    // The order of the clouds does not matter, and halves may be split again.
    const Halves more = split(halves.outside, *regions(Precision::double_)[2].rule);
    expect_restored(cloud, joined({more.outside, more.inside, halves.inside}));
  }
}

RC_GTEST_PROP(SplitByRegion, MeetingPiecesHaveTheSameBitsAndMarks, ()) {
  const RayCloud cloud = numbered_cloud(*rc::gen::arbitrary<std::uint64_t>(), 60);
  for (const Region& region : regions(Precision::double_)) {
    const Halves halves = split(cloud, *region.rule);
    const RayCloud all = together({halves.inside, halves.outside});
    std::map<std::uint32_t, std::vector<std::size_t>> pieces_of;
    for (std::size_t i = 0; i < all.size(); ++i)
      pieces_of[all.extra("number")->values<std::uint32_t>()[i]].push_back(i);
    for (auto& [number, pieces] : pieces_of) {
      const Eigen::Vector3d& start = cloud.starts[number];
      std::sort(pieces.begin(), pieces.end(), [&](std::size_t a, std::size_t b) {
        const auto from = [&](std::size_t i) {  // the last piece may be without length
          return std::pair((all.ends[i] - start).norm(), (all.starts[i] - start).norm());
        };
        return from(a) < from(b);
      });
      RC_ASSERT(pieces.size() <= 3U);
      RC_ASSERT(all.starts[pieces.front()] == start);
      RC_ASSERT(all.ends[pieces.back()] == cloud.ends[number]);
      for (std::size_t k = 0; k < pieces.size(); ++k) {
        const bool last = k + 1 == pieces.size();
        const int marks = (k > 0 ? 1 : 0) + (last ? 0 : 2);
        RC_ASSERT(int{all.extra("clipped")->values<std::uint8_t>()[pieces[k]]} == marks);
        RC_ASSERT(all.bounded[pieces[k]] == (last ? cloud.bounded[number] : 0));
        if (!last) RC_ASSERT(all.ends[pieces[k]] == all.starts[pieces[k + 1]]);
      }
    }
    RC_ASSERT(pieces_of.size() == cloud.size());
  }
}

TEST(SplitByRegion, SplittingASideAgainChangesNothing) {
  const RayCloud cloud = numbered_cloud(8, 2000);
  for (const Precision stored : {Precision::single, Precision::double_}) {
    for (const Region& region : regions(stored)) {
      // Where a ray is nearly parallel to a face that is not across an axis, its cut is uncertain.
      if (region.name == "capsule" || region.name == "oblique plane") continue;
      const Halves once = split(cloud, *region.rule);
      const Halves inside = split(once.inside, *region.rule);
      EXPECT_TRUE(same_bits(inside.inside, once.inside)) << region.name;
      EXPECT_TRUE(inside.outside.empty()) << region.name;
      const Halves outside = split(once.outside, *region.rule);
      EXPECT_TRUE(same_bits(outside.outside, once.outside)) << region.name;
      EXPECT_TRUE(outside.inside.empty()) << region.name;
    }
  }
}

/// Every way to split, with an oracle for a ray.
struct Property {
  SplitRulePtr rule;
  std::function<bool(const RayCloud&, std::size_t)> inside;
};

std::vector<Property> properties() {
  const auto vector_of = [](const Colour& c) {
    return Eigen::Vector3d(c.red / 255.0, c.green / 255.0, c.blue / 255.0);
  };
  const auto length = [](const RayCloud& r, std::size_t i) { return (r.ends[i] - r.starts[i]).norm(); };
  const Eigen::Vector3d v(0.1, -0.3, 0.5), c(0.5, 0.1, 0.0);
  std::vector<Property> all;
  for (const double range : {0.0, 10.0, 1e9}) {
    all.push_back(
        {split_by_range({range}), [=](const RayCloud& r, std::size_t i) { return length(r, i) <= range; }});
  }
  all.push_back({split_by_direction(v), [=](const RayCloud& r, std::size_t i) {
                   return length(r, i) == 0.0 ||
                          (r.ends[i] - r.starts[i]).dot(v) / length(r, i) / v.dot(v) <= 1.0;
                 }});
  all.push_back({split_by_time({0.2}), [](const RayCloud& r, std::size_t i) { return r.times[i] <= 0.2; }});
  for (const double a : {0.0, 0.5, 0.999, 1.0}) {
    all.push_back({split_by_alpha(a), [=](const RayCloud& r, std::size_t i) {
                     const int alpha = r.bounded[i] == 0 ? 0 : std::max<int>(1, r.colours[i].intensity);
                     return a == 1.0 || alpha <= 255.0 * a;
                   }});
  }
  all.push_back({split_by_colour(c), [=](const RayCloud& r, std::size_t i) {
                   return vector_of(r.colours[i]).dot(c) / c.dot(c) <= 1.0;
                 }});
  all.push_back({split_by_single_colour({.red = 3, .green = 4, .blue = 5, .intensity = 9}),
                 [](const RayCloud& r, std::size_t i) {
                   return r.colours[i].red == 3 && r.colours[i].green == 4 && r.colours[i].blue == 5;
                 }});
  return all;
}

RC_GTEST_PROP(SplitByProperty, SortsWholeRaysAsTheOracleSays, ()) {
  RayCloud cloud =
      numbered_cloud(*rc::gen::arbitrary<std::uint64_t>(), *rc::gen::inRange<std::size_t>(0, 150));
  for (std::size_t i = 0; i < cloud.size(); i += 4)
    cloud.colours[i] = {3, 4, static_cast<std::uint8_t>(i % 8 == 0 ? 5 : 6), 200};
  for (const Property& property : properties()) {
    std::vector<std::uint8_t> in(cloud.size()), out(cloud.size());
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      in[i] = property.inside(cloud, i) ? 1 : 0;
      out[i] = in[i] != 0 ? 0 : 1;
    }
    RayCloud inside = cloud, outside = cloud;
    inside.select(in);
    outside.select(out);
    const Halves halves = split(cloud, *property.rule);
    RC_ASSERT(same_bits(halves.inside, inside));
    RC_ASSERT(same_bits(halves.outside, outside));
  }
}

RC_GTEST_PROP(SplitCloud, DoesNotDependOnThreadsAndChunks, ()) {
  const RayCloud cloud = numbered_cloud(*rc::gen::arbitrary<std::uint64_t>(), 300);
  std::vector<SplitRulePtr> rules;
  rules.push_back(split_by_box({1, -2, 0}, {4, 5, 3}, Precision::double_));
  rules.push_back(split_by_range({12.0}));
  for (const SplitRulePtr& rule : rules) {
    const Halves expected = split(cloud, *rule, {.threads = 1}, 1000000);
    for (const unsigned threads : {1U, 2U, 3U, 8U}) {
      for (const std::size_t chunk : {1UL, 7UL, 1000UL}) {
        const Halves halves = split(cloud, *rule, {.threads = threads}, chunk);
        RC_ASSERT(same_bits(halves.inside, expected.inside));
        RC_ASSERT(same_bits(halves.outside, expected.outside));
      }
    }
  }
}

TEST(TimeAt, IsAShareOfTheSpan) {
  RayCloud cloud = random_cloud(3, {.rays = 5});
  cloud.times = {30, 10, 20, 14, 12};
  MemorySource source(cloud, 2);
  const auto at = [&](double fraction) {
    source.rewind();
    return time_at(Context{}, source, fraction).value;
  };
  EXPECT_EQ(at(0.0), 10.0);
  EXPECT_EQ(at(0.25), 15.0);
  EXPECT_EQ(at(1.0), 30.0);
  EXPECT_EQ(code_of([&] { at(1.01); }), ErrorCode::usage);
  EXPECT_EQ(code_of([&] { at(-0.01); }), ErrorCode::usage);
  const RayCloud none;
  MemorySource empty(none);
  EXPECT_EQ(time_at(Context{}, empty, 0.5).value, 0.0);
}

/// The oracle for connected sets: all pairs.
std::vector<std::uint8_t> in_largest_set(const RayCloud& cloud, double gap) {
  std::vector<std::size_t> set(cloud.size());
  for (std::size_t i = 0; i < set.size(); ++i)
    set[i] = i;
  for (bool changed = true; changed;) {
    changed = false;
    for (std::size_t i = 0; i < set.size(); ++i) {
      for (std::size_t j = 0; j < set.size(); ++j) {
        const bool near =
            cloud.bounded[i] != 0 && cloud.bounded[j] != 0 && (cloud.ends[i] - cloud.ends[j]).norm() < gap;
        if (near && set[j] < set[i]) {
          set[i] = set[j];
          changed = true;
        }
      }
    }
  }
  std::vector<std::size_t> sizes(cloud.size(), 0);
  for (std::size_t i = 0; i < set.size(); ++i)
    sizes[set[i]] += cloud.bounded[i] != 0 ? 1 : 0;
  std::vector<std::uint8_t> mask(cloud.size(), 0);
  const auto largest = static_cast<std::size_t>(std::max_element(sizes.begin(), sizes.end()) - sizes.begin());
  for (std::size_t i = 0; i < set.size(); ++i)
    mask[i] = cloud.bounded[i] != 0 && set[i] == largest ? 1 : 0;
  return mask;
}

RC_GTEST_PROP(SplitByGap, KeepsTheLargestConnectedSet, ()) {
  const RayCloud cloud = random_cloud(
      *rc::gen::arbitrary<std::uint64_t>(),
      {.rays = *rc::gen::inRange<std::size_t>(0, 150),
       .centre = *rc::gen::element(Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(500000, 6900000, 10)),
       .half_extent = 3.0});
  for (const double gap : {0.4, 0.9, 1.2, 3.0, 100.0}) {
    MemorySource source(cloud, 7);
    const SplitRulePtr rule = split_by_gap(Context{.threads = 2}, source, {gap});
    const auto mask = in_largest_set(cloud, gap);
    RayCloud expected = cloud;
    expected.select(mask);
    RC_ASSERT(same_bits(split(cloud, *rule).inside, expected));
  }
}

TEST(SplitByGap, GapItselfDoesNotConnect) {
  RayCloud cloud = random_cloud(1, {.rays = 4});
  cloud.ends = {{0, 0, 0}, {1, 0, 0}, {1.5, 0, 0}, {2.75, 0, 0}};
  cloud.bounded = {1, 1, 1, 1};
  MemorySource source(cloud);
  EXPECT_EQ(split(cloud, *split_by_gap(Context{}, source, {1.0})).inside.size(), 2U);
}

TEST(SplitByTrees, IsTheDistanceFromTheWood) {
  Forest forest;
  forest.trees.resize(2);
  forest.trees[0].segments = {{.position = {0, 0, 0}, .radius = 0.5},
                              {.position = {0, 0, 4}, .radius = 0.2, .parent = 0},
                              {.position = {3, 0, 6}, .radius = 0.1, .parent = 1}};
  forest.trees[1].segments = {{.position = {-5, 0, 1}, .radius = 0.3}};
  const auto oracle = [&](const Eigen::Vector3d& x) {  // balls along the axes
    double nearest = (x - Eigen::Vector3d(-5, 0, 1)).norm() - 0.3;
    for (int k = 0; k <= 2000; ++k) {
      const double t = k / 2000.0;
      nearest = std::min(nearest, (x - Eigen::Vector3d(0, 0, 4 * t)).norm() - (0.5 - 0.3 * t));
      nearest = std::min(nearest, (x - Eigen::Vector3d(3 * t, 0, 4 + 2 * t)).norm() - (0.2 - 0.1 * t));
    }
    return nearest;
  };
  const RayCloud cloud = random_cloud(5, {.rays = 3000, .half_extent = 7.0});
  for (const double distance : {-0.1, 0.0, 0.2, 2.0}) {
    const Halves halves = split(cloud, *split_by_trees(forest, {distance}));
    EXPECT_EQ(halves.inside.size() + halves.outside.size(), cloud.size());
    for (const Eigen::Vector3d& end : halves.inside.ends)
      EXPECT_GT(oracle(end), distance - 1e-5);
    for (const Eigen::Vector3d& end : halves.outside.ends)
      EXPECT_LE(oracle(end), distance + 1e-5);
    if (distance >= 0.2) {
      EXPECT_FALSE(halves.outside.empty());
    }
  }
  EXPECT_EQ(split(cloud, *split_by_trees(Forest{}, {1.0})).inside.size(), cloud.size());
  // A limb far larger than the others must not take all memory.
  forest.trees[1].segments.push_back({.position = {9000, 9000, 9000}, .radius = 0.1, .parent = 0});
  EXPECT_FALSE(split(cloud, *split_by_trees(forest, {0.2})).inside.empty());
}

TEST(SplitRules, RefuseWhatMakesNoSense) {
  const auto refused = [](const std::function<SplitRulePtr()>& make) {
    return code_of([&] { static_cast<void>(make()); }) == ErrorCode::usage;
  };
  const auto stored = Precision::double_;
  const RayCloud cloud = random_cloud(1, {.rays = 3});
  for (const Eigen::Vector3d& bad :
       {Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(1, kNaN, 0), Eigen::Vector3d(HUGE_VAL, 0, 0)}) {
    EXPECT_TRUE(refused([&] { return split_by_plane(bad, stored); }));
    EXPECT_TRUE(refused([&] { return split_by_direction(bad); }));
    EXPECT_TRUE(refused([&] { return split_by_colour(bad); }));
    EXPECT_TRUE(refused([&] { return split_by_box({0, 0, 0}, bad, stored); }));
  }
  for (const double bad : {-1.0, kNaN, HUGE_VAL}) {
    EXPECT_TRUE(refused([&] { return split_by_box({0, 0, 0}, {1, bad, 1}, stored); }));
    EXPECT_TRUE(refused([&] { return split_by_capsule({0, 0, 0}, {1, 0, 0}, {bad}, stored); }));
    EXPECT_TRUE(refused([&] { return split_by_range({bad}); }));
    EXPECT_TRUE(refused([&] { return split_by_alpha(bad); }));
    EXPECT_TRUE(refused([&] {
      MemorySource source(cloud);
      return split_by_gap(Context{}, source, {bad});
    }));
  }
  EXPECT_TRUE(refused([&] { return split_by_time({kNaN}); }));
  EXPECT_TRUE(refused([&] { return split_by_alpha(1.5); }));
  EXPECT_TRUE(refused([&] { return split_by_trees({}, {kNaN}); }));
  EXPECT_EQ(code_of([&] {
              MemorySource source(cloud);
              static_cast<void>(split_by_gap(Context{}, source, {1e-9}));
            }),
            ErrorCode::out_of_range);
}

TEST(SplitRules, AColumnClippedOfAnotherTypeIsNotOverwritten) {
  const SplitRulePtr rule = split_by_plane({1, 0, 0}, Precision::double_);
  const auto columns = [&](ScalarType type) { static_cast<void>(rule->columns({{"clipped", type}})); };
  EXPECT_NO_THROW(columns(ScalarType::uint8));
  EXPECT_EQ(code_of([&] { columns(ScalarType::float32); }), ErrorCode::wrong_content);
}

}  // namespace
}  // namespace ray
