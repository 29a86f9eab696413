#include "split_support.h"

#include <cmath>
#include <limits>

namespace ray {
namespace {

using namespace test;

RayCloud read(CombinedSource& source, unsigned threads) {
  source.rewind();
  return read_all(Context{.threads = threads}, source);
}

RC_GTEST_PROP(CombinedSource, HasEveryRayOfEveryCloudInOrder, ()) {
  const auto seed = *rc::gen::arbitrary<std::uint64_t>();
  std::vector<RayCloud> clouds;
  for (std::size_t k = 0; k < 5; ++k) {
    clouds.push_back(random_cloud(
        seed + k, {.rays = *rc::gen::inRange<std::size_t>(0, 80), .extras = schema_of_every_type()}));
  }
  RayCloud expected;
  for (const RayCloud& cloud : clouds)
    expected.append(cloud);
  for (const unsigned threads : {1U, 2U, 3U, 8U}) {
    for (const std::size_t chunk : {1UL, 7UL, 1000UL}) {
      CombinedSource source = combined(clouds, chunk);
      RC_ASSERT(source.notes().empty() && source.warnings().empty());
      RC_ASSERT(source.info().ray_count == expected.size());
      RC_ASSERT(same_bits(read(source, threads), expected));
      RC_ASSERT(same_bits(read(source, threads), expected));
    }
  }
}

/// One cloud after the other is all of them, as often as they are read, in any order.
TEST(CombinedSource, EachCloudAloneHasTheColumnsOfAll) {
  std::vector<RayCloud> clouds;
  clouds.push_back(random_cloud(1, {.rays = 30, .extras = {{"a", ScalarType::uint16}}}));
  clouds.push_back(RayCloud());
  clouds.push_back(
      random_cloud(2, {.rays = 20, .extras = {{"b", ScalarType::int8}, {"a", ScalarType::int16}}}));
  CombinedSource source = combined(clouds, 7);
  std::vector<std::unique_ptr<RaySource>> each;
  for (std::size_t i = 0; i < source.cloud_count(); ++i)
    each.push_back(source.alone(i));
  for (int times = 0; times < 2; ++times) {
    RayCloud all;
    all.set_schema(source.info().extras);
    for (std::size_t i = 0; i < each.size(); ++i) {
      EXPECT_EQ(each[i]->info().extras, source.info().extras);
      EXPECT_EQ(each[i]->info().ray_count, clouds[i].size());
      all.append(read_all({.threads = 2}, *each[i]));
      each[i]->rewind();
    }
    EXPECT_TRUE(same_bits(all, read(source, 2)));
  }
}

TEST(CombinedSource, FillsColumnsThatAreMissingAndWidensTypes) {
  std::vector<RayCloud> clouds;
  clouds.push_back(
      random_cloud(1, {.rays = 2, .extras = {{"a", ScalarType::uint16}, {"b", ScalarType::float32}}}));
  clouds.push_back(
      random_cloud(2, {.rays = 2, .extras = {{"c", ScalarType::int64}, {"a", ScalarType::int16}}}));
  CombinedSource source = combined(clouds, 1);
  const std::vector<ColumnInfo> columns{
      {"a", ScalarType::int32}, {"b", ScalarType::float32}, {"c", ScalarType::int64}};
  EXPECT_EQ(source.info().extras, columns);
  EXPECT_EQ(source.notes().size(), 3U);
  const RayCloud all = read(source, 2);
  const auto a = all.extra("a")->values<std::int32_t>();
  EXPECT_EQ(a[1], clouds[0].extra("a")->values<std::uint16_t>()[1]);
  EXPECT_EQ(a[2], clouds[1].extra("a")->values<std::int16_t>()[0]);
  const auto b = all.extra("b")->values<float>();
  EXPECT_EQ(b[0], clouds[0].extra("b")->values<float>()[0]);
  EXPECT_TRUE(std::isnan(b[2]) && std::isnan(b[3]));
  const auto c = all.extra("c")->values<std::int64_t>();
  EXPECT_EQ(c[0], 0);
  EXPECT_EQ(c[3], clouds[1].extra("c")->values<std::int64_t>()[1]);
}

/// Whether a type holds every value of another exactly, tried at its extremes and odd values in between.
bool holds(ScalarType wide, ScalarType narrow) {
  return visit_scalar(wide, [&]<class W>() {
    return visit_scalar(narrow, []<class N>() {
      using Limits = std::numeric_limits<N>;
      if constexpr (std::is_floating_point_v<N> && !std::is_floating_point_v<W>) return false;
      for (const N value : {Limits::lowest(), Limits::max(), static_cast<N>(Limits::max() / 3), N{1}}) {
        const auto exact = static_cast<long double>(value);
        if (exact < static_cast<long double>(std::numeric_limits<W>::lowest()) ||
            exact > static_cast<long double>(std::numeric_limits<W>::max()) ||
            static_cast<long double>(static_cast<W>(value)) != exact) {
          return false;
        }
      }
      return true;
    });
  });
}

TEST(CombinedSource, TakesTheSmallestTypeThatHoldsBothOrRefuses) {
  for (const ScalarType x : kAllScalarTypes) {
    for (const ScalarType y : kAllScalarTypes) {
      const std::vector<RayCloud> clouds{random_cloud(1, {.rays = 1, .extras = {{"v", x}}}),
                                         random_cloud(2, {.rays = 1, .extras = {{"v", y}}})};
      std::size_t smallest = 99;
      for (const ScalarType type : kAllScalarTypes) {
        if (holds(type, x) && holds(type, y)) smallest = std::min(smallest, size_of(type));
      }
      if (smallest == 99) {
        EXPECT_EQ(code_of([&] { static_cast<void>(combined(clouds)); }), ErrorCode::wrong_content);
      } else {
        const CombinedSource source = combined(clouds);
        const ScalarType type = source.info().extras.at(0).type;
        EXPECT_TRUE(holds(type, x) && holds(type, y)) << name_of(x) << " " << name_of(y);
        EXPECT_EQ(size_of(type), smallest) << name_of(x) << " " << name_of(y);
      }
    }
  }
}

TEST(CombinedSource, UnitesWhatTheCloudsSayOfThemselves) {
  const RayCloud cloud = random_cloud(1, {.rays = 1});
  CloudInfo first, second;
  first.precision = Precision::single;
  first.crs = "EPSG:1";
  first.history = {"rayimport", "raysplit plane 0,0,1"};
  first.coordinate_step = 0.001;
  second.precision = Precision::double_;
  second.crs = "EPSG:2";
  second.time_base = "gps_week";
  second.history = {"rayimport", "raydecimate 4 cm"};
  second.comments = {"kept"};
  const auto open = [&](const CloudInfo& info) {
    return [&cloud, info] { return std::make_unique<MemorySource>(cloud, info); };
  };
  const CombinedSource source({{"a", open(first)}, {"b", open(second)}});
  EXPECT_EQ(source.info().precision, Precision::double_);
  EXPECT_EQ(source.info().crs, "");
  EXPECT_EQ(source.info().time_base, "gps_week");
  EXPECT_EQ(source.info().coordinate_step, 0.001);
  EXPECT_EQ(source.info().history,
            (std::vector<std::string>{"rayimport", "raysplit plane 0,0,1", "raydecimate 4 cm"}));
  EXPECT_EQ(source.info().comments, std::vector<std::string>{"kept"});
  EXPECT_EQ(source.warnings().size(), 1U);
  EXPECT_EQ(source.notes().size(), 1U);
  EXPECT_EQ(code_of([] { static_cast<void>(CombinedSource({})); }), ErrorCode::usage);
}

TEST(CombinedSource, KeepsOnlyAFewOfManyCloudsOpen) {
  const RayCloud cloud = random_cloud(1, {.rays = 20});
  static std::atomic<int> open, most;
  open = most = 0;
  struct Counted final : RaySource {
    explicit Counted(const RayCloud& rays) : inner(rays, 10) { most = std::max<int>(most, ++open); }
    ~Counted() override { --open; }
    const CloudInfo& info() const override { return inner.info(); }
    bool fetch(RawChunk& raw) override { return inner.fetch(raw); }
    std::size_t decode(const RawChunk& raw, RayCloud& rays) const override { return inner.decode(raw, rays); }
    void rewind() override { inner.rewind(); }
    MemorySource inner;
  };
  std::vector<CloudToCombine> clouds(1000, {"c", [&] { return std::make_unique<Counted>(cloud); }});
  CombinedSource source(std::move(clouds));
  EXPECT_EQ(read_all(Context{.threads = 4}, source).size(), 20000U);
  EXPECT_LT(most, 30);
}

RC_GTEST_PROP(JoinPieces, DoesNotDependOnThreadsAndChunks, ()) {
  const RayCloud cloud = numbered_cloud(*rc::gen::arbitrary<std::uint64_t>(), 120);
  const Halves halves = split(cloud, *split_by_box({0, 0, 0}, {5, 5, 5}, Precision::single));
  const std::vector<RayCloud> parts{halves.inside, halves.outside};
  const RayCloud expected = joined(parts);
  for (const unsigned threads : {2U, 3U, 8U}) {
    for (const std::size_t chunk : {1UL, 7UL, 1000UL})
      RC_ASSERT(same_bits(joined(parts, {.threads = threads}, chunk), expected));
  }
}

RC_GTEST_PROP(JoinPieces, KeepsPiecesWhoseNeighbourIsMissing, ()) {
  const RayCloud cloud = numbered_cloud(*rc::gen::arbitrary<std::uint64_t>(), 120);
  const Halves halves = split(cloud, *split_by_plane({0, 0, 1}, Precision::double_));
  // Of the outside only every other piece.
  RayCloud some = halves.outside;
  std::vector<std::uint8_t> mask(some.size());
  for (std::size_t i = 0; i < mask.size(); ++i)
    mask[i] = i % 2 == 0 ? 1 : 0;
  some.select(mask);
  const RayCloud again = joined({halves.inside, some});
  RC_ASSERT(lines_of(again, true) == lines_of(together({halves.inside, some}), true));
  RC_ASSERT(std::abs(total_length(again) - total_length(halves.inside) - total_length(some)) < 1e-6);
}

TEST(JoinPieces, NeedsTheColumnOfASplit) {
  const std::vector<RayCloud> parts{random_cloud(1, {.rays = 5})};
  EXPECT_EQ(code_of([&] { static_cast<void>(joined(parts)); }), ErrorCode::no_data);
}

}  // namespace
}  // namespace ray
