#include "las_fixture.h"
#include "support/random_cloud.h"
#include "support/scratch.h"

#include <raycloud/core/error.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>

namespace {

using namespace ray;
using namespace ray::test;
using namespace ray::test::las;
using testing::ElementsAre;
using testing::HasSubstr;

template <class T>
T value(const RayCloud& rays, const std::string& name, std::size_t row) {
  const Column* column = rays.extra(name);
  if (column == nullptr || column->type() != scalar_type_of<T>())
    throw std::runtime_error("no column " + name);
  return column->values<T>()[row];
}

int flags_of(const LasPoint& p) {
  return p.synthetic | p.key_point << 1 | p.withheld << 2 | p.overlap << 3 | p.channel << 4 |
         p.direction << 6 | p.edge << 7;
}

void expect_point(const LasFile& file, const RayCloud& rays, std::size_t i) {
  const LasPoint& p = file.points[i];
  SCOPED_TRACE("point " + std::to_string(i) + " of format " + std::to_string(file.format));
  for (std::size_t axis = 0; axis < 3; ++axis)
    ASSERT_EQ(rays.ends[i][static_cast<Eigen::Index>(axis)],
              p.xyz[axis] * file.scale[axis] + file.offset[axis]);
  ASSERT_EQ(rays.starts[i], rays.ends[i]);
  ASSERT_EQ(rays.bounded[i], 1);
  ASSERT_EQ(rays.times[i], has_time(file.format) ? p.time : 0.0);
  ASSERT_EQ(value<std::uint16_t>(rays, "intensity", i), p.intensity);
  ASSERT_EQ(value<std::uint8_t>(rays, "return_number", i), p.return_number);
  ASSERT_EQ(value<std::uint8_t>(rays, "number_of_returns", i), p.number_of_returns);
  ASSERT_EQ(value<std::uint8_t>(rays, "classification", i), p.classification);
  ASSERT_EQ(value<std::uint8_t>(rays, "flags", i), flags_of(p));
  ASSERT_FLOAT_EQ(value<float>(rays, "scan_angle", i),
                  static_cast<float>(p.scan_angle * (file.format < 6 ? 1.0 : 0.006)));
  ASSERT_EQ(value<std::uint8_t>(rays, "user_data", i), p.user_data);
  ASSERT_EQ(value<std::uint16_t>(rays, "point_source_id", i), p.source);
  const auto high = [&](std::size_t c) { return static_cast<std::uint8_t>(p.rgbi[c] >> 8); };
  const Colour colour = has_colour(file.format) ? Colour{high(0), high(1), high(2), 255} : Colour{};
  ASSERT_EQ(rays.colours[i], colour);
  if (has_infrared(file.format)) {
    ASSERT_EQ(value<std::uint16_t>(rays, "nir", i), p.rgbi[3]);
  }
  if (has_wave(file.format)) {
    const auto at = [&]<class T>(std::size_t byte, T) {
      T v;
      std::memcpy(&v, p.wave.data() + byte, sizeof v);
      return v;
    };
    ASSERT_EQ(value<std::uint8_t>(rays, "wave_packet_descriptor_index", i), p.wave[0]);
    ASSERT_EQ(value<std::uint64_t>(rays, "byte_offset_to_waveform_data", i), at(1, std::uint64_t{}));
    ASSERT_EQ(value<std::uint32_t>(rays, "waveform_packet_size", i), at(9, std::uint32_t{}));
    ASSERT_EQ(value<float>(rays, "return_point_waveform_location", i), at(13, float{}));
    ASSERT_EQ(value<float>(rays, "parametric_dz", i), at(25, float{}));
  }
}

class LasFormat : public testing::TestWithParam<int> {};

TEST_P(LasFormat, EveryFieldComesOutPlainAndCompressed) {
  const Scratch scratch;
  const LasFile file = random_file(7, GetParam(), 500);
  store_bytes(scratch.path("a.las"), bytes_of(file));
  const RayCloud plain = read_points(scratch.path("a.las"), 1, 64);
  ASSERT_EQ(plain.size(), file.points.size());
  for (std::size_t i = 0; i < plain.size(); ++i)
    expect_point(file, plain, i);
  const auto source = open_las_points(scratch.path("a.las"));
  EXPECT_EQ(source->info().present.times, has_time(GetParam()));
  EXPECT_EQ(source->info().present.colours, has_colour(GetParam()));
  EXPECT_FALSE(source->info().present.starts);
  EXPECT_EQ(source->info().coordinate_step, 0.01);
  EXPECT_EQ(source->info().ray_count, 500u);

  compress(scratch.path("a.las"), scratch.path("a.laz"));
  EXPECT_TRUE(same_bits(plain, read_points(scratch.path("a.laz"))));
}

INSTANTIATE_TEST_SUITE_P(All, LasFormat, testing::Range(0, 11));

TEST(LasReading, NeitherThreadsNorChunksChangeTheRays) {
  const Scratch scratch;
  for (const int format : {1, 3, 6, 7, 10}) {
    store_bytes(scratch.path("a.las"), bytes_of(random_file(3, format, 400)));
    const RayCloud all = read_points(scratch.path("a.las"));
    for (const std::uint32_t laz_chunk : {1u, 7u, 99u, 50000u}) {
      compress(scratch.path("a.las"), scratch.path("a.laz"), {.chunk_rows = laz_chunk});
      for (const std::size_t chunk : {1u, 7u, 128u, 1000000u})
        for (const unsigned threads : {1u, 2u, 8u})
          ASSERT_TRUE(same_bits(all, read_points(scratch.path("a.laz"), threads, chunk)))
              << "format " << format << " laz chunk " << laz_chunk << " chunk " << chunk << " threads "
              << threads;
    }
  }
}

TEST(LasReading, LargeLazChunksAreReadInOrderOrInHalves) {
  const Scratch scratch;
  LasFile file = random_file(3, 1, 400);
  for (int doubling = 0; doubling < 10; ++doubling) {
    const std::vector<LasPoint> points = file.points;
    file.points.insert(file.points.end(), points.begin(), points.end());
  }
  store_bytes(scratch.path("a.las"), bytes_of(file));
  const RayCloud all = read_points(scratch.path("a.las"));
  ASSERT_EQ(all.size(), 409600u);
  for (const std::uint32_t laz_chunk : {100000u, 300000u}) {
    compress(scratch.path("a.las"), scratch.path("a.laz"), {.chunk_rows = laz_chunk});
    EXPECT_TRUE(same_bits(all, read_points(scratch.path("a.laz"), 3))) << laz_chunk;
  }
}

TEST(LasReading, RewindStartsAgain) {
  const Scratch scratch;
  store_bytes(scratch.path("a.las"), bytes_of(random_file(5, 3, 300)));
  compress(scratch.path("a.las"), scratch.path("a.laz"), {.chunk_rows = 50});
  for (const char* name : {"a.las", "a.laz"}) {
    const auto source = open_las_points(scratch.path(name), {.chunk_rays = 40});
    const RayCloud once = read_all({}, *source);
    source->rewind();
    EXPECT_TRUE(same_bits(once, read_all({}, *source)));
  }
}

TEST(LasReading, AFileThatIsReplacedStaysTheOneThatWasOpened) {
  const Scratch scratch;
  store_bytes(scratch.path("a.las"), bytes_of(random_file(5, 3, 300)));
  compress(scratch.path("a.las"), scratch.path("a.laz"), {.chunk_rows = 50});
  const RayCloud expected = read_points(scratch.path("a.laz"));
  const auto source = open_las_points(scratch.path("a.laz"), {.chunk_rays = 50});
  store_bytes(scratch.path("b"), "something else");
  std::filesystem::rename(scratch.path("b"), scratch.path("a.laz"));
  EXPECT_TRUE(same_bits(expected, read_all({.threads = 4}, *source)));
}

TEST(LasReading, PointsOfLas14InOlderClothes) {
  const Scratch scratch;
  for (const int format : {6, 7, 8}) {
    store_bytes(scratch.path("a.las"), bytes_of(random_file(11, format, 700)));
    compress(scratch.path("a.las"), scratch.path("a.laz"), {.chunk_rows = 100, .compatible = true});
    const std::string stored = load_bytes(scratch.path("a.laz"));
    ASSERT_LT(static_cast<int>(stored[104]) & 0x3f, 6) << "the file must be of an old format for this test";
    EXPECT_TRUE(same_bits(read_points(scratch.path("a.las")), read_points(scratch.path("a.laz"), 2, 150)))
        << format;
  }
}

TEST(LasReading, ColoursOfOldFilesHaveEightBits) {
  const Scratch scratch;
  for (const int format : {2, 3, 7}) {
    LasFile file = random_file(13, format, 3000);
    for (LasPoint& p : file.points)
      for (auto& c : p.rgbi)
        c = c & 255;
    for (std::size_t i = 0; i < 100; ++i)
      file.points[i].rgbi = {0, 0, 0, 0};
    store_bytes(scratch.path("a.las"), bytes_of(file));
    compress(scratch.path("a.las"), scratch.path("a.laz"), {.chunk_rows = 64});
    for (const char* name : {"a.las", "a.laz"}) {
      const RayCloud rays = read_points(scratch.path(name), 3, 64);
      for (std::size_t i = 0; i < rays.size(); ++i) {
        ASSERT_EQ(rays.colours[i].red, file.points[i].rgbi[0]);
        ASSERT_EQ(rays.colours[i].blue, file.points[i].rgbi[2]);
      }
    }
  }
}

TEST(LasReading, OneBrightPointAtTheEndMakesAllColoursSixteenBit) {
  const Scratch scratch;
  for (const int format : {2, 3, 7}) {
    LasFile file = random_file(13, format, 3000);
    for (LasPoint& p : file.points)
      for (auto& c : p.rgbi)
        c = c & 255;
    file.points.back().rgbi = {256, 0, 0, 0};
    store_bytes(scratch.path("a.las"), bytes_of(file));
    compress(scratch.path("a.las"), scratch.path("a.laz"), {.chunk_rows = 64});
    for (const char* name : {"a.las", "a.laz"}) {
      for (const unsigned threads : {1u, 4u}) {
        const RayCloud rays = read_points(scratch.path(name), threads, 64);
        for (std::size_t i = 0; i + 1 < rays.size(); ++i)
          ASSERT_EQ(rays.colours[i], (Colour{0, 0, 0, 255}));
        EXPECT_EQ(rays.colours.back(), (Colour{1, 0, 0, 255}));
      }
    }
  }
}

TEST(LasReading, ExtraBytesOfEveryType) {
  LasFile file = random_file(17, 1, 2);
  std::string record;
  std::string extra;
  for (std::uint8_t type = 1; type <= 30; ++type)
    record += extra_entry(type, "t" + std::to_string(type));
  const auto put_number = [&](int type, int number) {
    switch ((type - 1) % 10) {
      case 0:
        return put(extra, static_cast<std::uint8_t>(number));
      case 1:
        return put(extra, static_cast<std::int8_t>(-number));
      case 2:
        return put(extra, static_cast<std::uint16_t>(number));
      case 3:
        return put(extra, static_cast<std::int16_t>(-number));
      case 4:
        return put(extra, static_cast<std::uint32_t>(number));
      case 5:
        return put(extra, static_cast<std::int32_t>(-number));
      case 6:
        return put(extra, static_cast<std::uint64_t>(number));
      case 7:
        return put(extra, static_cast<std::int64_t>(-number));
      case 8:
        return put(extra, static_cast<float>(number));
      default:
        return put(extra, static_cast<double>(-number));
    }
  };
  for (int type = 1; type <= 30; ++type)
    for (int i = 0; i < (type - 1) / 10 + 1; ++i)
      put_number(type, type + 40 * i);
  record += extra_entry(0, "raw", 2) + extra_entry(5, "scaled", 8 | 16, 0.5, 100.0) +
            extra_entry(3, "intensity") + extra_entry(3, "no_data", 1);
  put(extra, std::uint16_t{0x0201});
  put(extra, std::uint32_t{7});
  put(extra, std::uint16_t{77});
  put(extra, std::uint16_t{78});
  put(extra, std::uint16_t{0x0403});  // nobody says what these are
  file.records.push_back({"LASF_Spec", 4, record});
  file.extra_bytes = extra.size();
  for (LasPoint& p : file.points)
    p.extra = extra;
  const Scratch scratch;
  store_bytes(scratch.path("a.las"), bytes_of(file));
  const RayCloud rays = read_points(scratch.path("a.las"));
  EXPECT_EQ(value<std::uint8_t>(rays, "t1", 1), 1);
  EXPECT_EQ(value<std::int8_t>(rays, "t2", 1), -2);
  EXPECT_EQ(value<std::uint64_t>(rays, "t7", 1), 7u);
  EXPECT_EQ(value<std::int64_t>(rays, "t8", 1), -8);
  EXPECT_EQ(value<float>(rays, "t9", 1), 9.0f);
  EXPECT_EQ(value<double>(rays, "t10", 1), -10.0);
  EXPECT_EQ(value<std::int16_t>(rays, "t14_1", 1), -54);
  EXPECT_EQ(value<double>(rays, "t30_0", 1), -30.0);
  EXPECT_EQ(value<double>(rays, "t30_2", 1), -110.0);
  EXPECT_EQ(value<std::uint8_t>(rays, "raw_1", 1), 2);
  EXPECT_EQ(value<double>(rays, "scaled", 1), 103.5);
  EXPECT_EQ(value<std::uint16_t>(rays, "intensity", 1), file.points[1].intensity);
  EXPECT_EQ(value<std::uint16_t>(rays, "intensity_2", 1), 77);
  EXPECT_EQ(value<std::uint16_t>(rays, "no_data", 1), 78);
  EXPECT_EQ(value<std::uint8_t>(rays, "extra_byte_0", 1), 3);
  EXPECT_EQ(value<std::uint8_t>(rays, "extra_byte_1", 1), 4);
  EXPECT_THAT(open_las_points(scratch.path("a.las"))->info().formal_extras,
              ElementsAre("intensity", "return_number", "number_of_returns", "classification", "flags",
                          "scan_angle", "user_data", "point_source_id"));
}

TEST(LasReading, OriginsByTheNamesOfPdalMakeRays) {
  LasFile file = random_file(19, 6, 3);
  std::string record;
  for (const char* name : {"BeamOriginX", "BeamOriginY", "BeamOriginZ"})
    record += extra_entry(10, name);
  file.records.push_back({"LASF_Spec", 4, record});
  file.extra_bytes = 24;
  for (std::size_t i = 0; i < 3; ++i)
    for (const double v : {1.5, 2.5, i == 1 ? std::nan("") : 3.5})
      put(file.points[i].extra, v);
  const Scratch scratch;
  store_bytes(scratch.path("a.las"), bytes_of(file));
  const auto source = open_las(scratch.path("a.las"));
  EXPECT_TRUE(source->info().present.starts);
  RawChunk raw;
  RayCloud rays;
  ASSERT_TRUE(source->fetch(raw));
  EXPECT_EQ(source->decode(raw, rays), 1u) << "a start that is NaN";
  ASSERT_EQ(rays.size(), 2u);
  EXPECT_EQ(rays.starts[1], Eigen::Vector3d(1.5, 2.5, 3.5));
  EXPECT_EQ(rays.extra("BeamOriginX"), nullptr);
}

TEST(LasReading, ATimeThatIsNoNumberDropsItsRow) {
  const Scratch scratch;
  LasFile file = random_file(19, 1, 10);
  file.points[3].time = std::nan("");
  file.points[7].time = std::numeric_limits<double>::infinity();
  store_bytes(scratch.path("a.las"), bytes_of(file));
  const RayCloud rays = read_points(scratch.path("a.las"));
  ASSERT_EQ(rays.size(), 8u);
  EXPECT_EQ(rays.times[3], file.points[4].time);
}

TEST(LasReading, CoordinateSystem) {
  const auto crs_of = [](const std::vector<LasFile::Record>& records) {
    const Scratch scratch;
    LasFile file = random_file(1, 1, 1);
    file.records = records;
    store_bytes(scratch.path("a.las"), bytes_of(file));
    return open_las_points(scratch.path("a.las"))->info().crs;
  };
  const auto keys = [](std::uint16_t geographic, std::uint16_t projected) {
    std::string data;
    for (const std::uint16_t v :
         std::array<std::uint16_t, 12>{1, 1, 0, 2, 2048, 0, 1, geographic, 3072, 0, 1, projected})
      put(data, v);
    return LasFile::Record{"LASF_Projection", 34735, data};
  };
  const LasFile::Record wkt{"LASF_Projection", 2112, std::string("PROJCS[\"a\",\n UNIT[]]\0\0", 22)};
  EXPECT_EQ(crs_of({}), "");
  EXPECT_EQ(crs_of({keys(4326, 0)}), "EPSG:4326");
  EXPECT_EQ(crs_of({keys(4326, 32632)}), "EPSG:32632");
  EXPECT_EQ(crs_of({keys(0, 32767)}), "") << "32767 is user-defined";
  EXPECT_EQ(crs_of({keys(4326, 32632), wkt}), "PROJCS[\"a\",  UNIT[]]");
  EXPECT_EQ(crs_of({{"LASF_Projection", 2112, "''"}}), "");
  EXPECT_EQ(crs_of({{"LASF_Projection", 34735, "odd"}}), "");
}

TEST(LasReading, TimeBaseOfTheHeader) {
  const Scratch scratch;
  const auto base = [&](int format, std::uint16_t encoding) {
    LasFile file = random_file(1, format, 1);
    file.global_encoding = encoding;
    store_bytes(scratch.path("a.las"), bytes_of(file));
    return open_las_points(scratch.path("a.las"))->info().time_base;
  };
  EXPECT_EQ(base(1, 0), "gps_week");
  EXPECT_EQ(base(3, 1), "gps_adjusted");
  EXPECT_EQ(base(6, 17), "gps_adjusted");
  EXPECT_EQ(base(0, 1), "") << "there are no times";
}

std::string refusal(const std::filesystem::path& path, ErrorCode code, unsigned threads = 1) {
  try {
    const auto source = open_las_points(path, {.chunk_rays = 100});
    (void)read_all({.threads = threads}, *source);
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), code) << error.what();
    return error.what();
  }
  return "no error";
}

TEST(LasBadInput, SaysWhatIsWrong) {
  const Scratch scratch;
  const std::string good = bytes_of(random_file(23, 3, 20));
  const auto refused = [&](const std::string& bytes) {
    store_bytes(scratch.path("a.las"), bytes);
    return refusal(scratch.path("a.las"), ErrorCode::file_format);
  };
  const auto with = [&](std::size_t at, auto number) {
    std::string bytes = good;
    put_at(bytes, at, number);
    return bytes;
  };
  EXPECT_THAT(refusal(scratch.path("none.las"), ErrorCode::file_not_found), HasSubstr("none.las"));
  EXPECT_THAT(refused(""), HasSubstr("a.las: not a LAS file"));
  EXPECT_THAT(refused(std::string(400, 'x')), HasSubstr("not a LAS file"));
  EXPECT_THAT(refused(good.substr(0, 200)), HasSubstr("cut short in its header"));
  EXPECT_THAT(refused(good.substr(0, good.size() - 1)), HasSubstr("a.las: cut short after point 19 of 20"));
  EXPECT_THAT(refused(good.substr(0, good.size() - 34)), HasSubstr("cut short after point 19 of 20"));
  EXPECT_THAT(refused(with(107, std::uint32_t{21})), HasSubstr("cut short after point 20 of 21"));
  EXPECT_THAT(refused(with(24, std::uint8_t{2})), HasSubstr("LAS version 2.2"));
  EXPECT_THAT(refused(with(94, std::uint16_t{20})), HasSubstr("header is shorter"));
  EXPECT_THAT(refused(with(104, std::uint8_t{11})), HasSubstr("point format 11"));
  EXPECT_THAT(refused(with(104, std::uint8_t{131})), HasSubstr("compressed, but"));
  EXPECT_THAT(refused(with(105, std::uint16_t{33})), HasSubstr("33 bytes are too short for point format 3"));
  EXPECT_THAT(refused(with(96, std::uint32_t{100})), HasSubstr("points start inside its header"));
  EXPECT_THAT(refused(with(96, std::uint32_t{4000000000})), HasSubstr("cut short before its first point"));
  EXPECT_THAT(refused(with(131, std::nan(""))), HasSubstr("scale or offset"));
  EXPECT_THAT(refused(with(139, 0.0)), HasSubstr("scale or offset"));
  EXPECT_THAT(refused(with(155, 1e308 * 10)), HasSubstr("scale or offset"));
}

TEST(LasBadInput, PointsAreNoRays) {
  const Scratch scratch;
  store_bytes(scratch.path("a.las"), bytes_of(random_file(23, 3, 20)));
  try {
    (void)open_las(scratch.path("a.las"));
    FAIL() << "points were taken for rays";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::wrong_content);
    EXPECT_THAT(error.what(), HasSubstr("rayimport"));
  }
}

TEST(LasBadInput, RecordsThatMakeNoSenseAreLeftOut) {
  const Scratch scratch;
  LasFile file = random_file(29, 1, 20);
  file.records = {{"LASF_Projection", 34735, "ab"}, {"LASF_Spec", 4, "short"}, {"copc", 1, "x"}};
  const std::string good = bytes_of(file);
  store_bytes(scratch.path("a.las"), good);
  const RayCloud expected = read_points(scratch.path("a.las"));
  EXPECT_EQ(expected.size(), 20u);
  std::string bytes = good;
  put_at(bytes, 100, std::uint32_t{4000000000});
  put_at(bytes, 227 + 20, std::uint16_t{65535});
  store_bytes(scratch.path("a.las"), bytes);
  EXPECT_TRUE(same_bits(expected, read_points(scratch.path("a.las"))));
}

/// The chunks of a LAZ file start behind the place of its table.
std::size_t chunks_at(const std::string& laz) {
  std::uint32_t at;
  std::memcpy(&at, laz.data() + 96, 4);
  return at + 8;
}

class LazDamage : public testing::TestWithParam<int> {};

TEST_P(LazDamage, ACutFileNamesTheLastWholePoint) {
  const Scratch scratch;
  store_bytes(scratch.path("a.las"), bytes_of(random_file(31, GetParam(), 1000)));
  compress(scratch.path("a.las"), scratch.path("a.laz"), {.chunk_rows = 100});
  const std::string good = load_bytes(scratch.path("a.laz"));
  const std::size_t first = chunks_at(good);
  for (std::size_t size = first + 10; size + 200 < good.size(); size += (good.size() - first) / 13) {
    store_bytes(scratch.path("cut.laz"), good.substr(0, size));
    const std::size_t whole = plain_loop(scratch.path("cut.laz")).ends.size();
    for (const unsigned threads : {1u, 3u})
      EXPECT_THAT(refusal(scratch.path("cut.laz"), ErrorCode::file_format, threads),
                  HasSubstr("cut.laz: cut short after point " + std::to_string(whole) + " of 1000"));
  }
}

TEST_P(LazDamage, ChangedBytesGiveAnErrorOrThePointsOfAPlainLoop) {
  const Scratch scratch;
  store_bytes(scratch.path("a.las"), bytes_of(random_file(37, GetParam(), 1000)));
  compress(scratch.path("a.las"), scratch.path("a.laz"), {.chunk_rows = 100});
  const std::string good = load_bytes(scratch.path("a.laz"));
  const std::size_t first = chunks_at(good);
  int errors = 0;
  for (std::size_t at = first; at < good.size(); at += (good.size() - first) / 40) {
    std::string bytes = good;
    for (std::size_t i = at; i < std::min(at + 8, bytes.size()); ++i)
      bytes[i] = static_cast<char>(bytes[i] ^ 0x5a);
    store_bytes(scratch.path("bad.laz"), bytes);
    const PlainPoints plain = plain_loop(scratch.path("bad.laz"));
    try {
      const RayCloud rays = read_points(scratch.path("bad.laz"), 3, 100);
      ASSERT_TRUE(plain.whole) << "damage at byte " << at << " went unnoticed";
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::file_format);
      ++errors;
    }
  }
  EXPECT_GT(errors, 10);
}

INSTANTIATE_TEST_SUITE_P(Formats, LazDamage, testing::Values(1, 3));

TEST(LasBadInput, LaszipRecordThatDoesNotFit) {
  const Scratch scratch;
  store_bytes(scratch.path("a.las"), bytes_of(random_file(31, 3, 100)));
  compress(scratch.path("a.las"), scratch.path("a.laz"));
  const std::string good = load_bytes(scratch.path("a.laz"));
  const std::size_t record = 227 + 54;
  const auto refused = [&](std::size_t at, auto number) {
    std::string bytes = good;
    put_at(bytes, record + at, number);
    store_bytes(scratch.path("a.laz"), bytes);
    return refusal(scratch.path("a.laz"), ErrorCode::file_format);
  };
  EXPECT_THAT(refused(32, std::uint16_t{60000}), HasSubstr("LASzip record"));
  EXPECT_THAT(refused(34, std::uint16_t{10}), HasSubstr("LASzip record"));
  EXPECT_THAT(refused(36, std::uint16_t{65535}), HasSubstr("LASzip record"));
  EXPECT_THAT(refused(38, std::uint16_t{99}), HasSubstr("a.laz")) << "a version LASzip does not know";
}

}  // namespace
