// Writing PLY, and what comes back.
#include "ply_fixture.h"
#include "support/random_cloud.h"
#include "support/scratch.h"

#include <raycloud/io/ply_cloud.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <limits>

namespace ray {
namespace {

using namespace test;
using ::testing::HasSubstr;
using ::testing::StartsWith;

CloudInfo info_of(const RayCloud& cloud, Precision precision) {
  CloudInfo info;
  info.precision = precision;
  info.extras = schema_of(cloud);
  return info;
}

void write_cloud(const std::filesystem::path& path, const RayCloud& cloud, const CloudInfo& info) {
  write_all(*create_ply(path, info), cloud);
}

RayCloud read_cloud(const std::filesystem::path& path) {
  return read_rest(*open_ply(path)).rays;
}

std::string data_of(const std::filesystem::path& path) {
  const std::string bytes = read_file(path);
  return bytes.substr(bytes.find("end_header\n") + 11);
}

RC_GTEST_PROP(PlyWriting, ExactFloatsComeBackWithEveryBit, ()) {
  const Scratch scratch;
  const RayCloud cloud =
      random_cloud(*rc::gen::arbitrary<std::uint64_t>(), {.rays = *rc::gen::inRange<std::size_t>(0, 50),
                                                          .float_coordinates = true,
                                                          .extras = schema_of_every_type()});
  for (const Precision precision : {Precision::single, Precision::double_}) {
    write_cloud(scratch.path("a.ply"), cloud, info_of(cloud, precision));
    RC_ASSERT(open_ply(scratch.path("a.ply"))->info().precision == precision);
    RC_ASSERT(same_bits(read_cloud(scratch.path("a.ply")), cloud));
  }
}

/// Chosen rows, some twice, go to a file as if they had been gathered first: a loop of its own.
RC_GTEST_PROP(PlyWriting, RowsOfAChunkAreWrittenAsTheirCopyWouldBe, ()) {
  const RayCloud cloud =
      random_cloud(*rc::gen::arbitrary<std::uint64_t>(),
                   {.rays = *rc::gen::inRange<std::size_t>(1, 2000), .extras = schema_of_every_type()});
  const auto rows = *rc::gen::container<std::vector<std::uint32_t>>(
      rc::gen::inRange<std::uint32_t>(0, static_cast<std::uint32_t>(cloud.size())));
  RayCloud gathered;
  gathered.set_schema(schema_of(cloud));
  for (const std::uint32_t row : rows) {
    RayCloud one = cloud;
    std::vector<std::uint8_t> mask(cloud.size(), 0);
    mask[row] = 1;
    one.select(mask);
    gathered.append(one);
  }
  const Scratch scratch;
  for (const Precision precision : {Precision::single, Precision::double_}) {
    for (const auto& create : {create_ply, create_ply_points}) {
      const auto sink = create(scratch.path("a.ply"), info_of(cloud, precision), WriteOptions{});
      RawChunk chosen, copied;
      sink->encode_rows(cloud, rows, chosen);
      sink->encode(gathered, copied);
      RC_ASSERT(chosen.rows == copied.rows);
      RC_ASSERT(chosen.bytes == copied.bytes);
    }
  }
}

TEST(PlyWriting, ACommentCanBeAmendedAtTheEnd) {
  const Scratch scratch;
  const RayCloud cloud = random_cloud(5, {.rays = 10});
  CloudInfo info = info_of(cloud, Precision::double_);
  info.comments = {"of 00 rays", "of 00 rays or so"};
  const auto sink = create_ply(scratch.path("a.ply"), info);
  RawChunk raw;
  sink->encode(cloud, raw);
  sink->write(raw);
  EXPECT_THROW(sink->amend("of 0 rays", "of 7 rays"), Error);
  EXPECT_THROW(sink->amend("of 00 rays", "of 123 rays"), Error);
  sink->amend("of 00 rays", "of 10 rays");
  sink->finish();
  EXPECT_THAT(open_ply(scratch.path("a.ply"))->info().comments,
              ::testing::ElementsAre("of 10 rays", "of 00 rays or so"));
  EXPECT_TRUE(same_bits(read_cloud(scratch.path("a.ply")), cloud));
}

TEST(PlyWriting, OnlyChosenRowsMustFitTheFile) {
  const Scratch scratch;
  RayCloud cloud = random_cloud(4, {.rays = 1000});
  cloud.ends[700].x() = 6900000.017;
  cloud.times[800] = std::numeric_limits<double>::infinity();
  const auto sink = create_ply(scratch.path("a.ply"), info_of(cloud, Precision::single));
  RawChunk raw;
  const std::vector<std::uint32_t> good{1, 699, 701, 999}, far{1, 700}, endless{800};
  sink->encode_rows(cloud, good, raw);
  EXPECT_EQ(raw.rows, 4u);
  EXPECT_THROW(sink->encode_rows(cloud, far, raw), PrecisionLoss);
  EXPECT_THROW(sink->encode_rows(cloud, endless, raw), Error);
}

/// Any float of ordinary size, of any fraction.
float any_float(int largest_exponent) {
  const int mantissa = *rc::gen::inRange(-(1 << 24), 1 << 24);
  return std::ldexp(static_cast<float>(mantissa),
                    *rc::gen::inRange(largest_exponent - 26, largest_exponent - 24));
}

RC_GTEST_PROP(PlyWriting, ASinglePrecisionFileIsRewrittenBitForBit, ()) {
  const Scratch scratch;
  FixtureFile file{.notes = {"comment raycloud version 1"}, .elements = {{"vertex", {}, {}}}};
  for (const char* name : {"x", "y", "z"})
    file.elements[0].properties.push_back({"float", name, ""});
  file.elements[0].properties.push_back({"double", "time", ""});
  for (const char* name : {"nx", "ny", "nz"})
    file.elements[0].properties.push_back({"float", name, ""});
  for (const char* name : {"red", "green", "blue", "alpha"})
    file.elements[0].properties.push_back({"uchar", name, ""});
  file.elements[0].rows.resize(*rc::gen::inRange<std::size_t>(1, 30));
  for (auto& row : file.elements[0].rows) {
    for (int i = 0; i < 3; ++i)
      row.push_back({any_float(10)});
    row.push_back({*rc::gen::inRange(0, 1000000000) / 1024.0});
    for (int i = 0; i < 3; ++i)
      row.push_back({any_float(7)});
    for (int i = 0; i < 4; ++i)
      row.push_back({static_cast<double>(*rc::gen::inRange(0, 256))});
  }
  write_file(scratch.path("a.ply"), bytes_of(file));
  const RayCloud cloud = read_cloud(scratch.path("a.ply"));
  write_cloud(scratch.path("b.ply"), cloud, info_of(cloud, Precision::single));
  RC_ASSERT(data_of(scratch.path("b.ply")) == data_of(scratch.path("a.ply")));
}

RC_GTEST_PROP(PlyWriting, DoublePrecisionKeepsEndsAndSettlesStartsAtOnce, ()) {
  const Scratch scratch;
  const double scale = *rc::gen::element(1.0, 1e3, 1e7);
  const RayCloud cloud = random_cloud(*rc::gen::arbitrary<std::uint64_t>(),
                                      {.centre = {scale, -7.0 * scale, 0.1}, .half_extent = 150.0});
  write_cloud(scratch.path("a.ply"), cloud, info_of(cloud, Precision::double_));
  const RayCloud once = read_cloud(scratch.path("a.ply"));
  RC_ASSERT(once.ends == cloud.ends);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      const double largest = std::max(std::abs(cloud.starts[i][axis]), std::abs(cloud.ends[i][axis]));
      RC_ASSERT(std::abs(once.starts[i][axis] - cloud.starts[i][axis]) <= std::ldexp(largest, -51));
    }
  }
  write_cloud(scratch.path("b.ply"), once, info_of(once, Precision::double_));
  RC_ASSERT(data_of(scratch.path("b.ply")) == data_of(scratch.path("a.ply")));
}

TEST(PlyWriting, TheHeaderSaysWhatTheCloudSays) {
  const Scratch scratch;
  CloudInfo info;
  info.crs = "EPSG:32632";
  info.time_base = "gps_week";
  info.history = {"rayimport", "raydecimate 4 cm"};
  info.comments = {"made\nby end_header\nhand", "origin 1 2 3"};
  info.extras = {{"tree id", ScalarType::int64}, {"count", ScalarType::uint64}, {"label", ScalarType::int8}};
  RayCloud cloud;
  cloud.set_schema(info.extras);
  cloud.resize(1);
  cloud.starts[0] = {1, 2, 3};
  cloud.ends[0] = {1, 2, 5};
  cloud.times[0] = 7.0;
  cloud.bounded[0] = 1;
  cloud.colours[0] = {1, 2, 3, 0};
  cloud.extra("tree id")->values<std::int64_t>()[0] = -5;
  write_cloud(scratch.path("a.ply"), cloud, info);
  EXPECT_THAT(
      read_file(scratch.path("a.ply")),
      StartsWith("ply\nformat binary_little_endian 1.0\ncomment raycloud version 1\ncomment crs EPSG:32632\n"
                 "comment time_base gps_week\ncomment history rayimport\ncomment history raydecimate 4 cm\n"
                 "comment made by end_header hand\ncomment note origin 1 2 3\n"
                 "element vertex 000000000001\nproperty float x\nproperty float y\nproperty float z\n"
                 "property double time\nproperty float nx\nproperty float ny\nproperty float nz\n"
                 "property uchar red\nproperty uchar green\nproperty uchar blue\nproperty uchar alpha\n"
                 "property uint tree_id__low\nproperty int tree_id__high\n"
                 "property uint count__low\nproperty uint count__high\nproperty char label\nend_header\n"));
  const auto source = open_ply(scratch.path("a.ply"));
  EXPECT_EQ(source->info().crs, info.crs);
  EXPECT_EQ(source->info().time_base, info.time_base);
  EXPECT_EQ(source->info().history, info.history);
  const RayCloud back = read_rest(*source).rays;
  EXPECT_EQ(back.starts, cloud.starts);
  EXPECT_EQ(back.colours[0], (Colour{1, 2, 3, 1}));  // a bounded ray never has alpha 0
  EXPECT_EQ(back.extra("tree_id")->values<std::int64_t>()[0], -5);
}

class PlyPrecision : public ::testing::Test {
 protected:
  /// What storing a ray in single precision ends with.
  std::optional<Error> store(const Eigen::Vector3d& start, const Eigen::Vector3d& end, double step = 0.0) {
    RayCloud cloud;
    cloud.resize(600);  // several blocks of the encoder, the ray in the last
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      cloud.starts[i] = cloud.ends[i] = Eigen::Vector3d::Zero();
      cloud.times[i] = time_;
    }
    cloud.starts.back() = start;
    cloud.ends.back() = end;
    CloudInfo info;
    info.precision = precision_;
    info.coordinate_step = step;
    const auto sink = create_ply(scratch_.path("a.ply"), info);
    try {
      write_all(*sink, cloud);
    } catch (const PrecisionLoss& loss) {
      EXPECT_THAT(loss.what(), HasSubstr("needs double precision"));
      lost_ = true;
      return loss;
    } catch (const Error& error) {
      return error;
    }
    return std::nullopt;
  }
  bool loses(const Eigen::Vector3d& start, const Eigen::Vector3d& end, double step = 0.0) {
    lost_ = false;
    store(start, end, step);
    return lost_;
  }
  Scratch scratch_;
  Precision precision_ = Precision::single;
  double time_ = 0.0;
  bool lost_ = false;
};

TEST_F(PlyPrecision, ATenthOfAMillimetreIsTheLimit) {
  const Eigen::Vector3d zero = Eigen::Vector3d::Zero();
  EXPECT_FALSE(loses({0, 0, 0}, {2047.9999, 1, 1}));
  EXPECT_FALSE(loses({0, 0, 0}, {4096.0 + 9e-5, 0, 0}));   // rounds by less than 0.1 mm
  EXPECT_TRUE(loses({0, 0, 0}, {4096.0 + 1.9e-4, 0, 0}));  // half way between two floats
  EXPECT_TRUE(loses({500000.1, 0, 0}, {500000.1, 0, 0}));
  EXPECT_TRUE(loses({5000.00019, 0, 0}, zero));              // the vector alone
  EXPECT_FALSE(loses({500000.25, 0, 0}, {500000.5, 0, 0}));  // exact in float
  EXPECT_TRUE(loses(zero, {1e300, 0, 0}));
  precision_ = Precision::double_;
  EXPECT_FALSE(loses({500000.1, 0, 0}, {500000.1, 0, 1e300}));
}

TEST_F(PlyPrecision, HalfTheSourcesOwnStepIsTheLimitWhereFiner) {
  const Eigen::Vector3d degrees(11.123456789, 48.1, 500.0);
  EXPECT_FALSE(loses(degrees, degrees));
  EXPECT_TRUE(loses(degrees, degrees, 1e-7));
  EXPECT_FALSE(loses({0.5, 0.25, 500.0}, {0.5, 0.25, 500.0}, 1e-7));
}

TEST_F(PlyPrecision, WhatIsNotFiniteIsRefused) {
  const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
  for (const Precision precision : {Precision::single, Precision::double_}) {
    precision_ = precision;
    time_ = 0.0;
    for (const double bad : {nan, inf, -inf}) {
      const auto of_end = store({0, 0, 0}, {0, bad, 0});
      ASSERT_TRUE(of_end);
      EXPECT_EQ(of_end->code(), ErrorCode::out_of_range);
      EXPECT_THAT(of_end->what(), HasSubstr("not finite"));
      EXPECT_TRUE(store({0, 0, bad}, {0, 0, 0}));
    }
    time_ = nan;
    EXPECT_TRUE(store({0, 0, 0}, {0, 0, 0}));
  }
}

TEST(PlyWriting, NothingIsLeftOfAFailedFile) {
  const Scratch scratch;
  write_file(scratch.path("a.ply"), "old");
  {
    RayCloud cloud;
    cloud.resize(1);
    cloud.starts[0] = cloud.ends[0] = {1e6 + 0.1, 0, 0};
    cloud.times[0] = 0;
    EXPECT_THROW(write_cloud(scratch.path("a.ply"), cloud, {}), PrecisionLoss);
  }
  EXPECT_EQ(read_file(scratch.path("a.ply")), "old");
  EXPECT_EQ(files_in(scratch.folder()), 1u);
}

TEST(PlyWriting, NamesThatCannotStandBesideTheStandardOnes) {
  const Scratch scratch;
  for (const char* name : {"x", "time", "ny", "alpha", "rayx", ""}) {
    CloudInfo info;
    info.extras = {{name, ScalarType::float32}};
    const auto error = error_of([&] { static_cast<void>(create_ply(scratch.path("a.ply"), info)); });
    ASSERT_TRUE(error) << name;
    EXPECT_EQ(error->code(), ErrorCode::usage);
  }
  CloudInfo info;
  info.extras = {{"a b", ScalarType::float32}, {"a_b", ScalarType::float32}};
  EXPECT_TRUE(error_of([&] { static_cast<void>(create_ply(scratch.path("a.ply"), info)); }));
  EXPECT_EQ(files_in(scratch.folder()), 0u);
}

RC_GTEST_PROP(PlyWriting, PointsKeepAllButTheirStarts, ()) {
  const Scratch scratch;
  RayCloud cloud = random_cloud(*rc::gen::arbitrary<std::uint64_t>(),
                                {.float_coordinates = true, .extras = schema_of_every_type()});
  CloudInfo info = info_of(cloud, *rc::gen::element(Precision::single, Precision::double_));
  info.present = {false, *rc::gen::arbitrary<bool>(), *rc::gen::arbitrary<bool>(),
                  *rc::gen::arbitrary<bool>()};
  write_all(*create_ply_points(scratch.path("a.ply"), info), cloud);
  const auto source = open_ply_points(scratch.path("a.ply"));
  const Present& present = source->info().present;
  RC_ASSERT(present.times == info.present.times);
  RC_ASSERT(present.colours == info.present.colours);
  RC_ASSERT(present.intensity == info.present.intensity);
  RC_ASSERT(!present.starts);
  const RayCloud back = read_rest(*source).rays;
  cloud.starts = cloud.ends;
  if (!present.times) cloud.times.assign(cloud.size(), 0.0);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (!present.colours) cloud.colours[i] = {255, 255, 255, cloud.colours[i].intensity};
    if (!present.intensity) cloud.colours[i].intensity = 255;
    if (!present.intensity) cloud.bounded[i] = 1;
  }
  RC_ASSERT(same_bits(back, cloud));
  RC_ASSERT(error_of([&] { static_cast<void>(open_ply(scratch.path("a.ply"))); })->code() ==
            ErrorCode::wrong_content);
}

}  // namespace
}  // namespace ray
