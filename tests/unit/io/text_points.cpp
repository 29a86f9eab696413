#include "support/random_cloud.h"
#include "support/scratch.h"

#include <raycloud/core/error.h>
#include <raycloud/core/memory_stream.h>
#include <raycloud/exec/stream.h>
#include <raycloud/io/text_points.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <fstream>

namespace ray {
namespace {

using ::testing::HasSubstr;

struct ReadPoints {
  CloudInfo info;
  RayCloud rays;
  std::uint64_t dropped = 0;
};

ReadPoints read_points(const std::filesystem::path& path, std::size_t chunk_rays = 32768) {
  const auto source = open_text_points(path, {.chunk_rays = chunk_rays});
  ReadPoints read{.info = source->info()};
  read.rays.set_schema(read.info.extras);
  const auto counts = stream(
      {}, *source, nullptr, [](RayCloud&) { return Nothing{}; },
      [&](RayCloud& rays, Nothing&) { read.rays.append(rays); });
  read.dropped = counts.dropped;
  return read;
}

ReadPoints points_of(const std::string& text, const std::string& name = "points.txt") {
  const test::Scratch scratch;
  std::ofstream(scratch.path(name), std::ios::binary) << text;
  return read_points(scratch.path(name));
}

std::string points_error(const std::string& text, const std::string& name = "points.txt") {
  try {
    points_of(text, name);
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

TEST(text_points, the_same_points_in_every_spelling) {
  const std::vector<std::string> spellings{
      "x y z time\n1 2 3 10.5\n-4 5.5 6 11\n",
      "X,Y,Z,GpsTime\r\n1,2,3,10.5\r\n-4,5.5,6,11\r\n",
      "\"X\";\"Y\";\"Z\";\"timestamp\"\n1;2;3;10.5\n-4;5.5;6;11",
      "//X,Y,Z,t\n1,2,3,10.5\n-4,5.5,6,11\n",
      "# a scan\n# time z y x\n\n10.5\t3\t2\t1\n% more\n11 6 5.5 -4\n",
      "\xEF\xBB\xBFx,y,z,gps_time\n 1 , 2,3 ,+10.5\n-4,5.5,6.0e0,11\n",
      "1 2 3 10.5\n-4 5.5 6 11\n",
  };
  for (const std::string& text : spellings) {
    const ReadPoints read = points_of(text);
    ASSERT_EQ(read.rays.size(), 2u) << text;
    EXPECT_EQ(read.rays.ends[0], Eigen::Vector3d(1, 2, 3)) << text;
    EXPECT_EQ(read.rays.ends[1], Eigen::Vector3d(-4, 5.5, 6)) << text;
    EXPECT_EQ(read.rays.times, (std::vector<double>{10.5, 11.0})) << text;
    EXPECT_EQ(read.rays.starts, read.rays.ends) << text;
    EXPECT_TRUE(read.info.present.times && !read.info.present.starts && read.info.extras.empty()) << text;
  }
}

TEST(text_points, columns_without_a_heading_are_told_by_their_content) {
  EXPECT_FALSE(points_of("1 2 3\n4 5 6\n").info.present.times);
  const ReadPoints pts = points_of("2\n1 2 3 -1208 255 0 17\n4 5 6 2047 1 2 3\n", "scan.pts");
  EXPECT_EQ(pts.rays.colours[0], (Colour{255, 0, 17, 255}));
  EXPECT_EQ(pts.rays.extra("intensity")->values<double>()[1], 2047.0);
  const ReadPoints coloured = points_of("1 2 3 9 8 7\n4 5 6 255 254 0\n");
  EXPECT_EQ(coloured.rays.colours[1].green, 254);
  EXPECT_FALSE(coloured.info.present.times);
  const ReadPoints strength = points_of("1 2 3 700\n4 5 6 12\n");
  EXPECT_EQ(strength.rays.extra("intensity")->values<double>()[0], 700.0);
  EXPECT_THAT(strength.info.comments, ::testing::Contains(HasSubstr("x y z intensity")));
}

TEST(text_points, origins_colours_alpha_and_unknown_columns) {
  const ReadPoints read = points_of(
      "x,y,z,origin_x,origin_y,origin_z,r,g,b,alpha,Classification,nx,my value,\n"
      "1,2,3,0.5,0.25,9,10,20,30,0,6,1,-2.5,\n4,5,6,7,8,9,0,0,0,77,2,0,,\n");
  EXPECT_TRUE(read.info.present.starts && read.info.present.intensity);
  EXPECT_EQ(read.rays.starts[0], Eigen::Vector3d(0.5, 0.25, 9));
  EXPECT_EQ(read.rays.colours[0], (Colour{10, 20, 30, 0}));
  EXPECT_EQ(read.rays.bounded, (std::vector<std::uint8_t>{0, 1}));
  EXPECT_EQ(read.rays.extra("Classification"), nullptr);
  EXPECT_EQ(read.rays.extra("classification")->values<std::uint8_t>()[0], 6);
  EXPECT_EQ(read.rays.extra("normal_x")->values<double>()[0], 1.0);
  EXPECT_EQ(read.rays.extra("my_value")->values<double>()[0], -2.5);
  EXPECT_TRUE(std::isnan(read.rays.extra("my_value")->values<double>()[1]));
}

TEST(text_points, colours_of_16_bits_and_of_fractions_become_8_bits) {
  EXPECT_EQ(points_of("x y z r g b\n1 2 3 65535 257 0\n").rays.colours[0], (Colour{255, 1, 0, 255}));
  EXPECT_EQ(points_of("x y z r g b\n1 2 3 1 0.5 0\n").rays.colours[0], (Colour{255, 128, 0, 255}));
}

TEST(text_points, rows_with_nan_or_infinity_are_left_out_and_counted) {
  const ReadPoints read =
      points_of("x,y,z,time\n1,2,3,4\nnan,2,3,4\n1,inf,3,4\n1,2,,4\n1,2,3,-inf\n5,6,7,8\n1e999,0,0,0\n");
  EXPECT_EQ(read.rays.size(), 2u);
  EXPECT_EQ(read.dropped, 5u);
  EXPECT_EQ(read.rays.ends[1], Eigen::Vector3d(5, 6, 7));
}

TEST(text_points, errors_name_the_line) {
  EXPECT_THAT(points_error(""), HasSubstr("points.txt: is empty"));
  EXPECT_THAT(points_error("# nothing\n\n"), HasSubstr("holds no points"));
  EXPECT_THAT(points_error("1 2\n"), HasSubstr("line 1 has 2 numbers"));
  EXPECT_THAT(points_error("x y z\n1 2 3\n\n1 2\n"), HasSubstr("line 4 has 2 of 3 numbers"));
  EXPECT_THAT(points_error("x y z\n1 2 3 4\n"), HasSubstr("line 2 has more than 3"));
  EXPECT_THAT(points_error("1 2 3\n1 2 3\n4 five 6\n"), HasSubstr("line 3 has 'five'"));
  EXPECT_THAT(points_error("hello world\n1 2 3\n"), HasSubstr("line 1: 'hello'"));
  EXPECT_THAT(points_error(std::string("\x7f"
                                       "ELF\0\1\2\3",
                                       8)),
              HasSubstr("line 1"));
  EXPECT_THAT(points_error("x y z classification\n1 2 3 256\n"), HasSubstr("classification, which is uint8"));
  EXPECT_THAT(points_error("x y z r g b\n1 2 3 -1 0 0\n"), HasSubstr("line 2 has a colour out of range"));
  EXPECT_THAT(points_error("3\n1 2 3\n1 2 3\n", "a.pts"),
              HasSubstr("says it holds 3 points, but there are 2"));
  EXPECT_THAT(points_error("1\n1 2 3\n1 2 3\n", "a.pts"),
              HasSubstr("says it holds 1 points, but there are 2"));
  const test::Scratch scratch;
  EXPECT_THROW(static_cast<void>(open_text_points(scratch.path("none.xyz"))), Error);
  EXPECT_THROW(static_cast<void>(open_text_points(scratch.folder())), Error);
}

TEST(text_points, fixed_decimals_are_the_coordinate_step) {
  EXPECT_EQ(points_of("1.125 2.500 3.0\n").info.coordinate_step, 1e-3);
  EXPECT_EQ(points_of("1.1 2.55 3\n").info.coordinate_step, 0.0);
  EXPECT_EQ(points_of("time x y z\n10.12345 1.1 2.5 3\n").info.coordinate_step, 0.1);
}

TEST(text_points, more_digits_than_a_float_has_are_a_double) {
  EXPECT_EQ(points_of("0.00123456789 2 3\n").info.precision, Precision::single);
  EXPECT_EQ(points_of("time x y z\n1234567890.5 1 2 3\n").info.precision, Precision::single);
  EXPECT_EQ(points_of("1 500000.1234 3\n").info.precision, Precision::double_);
}

// Everything but the starts comes back; the types of the extras become those of the reader, the values stay.
RC_GTEST_PROP(text_points, what_is_written_is_read_back, ()) {
  const auto rays = *rc::gen::inRange<std::size_t>(0, 60);
  const bool csv = *rc::gen::arbitrary<bool>();
  const bool single = *rc::gen::arbitrary<bool>();
  test::RandomCloudOptions options{
      .rays = rays, .float_coordinates = single, .extras = test::schema_of_every_type()};
  const RayCloud cloud = test::random_cloud(*rc::gen::arbitrary<std::uint64_t>(), options);
  const test::Scratch scratch;
  const auto path = scratch.path(csv ? "points.csv" : "points.xyz");
  MemorySource source(cloud);
  CloudInfo info = source.info();
  info.precision = single ? Precision::single : Precision::double_;
  const auto sink = create_text_points(path, info);
  stream_each({}, source, *sink, [](RayCloud&) {});
  RC_ASSERT(!std::filesystem::exists(path));
  sink->finish();

  for (const std::size_t chunk_rays : {1u, 7u, 1000000u}) {
    const ReadPoints read = read_points(path, chunk_rays);
    RC_ASSERT(read.rays.size() == cloud.size());
    RC_ASSERT(read.rays.times == cloud.times);
    RC_ASSERT(read.rays.bounded == cloud.bounded);
    RC_ASSERT(read.rays.extras.size() == cloud.extras.size());
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      if (single)
        RC_ASSERT(read.rays.ends[i].cast<float>() == cloud.ends[i].cast<float>());
      else
        RC_ASSERT(read.rays.ends[i] == cloud.ends[i]);
      RC_ASSERT(read.rays.colours[i].red == cloud.colours[i].red);
      RC_ASSERT(read.rays.colours[i].blue == cloud.colours[i].blue);
      for (std::size_t e = 0; e < cloud.extras.size(); ++e) {
        const double there = cloud.extras[e].as_double(i);
        const double back = read.rays.extras[e].as_double(i);
        const bool narrow = cloud.extras[e].type() == ScalarType::float32;
        RC_ASSERT((narrow ? static_cast<double>(static_cast<float>(back)) : back) == there);
      }
    }
  }
}

}  // namespace
}  // namespace ray
