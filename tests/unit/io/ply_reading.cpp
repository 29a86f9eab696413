// Reading PLY: files of random schema and encoding, and single spellings that are easy to get wrong.
#include "ply_fixture.h"
#include "support/random_cloud.h"
#include "support/scratch.h"

#include <raycloud/io/ply_cloud.h>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace ray {
namespace {

using namespace test;

const std::vector<std::string> kSpellings{"char",   "int8",    "uchar",  "uint8",   "short", "int16",
                                          "ushort", "uint16",  "int",    "int32",   "uint",  "uint32",
                                          "float",  "float32", "double", "float64", "int64", "uint64"};

/// A value that the type holds exactly, in text too.
double any_value(const std::string& type) {
  const bool is_unsigned = type[0] == 'u';
  const bool real = type.starts_with("float") || type.starts_with("double");
  const int limit = type == "char" || type == "int8" || type == "uchar" || type == "uint8" ? 100 : 30000;
  const int number = *rc::gen::inRange(is_unsigned ? 0 : -limit, limit + 1);
  return real ? number / 8.0 : number;
}

std::string any_of(const std::vector<std::string>& names) {
  return *rc::gen::elementOf(names);
}

FixtureElement any_element(const std::string& name) {
  FixtureElement element{name, {}, {}};
  const std::size_t properties = *rc::gen::inRange<std::size_t>(0, 4);
  for (std::size_t p = 0; p < properties; ++p) {
    const bool list = *rc::gen::arbitrary<bool>();
    const std::string type = any_of(kSpellings);
    element.properties.push_back(
        {type, "p" + std::to_string(p), list ? any_of({"uchar", "int", "ushort", "int8"}) : ""});
  }
  element.rows.resize(*rc::gen::inRange<std::size_t>(0, 5));
  for (auto& row : element.rows) {
    for (const auto& property : element.properties) {
      auto& values =
          row.emplace_back(property.list_count_type.empty() ? 1 : *rc::gen::inRange<std::size_t>(0, 4));
      for (double& value : values)
        value = any_value(property.type);
    }
  }
  return element;
}

/// The vertex element of a ray cloud: standard columns of any type, extras and lists, shuffled.
FixtureElement any_vertices(bool named_rayx) {
  FixtureElement element{"vertex", {}, {}};
  const auto add = [&](const std::string& type, const std::string& name, const std::string& list = "") {
    element.properties.push_back({type, name, list});
  };
  for (const char* name : {"x", "y", "z"})
    add(any_of(kSpellings), name);
  for (const char* name : {"x", "y", "z"})
    add(any_of(kSpellings), std::string(named_rayx ? "ray" : "n") + name);
  if (*rc::gen::arbitrary<bool>())
    add(any_of(kSpellings), any_of({"time", "timestamp", "gps_time", "GpsTime", "t", "scalar_GpsTime"}));
  if (*rc::gen::arbitrary<bool>()) {
    for (const char* name : {"red", "green", "blue"})
      add(any_of({"uchar", "uint8"}), name);
  }
  if (*rc::gen::arbitrary<bool>()) add("uchar", "alpha");
  const int extras = *rc::gen::inRange(0, 4);
  for (int i = 0; i < extras; ++i)
    add(any_of(kSpellings), "extra" + std::to_string(i));
  const int lists = *rc::gen::inRange(0, 3);
  for (int i = 0; i < lists; ++i)
    add(any_of(kSpellings), "list" + std::to_string(i), any_of({"uchar", "uint", "short"}));
  for (std::size_t i = element.properties.size(); i > 1; --i) {
    std::swap(element.properties[i - 1], element.properties[*rc::gen::inRange<std::size_t>(0, i)]);
  }
  element.rows.resize(*rc::gen::inRange<std::size_t>(0, 20));
  for (auto& row : element.rows) {
    for (const auto& property : element.properties) {
      auto& values =
          row.emplace_back(property.list_count_type.empty() ? 1 : *rc::gen::inRange<std::size_t>(0, 4));
      for (double& value : values)
        value = any_value(property.type);
    }
  }
  return element;
}

/// The value of a property in a row; `fallback` if there is none of that name.
double value_at(const FixtureElement& vertices, std::size_t row, const std::vector<std::string>& names,
                double fallback) {
  for (std::size_t p = 0; p < vertices.properties.size(); ++p) {
    if (std::find(names.begin(), names.end(), vertices.properties[p].name) != names.end())
      return vertices.rows[row][p][0];
  }
  return fallback;
}

void check_rays(const FixtureElement& vertices, const RayCloud& rays) {
  RC_ASSERT(rays.size() == vertices.rows.size());
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const auto at = [&](std::vector<std::string> names, double fallback) {
      return value_at(vertices, i, names, fallback);
    };
    const Eigen::Vector3d end(at({"x"}, 0), at({"y"}, 0), at({"z"}, 0));
    const Eigen::Vector3d ray(at({"nx", "rayx"}, 0), at({"ny", "rayy"}, 0), at({"nz", "rayz"}, 0));
    RC_ASSERT(rays.ends[i] == end);
    RC_ASSERT(rays.starts[i] == end + ray);
    RC_ASSERT(rays.times[i] == at({"time", "timestamp", "gps_time", "GpsTime", "t", "scalar_GpsTime"}, 0));
    RC_ASSERT(rays.colours[i].red == at({"red"}, 255));
    RC_ASSERT(rays.colours[i].green == at({"green"}, 255));
    RC_ASSERT(rays.colours[i].blue == at({"blue"}, 255));
    RC_ASSERT(rays.colours[i].intensity == at({"alpha"}, 255));
    RC_ASSERT(rays.bounded[i] == (at({"alpha"}, 255) == 0 ? 0 : 1));
    for (const Column& column : rays.extras)
      RC_ASSERT(column.as_double(i) == at({column.name()}, NAN));
  }
}

RC_GTEST_PROP(PlyReading, AnySchemaAndEncodingInAnyChunks, ()) {
  FixtureFile file;
  file.encoding = *rc::gen::element(Encoding::ascii, Encoding::little, Encoding::big);
  file.line_end = any_of({"\n", "\r\n", "\r"});
  file.blank = any_of({" ", "\t", "  \t "});
  file.notes = {"comment a remark", "obj_info made by hand", "comment raycloud version 1"};
  const std::size_t before = *rc::gen::inRange<std::size_t>(0, 3);
  for (std::size_t i = 0; i < before; ++i)
    file.elements.push_back(any_element("before" + std::to_string(i)));
  const FixtureElement vertices = any_vertices(*rc::gen::arbitrary<bool>());
  file.elements.push_back(vertices);
  const std::size_t after = *rc::gen::inRange<std::size_t>(0, 3);
  for (std::size_t i = 0; i < after; ++i)
    file.elements.push_back(any_element("after" + std::to_string(i)));
  const std::string bytes = bytes_of(file);
  const Scratch scratch;
  write_file(scratch.path("cloud.ply"), bytes);
  for (const std::size_t chunk : {std::size_t{1}, std::size_t{7}, std::size_t{1000000}}) {
    const auto source = open_ply(scratch.path("cloud.ply"), {.chunk_rays = chunk});
    RC_ASSERT(source->info().ray_count == vertices.rows.size());
    RC_ASSERT(source->info().comments == (std::vector<std::string>{"a remark", "made by hand"}));
    check_rays(vertices, read_rest(*source).rays);
    source->rewind();
    check_rays(vertices, read_rest(*source).rays);
    std::size_t extras = 0;
    for (const auto& property : vertices.properties) {
      if (!property.name.starts_with("extra")) continue;
      RC_ASSERT(source->info().extras.at(extras).name == property.name);
      ++extras;
    }
    RC_ASSERT(source->info().extras.size() == extras);
  }
}

class PlyText : public ::testing::Test {
 protected:
  ReadBack read(const std::string& text) {
    write_file(scratch_.path("a.ply"), text);
    return read_rest(*open_ply(scratch_.path("a.ply")));
  }
  ReadBack read_points(const std::string& text) {
    write_file(scratch_.path("a.ply"), text);
    const auto source = open_ply_points(scratch_.path("a.ply"));
    info_ = source->info();
    return read_rest(*source);
  }
  static std::string header(int count, const std::string& more = "") {
    return "ply\nformat ascii 1.0\nelement vertex " + std::to_string(count) +
           "\nproperty float x\nproperty float y\nproperty float z\nproperty float nx\nproperty float ny\n"
           "property float nz\n" +
           more + "end_header\n";
  }
  Scratch scratch_;
  CloudInfo info_;
};

TEST_F(PlyText, NumbersMayBeWrittenInManyWays) {
  const auto result = read(header(2, "property uchar alpha\nproperty int label\n") +
                           "+1.5 -2e0\t.5  0 0 7 255.0 -3\r\n\n1E1 1 1 1e-400 0 2 1 +4");
  ASSERT_EQ(result.rays.size(), 2u);
  EXPECT_EQ(result.rays.ends[0], Eigen::Vector3d(1.5, -2.0, 0.5));
  EXPECT_EQ(result.rays.starts[0], Eigen::Vector3d(1.5, -2.0, 7.5));
  EXPECT_EQ(result.rays.colours[0].intensity, 255);
  EXPECT_EQ(result.rays.ends[1], Eigen::Vector3d(10.0, 1.0, 1.0));
  EXPECT_EQ(result.rays.extra("label")->values<std::int32_t>()[0], -3);
  EXPECT_EQ(result.rays.extra("label")->values<std::int32_t>()[1], 4);
}

TEST_F(PlyText, RowsThatAreNotFiniteAreLeftOutAndCounted) {
  const auto result = read(header(6, "property double time\nproperty float odd\n") +
                           "1 1 1 0 0 2 0 nan\nnan 1 1 0 0 2 1 0\n1 inf 1 0 0 2 2 0\n1 1 1 0 0 -inf 3 0\n"
                           "1 1 1 0 0 2 1.#QNAN 0\n2 2 2 0 0 2 5 inf\n");
  EXPECT_EQ(result.dropped, 4u);
  ASSERT_EQ(result.rays.size(), 2u);
  EXPECT_EQ(result.rays.times, (std::vector<double>{0.0, 5.0}));
  EXPECT_TRUE(std::isnan(result.rays.extra("odd")->values<float>()[0]));  // an extra may hold anything
}

TEST_F(PlyText, ColoursOfOtherTypesAreScaledTo8Bits) {
  const auto colours = [&](const std::string& type, const std::string& values) {
    const auto result = read(
        header(1, "property " + type + " red\nproperty " + type + " green\nproperty " + type + " blue\n") +
        "1 2 3 0 0 2 " + values + "\n");
    const Colour c = result.rays.colours.at(0);
    return std::vector<int>{c.red, c.green, c.blue};
  };
  EXPECT_EQ(colours("float", "0 0.5 1"), (std::vector{0, 128, 255}));
  EXPECT_EQ(colours("double", "0 127.6 300"), (std::vector{0, 0, 1}));  // 16-bit range
  EXPECT_EQ(colours("float", "0 127.6 255"), (std::vector{0, 128, 255}));
  EXPECT_EQ(colours("ushort", "0 256 65535"), (std::vector{0, 1, 255}));
  EXPECT_EQ(colours("ushort", "0 200 255"), (std::vector{0, 200, 255}));
}

TEST_F(PlyText, OriginIsAddedAndAsksForDouble) {
  write_file(scratch_.path("a.ply"),
             "ply\nformat ascii 1.0\ncomment origin 500000.5 6900000.25 -1\ncomment crs EPSG:32632\n"
             "comment time_base gps_week\ncomment history rayimport --x\ncomment history raydecimate 4 cm\n" +
                 header(1).substr(header(1).find("element")) + "1 2 3 0 0 2\n");
  const auto source = open_ply(scratch_.path("a.ply"));
  EXPECT_EQ(source->info().precision, Precision::double_);
  EXPECT_EQ(source->info().crs, "EPSG:32632");
  EXPECT_EQ(source->info().time_base, "gps_week");
  EXPECT_EQ(source->info().history, (std::vector<std::string>{"rayimport --x", "raydecimate 4 cm"}));
  EXPECT_TRUE(source->info().comments.empty());
  const auto result = read_rest(*source);
  EXPECT_EQ(result.rays.ends[0], Eigen::Vector3d(500001.5, 6900002.25, 2.0));
  EXPECT_EQ(result.rays.starts[0], Eigen::Vector3d(500001.5, 6900002.25, 4.0));
}

TEST_F(PlyText, PointsKeepNormalsAndIntensityAsColumns) {
  std::string rows;
  for (int i = 0; i < 20; ++i)
    rows += "1 2 " + std::to_string(i) + " 0 0 1 300\n";
  const auto points = read_points(header(20, "property ushort scalar_Intensity\n") + rows);
  EXPECT_FALSE(info_.present.starts);
  EXPECT_FALSE(info_.present.intensity);
  EXPECT_FALSE(info_.present.times);
  EXPECT_EQ(info_.extras, (std::vector<ColumnInfo>{{"normal_x", ScalarType::float32},
                                                   {"normal_y", ScalarType::float32},
                                                   {"normal_z", ScalarType::float32},
                                                   {"intensity", ScalarType::uint16}}));
  EXPECT_EQ(points.rays.starts, points.rays.ends);
  EXPECT_EQ(points.rays.extra("intensity")->values<std::uint16_t>()[0], 300);
  // The same vectors in a file of this project are rays of one metre.
  const std::string text = header(20, "property ushort scalar_Intensity\n") + rows;
  const auto rays = read_points("ply\ncomment raycloud version 1\n" + text.substr(4));
  EXPECT_TRUE(info_.present.starts);
  EXPECT_EQ(rays.rays.starts[0], Eigen::Vector3d(1, 2, 1));
}

TEST_F(PlyText, ARayOfOneMetreIsARay) {
  EXPECT_EQ(read(header(1) + "0 0 0 0 0 1\n").rays.size(), 1u);
}

TEST_F(PlyText, BinaryDataMayBeginWithALineEnd) {
  // x begins with the byte '\n'; with '\r' first, too.
  for (const std::string line_end : {"\n", "\r\n", "\r"}) {
    for (const std::string& first : {std::string("\n\0\0\x41", 4), std::string("\r\n\0\x41", 4)}) {
      float x;
      std::memcpy(&x, first.data(), 4);
      FixtureFile file{.line_end = line_end,
                       .elements = {{"vertex",
                                     {{"float", "x", ""},
                                      {"float", "y", ""},
                                      {"float", "z", ""},
                                      {"float", "nx", ""},
                                      {"float", "ny", ""},
                                      {"float", "nz", ""}},
                                     {{{static_cast<double>(x)}, {2.0}, {3.0}, {4.0}, {5.0}, {6.0}}}}}};
      write_file(scratch_.path("b.ply"), bytes_of(file));
      const auto result = read_rest(*open_ply(scratch_.path("b.ply")));
      ASSERT_EQ(result.rays.size(), 1u);
      EXPECT_EQ(result.rays.ends[0], Eigen::Vector3d(static_cast<double>(x), 2.0, 3.0));
    }
  }
}

// The layout of our own files has a loop of its own.
TEST_F(PlyText, RowsOfOurOwnLayoutThatAreNotFiniteAreLeftOut) {
  const std::size_t real_sizes[] = {4, 8};
  for (const std::size_t real : real_sizes) {
    RayCloud cloud = random_cloud(3, {.rays = 100, .float_coordinates = true});
    CloudInfo info;
    info.precision = real == 4 ? Precision::single : Precision::double_;
    const auto path = scratch_.path("ours.ply");
    write_all(*create_ply(path, info), cloud);
    std::string bytes = read_file(path);
    const std::size_t data = bytes.find("end_header\n") + 11, row = 6 * real + 12;
    const auto spoil = [&](std::size_t ray, std::size_t at, std::size_t size) {
      // All ones are NaN; with the low bits cleared, infinity.
      std::string value(size, ray % 2 == 0 ? '\xff' : '\0');
      value[size - 1] = '\x7f';
      value[size - 2] = static_cast<char>(size == 4 ? 0x80 : 0xf0);
      bytes.replace(data + ray * row + at, size, value);
    };
    spoil(10, real, real);          // y
    spoil(21, 3 * real, 8);         // time
    spoil(32, 4 * real + 8, real);  // ny
    spoil(33, 5 * real + 8, real);  // nz
    std::ofstream(path, std::ios::binary) << bytes;
    const ReadBack result = read_rest(*open_ply(path, {.chunk_rays = 32}));
    EXPECT_EQ(result.dropped, 4u);
    std::vector<std::uint8_t> mask(100, 1);
    mask[10] = mask[21] = mask[32] = mask[33] = 0;
    cloud.select(mask);
    EXPECT_TRUE(same_bits(result.rays, cloud));
  }
}

TEST_F(PlyText, ZerosKeepTheirSign) {
  const auto ends = read(header(1) + "-0.0 0.0 -0 0 0 2\n").rays.ends;
  EXPECT_TRUE(std::signbit(ends[0].x()));
  EXPECT_FALSE(std::signbit(ends[0].y()));
  EXPECT_TRUE(std::signbit(ends[0].z()));
}

TEST_F(PlyText, AFileWithoutRowsIsAnEmptyCloud) {
  EXPECT_TRUE(read(header(0)).rays.empty());
  EXPECT_TRUE(read(header(0).substr(0, header(0).size() - 1)).rays.empty());
}

}  // namespace
}  // namespace ray
