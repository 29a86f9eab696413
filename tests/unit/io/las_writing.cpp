#include "las_fixture.h"
#include "support/random_cloud.h"
#include "support/scratch.h"

#include <raycloud/core/error.h>
#include <raycloud/core/memory_stream.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <limits>

namespace {

using namespace ray;
using namespace ray::test;
using namespace ray::test::las;
using Eigen::Vector3d;
using testing::HasSubstr;

enum class Kind { rays, points };

void store_cloud(const std::filesystem::path& path, const RayCloud& rays, CloudInfo info,
                 Kind kind = Kind::rays, std::size_t chunk = 100, unsigned threads = 1) {
  info.extras = schema_of(rays);
  const auto sink = kind == Kind::rays ? create_las(path, info) : create_las_points(path, info);
  MemorySource source(rays, chunk);
  stream_each({.threads = threads}, source, *sink, [](RayCloud&) {});
  sink->finish();
}

RayCloud load_rays(const std::filesystem::path& path) {
  const auto source = open_las(path);
  return read_all({}, *source);
}

double farthest(const std::vector<Vector3d>& a, const std::vector<Vector3d>& b) {
  double most = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i)
    most = std::max(most, (a[i] - b[i]).cwiseAbs().maxCoeff());
  return most;
}

/// Columns of every type, and some with the names of standard fields, of their types and of others.
std::vector<ColumnInfo> any_schema(bool standard_types) {
  using enum ScalarType;
  std::vector<ColumnInfo> schema = schema_of_every_type();
  schema.push_back({"intensity", standard_types ? uint16 : float32});
  schema.push_back({"return_number", uint8});
  schema.push_back({"number_of_returns", uint8});
  schema.push_back({"classification", standard_types ? uint8 : int32});
  schema.push_back({"scan_angle", float32});
  schema.push_back({"flags", uint8});
  schema.push_back({"user_data", uint8});
  schema.push_back({"point_source_id", standard_types ? uint16 : uint64});
  schema.push_back({"a name that is much longer than thirty-two bytes", int16});
  schema.push_back({"Bounded", float64});
  schema.push_back({"Alpha", uint8});
  schema.push_back({"BeamOriginX", float32});
  return schema;
}

RC_GTEST_PROP(LasWriting, RaysComeBackWithEveryColumn,
              (std::uint64_t seed, bool standard_types, bool compressed)) {
  const Scratch scratch;
  const auto path = scratch.path(compressed ? "a.laz" : "a.las");
  const RayCloud rays = random_cloud(seed, {.rays = seed % 300,
                                            .centre = {500000, 6900000, 50},
                                            .half_extent = 200,
                                            .extras = any_schema(standard_types)});
  store_cloud(path, rays, {});
  const RayCloud back = load_rays(path);
  RC_ASSERT(back.size() == rays.size());
  RC_ASSERT(farthest(back.ends, rays.ends) <= 0.00005 + 2e-9);
  RC_ASSERT(farthest(back.starts, rays.starts) <= 0.00005 + 2e-9);
  RC_ASSERT(back.times == rays.times);
  RC_ASSERT(back.colours == rays.colours);
  RC_ASSERT(back.bounded == rays.bounded);
  RC_ASSERT(back.extras == rays.extras);
  // What has once been on the grid stays there.
  store_cloud(scratch.path("b.laz"), back, {.coordinate_step = 0.0001});
  const RayCloud again = load_rays(scratch.path("b.laz"));
  RC_ASSERT(farthest(again.ends, back.ends) <= 2e-9);
  RC_ASSERT(farthest(again.starts, back.starts) <= 2e-9);
}

RC_GTEST_PROP(LasWriting, FieldsThatSurviveGoWhereTheStandardHasThem, (std::uint64_t seed)) {
  using enum ScalarType;
  const Scratch scratch;
  RayCloud rays = random_cloud(seed, {.rays = 1 + seed % 100,
                                      .extras = {{"intensity", uint16},
                                                 {"return_number", uint8},
                                                 {"number_of_returns", uint8},
                                                 {"classification", uint8},
                                                 {"scan_angle", float32},
                                                 {"flags", uint8},
                                                 {"user_data", uint8},
                                                 {"point_source_id", uint16}}});
  for (auto& v : rays.extra("return_number")->values<std::uint8_t>())
    v = v & 15;
  for (auto& v : rays.extra("number_of_returns")->values<std::uint8_t>())
    v = v & 15;
  for (auto& v : rays.extra("scan_angle")->values<float>())
    v = static_cast<float>(static_cast<int>(v) * 0.006);  // no negative zero, which LAS lacks
  store_cloud(scratch.path("a.laz"), rays, {}, Kind::points);
  RC_ASSERT(read_points(scratch.path("a.laz")).extras == rays.extras);
  const PlainPoints plain = plain_loop(scratch.path("a.laz"));
  RC_ASSERT(plain.whole);
  RC_ASSERT(plain.ends.size() == rays.size());
  std::array<std::uint64_t, 16> by_return{};
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const auto& p = plain.points[i];
    const auto at = [&](const char* name) { return rays.extra(name)->as_double(i); };
    RC_ASSERT(p.intensity == at("intensity"));
    RC_ASSERT(p.extended_return_number == at("return_number"));
    RC_ASSERT(p.extended_number_of_returns == at("number_of_returns"));
    RC_ASSERT(p.extended_classification == at("classification"));
    RC_ASSERT(p.user_data == at("user_data"));
    RC_ASSERT(p.point_source_ID == at("point_source_id"));
    RC_ASSERT(std::abs(p.extended_scan_angle * 0.006 - at("scan_angle")) < 1e-4);
    RC_ASSERT(p.gps_time == rays.times[i]);
    RC_ASSERT(p.rgb[0] == 257 * rays.colours[i].red);
    RC_ASSERT(plain.extra_bytes[i].size() == 1u);  // Alpha
    ++by_return[p.extended_return_number];
  }
  for (std::size_t r = 1; r < 16; ++r)
    RC_ASSERT(plain.header.extended_number_of_points_by_return[r - 1] == by_return[r]);
}

RC_GTEST_PROP(LasWriting, NeitherThreadsNorChunksChangeAByte, (std::uint64_t seed)) {
  const Scratch scratch;
  const RayCloud rays = random_cloud(seed, {.rays = 500, .extras = any_schema(true)});
  store_cloud(scratch.path("a.laz"), rays, {});
  const std::string expected = load_bytes(scratch.path("a.laz"));
  for (const std::size_t chunk : {1u, 7u, 1000000u}) {
    store_cloud(scratch.path("a.laz"), rays, {}, Kind::rays, chunk, 3);
    RC_ASSERT(load_bytes(scratch.path("a.laz")) == expected);
  }
}

TEST(LasWriting, AHundredRoundsMoveNothing) {
  const Scratch scratch;
  RayCloud rays = random_cloud(5, {.rays = 200, .centre = {500000, 6900000, 50}, .half_extent = 300});
  store_cloud(scratch.path("a.laz"), rays, {});
  const RayCloud first = load_rays(scratch.path("a.laz"));
  for (int round = 0; round < 100; ++round) {
    const auto source = open_las(scratch.path("a.laz"));
    const RayCloud read = read_all({}, *source);
    store_cloud(scratch.path("a.laz"), read, source->info());
  }
  EXPECT_LE(farthest(load_rays(scratch.path("a.laz")).ends, first.ends), 2e-9);
}

TEST(LasWriting, HeaderTellsTheTruth) {
  const Scratch scratch;
  const RayCloud rays = random_cloud(5, {.rays = 200, .centre = {500000, 6900000, 50}, .half_extent = 300});
  for (const char* name : {"a.las", "a.laz"}) {
    store_cloud(scratch.path(name), rays, {.time_base = "gps_adjusted"});
    const PlainPoints plain = plain_loop(scratch.path(name));
    ASSERT_TRUE(plain.whole);
    Bounds bounds;
    for (const Vector3d& end : plain.ends)
      bounds.add(end);
    EXPECT_EQ(plain.header.min_x, bounds.min.x());
    EXPECT_EQ(plain.header.max_x, bounds.max.x());
    EXPECT_EQ(plain.header.min_z, bounds.min.z());
    EXPECT_EQ(plain.header.max_y, bounds.max.y());
    EXPECT_EQ(plain.header.x_scale_factor, 0.0001);
    EXPECT_EQ(plain.header.version_minor, 4);
    EXPECT_EQ(plain.header.point_data_format, 7);
    EXPECT_EQ(plain.header.extended_number_of_point_records, 200u);
    EXPECT_EQ(plain.header.extended_number_of_points_by_return[0], 200u);
    EXPECT_EQ(plain.header.global_encoding, 17);
  }
}

TEST(LasWriting, NotesComeBack) {
  const Scratch scratch;
  const RayCloud rays = random_cloud(5, {.rays = 3});
  CloudInfo info;
  info.crs = "PROJCS[\"somewhere\",UNIT[\"metre\",1]]";
  info.time_base = "made_up";
  info.history = {"rayimport ALS 0,0,1", "raydecimate 10 cm"};
  info.comments = {"by hand", std::string(100000, 'x')};
  for (const std::string crs :
       {info.crs.c_str(), "EPSG:25832", "EPSG:4326", "EPSG:999999", "local grid 3", ""}) {
    info.crs = crs;
    store_cloud(scratch.path("a.laz"), rays, info);
    const CloudInfo back = open_las(scratch.path("a.laz"))->info();
    EXPECT_EQ(back.crs, crs);
    EXPECT_EQ(back.time_base, info.time_base);
    EXPECT_EQ(back.history, info.history);
    EXPECT_EQ(back.comments, info.comments);
    EXPECT_TRUE(back.formal_extras.empty());
    EXPECT_TRUE(back.present.starts && back.present.times && back.present.colours && back.present.intensity);
    EXPECT_TRUE(plain_loop(scratch.path("a.laz")).whole);
  }
}

TEST(LasWriting, PointsWithoutTimesAndColoursSaySo) {
  const Scratch scratch;
  const RayCloud rays = random_cloud(5, {.rays = 30});
  CloudInfo info;
  info.present = {.starts = false, .times = false, .colours = false, .intensity = false};
  store_cloud(scratch.path("a.laz"), rays, info, Kind::points);
  const auto source = open_las_points(scratch.path("a.laz"));
  EXPECT_FALSE(source->info().present.starts);
  EXPECT_FALSE(source->info().present.times);
  EXPECT_FALSE(source->info().present.colours);
  EXPECT_FALSE(source->info().present.intensity);
  EXPECT_TRUE(source->info().extras.empty());
  EXPECT_EQ(read_all({}, *source).colours, std::vector<Colour>(30));
  EXPECT_EQ(plain_loop(scratch.path("a.laz")).header.point_data_format, 6);
}

TEST(LasWriting, ACloudWithNoRays) {
  const Scratch scratch;
  for (const char* name : {"a.las", "a.laz"}) {
    store_cloud(scratch.path(name), RayCloud{}, {});
    const auto source = open_las(scratch.path(name));
    EXPECT_EQ(source->info().ray_count, 0u);
    EXPECT_TRUE(read_all({}, *source).empty());
    EXPECT_TRUE(plain_loop(scratch.path(name)).whole);
  }
}

TEST(LasWriting, DegreesKeepTheirStep) {
  const Scratch scratch;
  RayCloud rays = random_cloud(5, {.rays = 200});
  for (std::size_t i = 0; i < rays.size(); ++i) {
    rays.ends[i] = {static_cast<double>(-1234567890 + static_cast<int>(i) * 77) * 1e-7,
                    44.5 + static_cast<double>(i) * 1e-7, 120.0 + 0.01 * static_cast<double>(i)};
    rays.starts[i] = rays.ends[i];
  }
  store_cloud(scratch.path("a.laz"), rays, {.coordinate_step = 1e-7});
  EXPECT_LE(farthest(load_rays(scratch.path("a.laz")).ends, rays.ends), 1e-12);
}

TEST(LasWriting, AnOddGridOfTheSourceIsKept) {
  const Scratch scratch;
  RayCloud rays = random_cloud(5, {.rays = 200});
  for (std::size_t i = 0; i < rays.size(); ++i)
    rays.ends[i] = Vector3d(0.00025, 0.00025, 0.00025) * static_cast<double>(i * i) +
                   Vector3d(331000.1234567, 5.00011, -7.1);
  store_cloud(scratch.path("a.laz"), rays, {.coordinate_step = 0.00025});
  const RayCloud back = load_rays(scratch.path("a.laz"));
  EXPECT_LE(farthest(back.ends, rays.ends), 1e-9);
  EXPECT_LE(farthest(back.starts, rays.starts), 0.00005 + 1e-9) << "starts are on no grid of the source";
}

TEST(LasWriting, CoarserOnlyAsFarAsThirtyTwoBitsDemand) {
  const Scratch scratch;
  RayCloud rays = random_cloud(5, {.rays = 2});
  rays.ends = {{-250000.0, 0, 0}, {250000.0, 4e6, 0}};
  rays.starts = rays.ends;
  store_cloud(scratch.path("a.las"), rays, {});
  const PlainPoints plain = plain_loop(scratch.path("a.las"));
  EXPECT_EQ(plain.header.x_scale_factor, 0.0002);
  EXPECT_EQ(plain.header.y_scale_factor, 0.001);
  EXPECT_EQ(plain.header.z_scale_factor, 0.0001);
  EXPECT_LE(farthest(load_rays(scratch.path("a.las")).ends, rays.ends), 0.0005);
}

TEST(LasWriting, RefusesWhatIsNoNumber) {
  const Scratch scratch;
  for (int which = 0; which < 3; ++which) {
    RayCloud rays = random_cloud(5, {.rays = 10});
    if (which == 0) rays.ends[5].y() = std::nan("");
    if (which == 1) rays.starts[5].z() = std::numeric_limits<double>::infinity();
    if (which == 2) rays.times[5] = std::nan("");
    const auto sink = create_las(scratch.path("a.laz"), {});
    RawChunk raw;
    try {
      sink->encode(rays, raw);
      ADD_FAILURE() << "stored " << which;
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::out_of_range);
    }
  }
}

TEST(LasWriting, RefusesMoreColumnsThanLasCanHold) {
  const Scratch scratch;
  std::vector<ColumnInfo> schema;
  for (int i = 0; i < 400; ++i)
    schema.push_back({"c" + std::to_string(i), ScalarType::uint8});
  const RayCloud rays = random_cloud(5, {.rays = 3, .extras = schema});
  try {
    store_cloud(scratch.path("a.laz"), rays, {});
    FAIL() << "400 columns were stored";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::out_of_range);
  }
  EXPECT_TRUE(std::filesystem::is_empty(scratch.folder()));
}

TEST(LasWriting, AnUnfinishedSinkLeavesNothing) {
  const Scratch scratch;
  store_bytes(scratch.path("a.laz"), "as it was");
  {
    const auto sink = create_las(scratch.path("a.laz"), {});
    RawChunk raw;
    sink->encode(random_cloud(5, {.rays = 10}), raw);
    sink->write(raw);
  }
  EXPECT_EQ(load_bytes(scratch.path("a.laz")), "as it was");
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(scratch.folder()),
                          std::filesystem::directory_iterator{}),
            1);
}

TEST(LasWriting, AFolderThatIsNotThere) {
  const Scratch scratch;
  try {
    (void)create_las(scratch.path("none") / "a.laz", {});
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::file_access);
  }
}

TEST(LasWriting, AFullDiskIsAnErrorOfTheDisk) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "no /dev/full here";
  const RayCloud rays = random_cloud(5, {.rays = 10});
  const Scratch scratch;
  std::filesystem::create_symlink("/dev/full", scratch.path("a.laz"));
  try {
    store_cloud(scratch.path("a.laz"), rays, {});
    FAIL() << "the full disk was not noticed";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::file_access);
    EXPECT_THAT(error.what(), HasSubstr("a.laz"));
  }
}

}  // namespace
