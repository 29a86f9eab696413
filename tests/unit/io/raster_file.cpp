// What a GIS sees of a raster: read back by a small reader of its own.
#include "support/scratch.h"

#include <raycloud/core/error.h>
#include <raycloud/io/raster_file.h>

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>
#include <map>
#include <vector>

#define STB_IMAGE_STATIC
#define STB_IMAGE_IMPLEMENTATION
#define STBI_ONLY_PNG
#define STBI_NO_STDIO
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#include <stb_image.h>
#pragma GCC diagnostic pop

namespace ray {
namespace {

using namespace test;

/// Tags of one directory, all values as double, and texts.
struct Directory {
  std::map<int, std::vector<double>> numbers;
  std::map<int, std::string> texts;
  [[nodiscard]] std::size_t size(int tag) const { return static_cast<std::size_t>(numbers.at(tag).at(0)); }
};

class TiffReader {
 public:
  explicit TiffReader(const std::filesystem::path& path) {
    std::ifstream in(path, std::ios::binary);
    bytes_.assign(std::istreambuf_iterator<char>(in), {});
    EXPECT_EQ(bytes_.substr(0, 4), std::string("II\x2a\0", 4));
    for (auto at = get<std::uint32_t>(4); at != 0;)
      at = read_directory(at);
  }
  std::vector<Directory> directories;

  /// The values, with no-data cells as NaN.
  [[nodiscard]] std::vector<float> values(const Directory& directory) const {
    const std::size_t width = directory.size(256), height = directory.size(257), tile = directory.size(322);
    EXPECT_EQ(directory.size(259), 8U);
    EXPECT_EQ(directory.size(317), 3U);
    std::vector<float> all(width * height);
    const std::size_t across = (width + tile - 1) / tile;
    for (std::size_t i = 0; i < directory.numbers.at(324).size(); ++i) {
      const auto offset = static_cast<std::size_t>(directory.numbers.at(324)[i]);
      const auto size = static_cast<int>(directory.numbers.at(325)[i]);
      std::vector<char> plain(4 * tile * tile);
      EXPECT_EQ(
          stbi_zlib_decode_buffer(plain.data(), static_cast<int>(plain.size()), bytes_.data() + offset, size),
          static_cast<int>(plain.size()));
      for (std::size_t row = 0; row < tile; ++row) {
        std::vector<unsigned> line(4 * tile);
        unsigned sum = 0;
        for (std::size_t b = 0; b < line.size(); ++b)
          line[b] = sum = (sum + static_cast<unsigned char>(plain[row * line.size() + b])) & 255U;
        for (std::size_t column = 0; column < tile; ++column) {
          const std::size_t x = i % across * tile + column, y = i / across * tile + row;
          if (x >= width || y >= height) continue;
          const std::uint32_t bits = line[column] << 24 | line[tile + column] << 16 |
                                     line[2 * tile + column] << 8 | line[3 * tile + column];
          const auto value = std::bit_cast<float>(bits);
          all[y * width + x] = value == -9999.0F ? NAN : value;
        }
      }
    }
    return all;
  }

 private:
  template <class Value>
  [[nodiscard]] Value get(std::size_t at) const {
    Value value{};
    std::memcpy(&value, bytes_.data() + at, sizeof value);
    return value;
  }
  std::uint32_t read_directory(std::uint32_t at) {
    Directory& directory = directories.emplace_back();
    const auto count = get<std::uint16_t>(at);
    int last = 0;
    for (std::size_t i = 0; i < count; ++i) {
      const std::size_t field = at + 2 + 12 * i;
      const int tag = get<std::uint16_t>(field);
      EXPECT_GT(tag, last);
      last = tag;
      const int type = get<std::uint16_t>(field + 2);
      const auto values = get<std::uint32_t>(field + 4);
      const std::size_t width = type == 2 ? 1 : type == 3 ? 2 : type == 4 ? 4 : 8;
      const std::size_t place = values * width <= 4 ? field + 8 : get<std::uint32_t>(field + 8);
      if (type == 2) directory.texts[tag] = std::string(bytes_.data() + place);
      for (std::size_t v = 0; v < values && type != 2; ++v) {
        const std::size_t one = place + v * width;
        directory.numbers[tag].push_back(type == 3   ? get<std::uint16_t>(one)
                                         : type == 4 ? get<std::uint32_t>(one)
                                                     : get<double>(one));
      }
    }
    return get<std::uint32_t>(at + 2 + 12 * std::size_t{count});
  }
  std::string bytes_;
};

Raster hills(std::size_t width, std::size_t height) {
  Raster raster{width, height, 0.5, {500100.5, 5400200.0}, {}};
  for (std::size_t i = 0; i < width * height; ++i) {
    const float x = static_cast<float>(i % width), y = static_cast<float>(i / width);
    raster.values.push_back(i % 7 == 3 ? NAN : 100.0F + 3.0F * std::sin(x / 9) * std::cos(y / 5));
  }
  return raster;
}

bool same(const std::vector<float>& a, const std::vector<float>& b) {
  for (std::size_t i = 0; i < a.size(); ++i)
    if (a[i] != b[i] && !(std::isnan(a[i]) && std::isnan(b[i]))) return false;
  return a.size() == b.size();
}

TEST(RasterFile, GivesBackEveryCellAndItsPlace) {
  const Scratch scratch;
  for (const auto& [width, height] : {std::pair<std::size_t, std::size_t>{1, 1}, {256, 3}, {300, 520}}) {
    const Raster raster = hills(width, height);
    write_raster(scratch.path("a.tif"), raster, "");
    const TiffReader tiff(scratch.path("a.tif"));
    const Directory& main = tiff.directories.front();
    EXPECT_EQ(main.size(256), width);
    EXPECT_EQ(main.size(257), height);
    EXPECT_EQ(main.size(339), 3U);
    EXPECT_TRUE(same(tiff.values(main), raster.values));
    EXPECT_EQ(main.texts.at(42113), "-9999");
    EXPECT_EQ(main.numbers.at(33550), (std::vector<double>{0.5, 0.5, 0}));
    EXPECT_EQ(main.numbers.at(33922), (std::vector<double>{0, 0, 0, 500100.5, 5400200, 0}));
  }
}

TEST(RasterFile, OverviewsAreMeansOfWhatThereIs) {
  const Scratch scratch;
  const Raster raster = hills(601, 40);
  write_raster(scratch.path("a.tif"), raster, "");
  const TiffReader tiff(scratch.path("a.tif"));
  ASSERT_EQ(tiff.directories.size(), 3U);
  std::vector<float> finer = raster.values;
  std::size_t width = 601, height = 40;
  for (std::size_t level = 1; level < 3; ++level) {
    const Directory& own = tiff.directories[level];
    EXPECT_EQ(own.size(254), 1U);
    const std::vector<float> values = tiff.values(own);
    const std::size_t half = (width + 1) / 2;
    ASSERT_EQ(own.size(256), half);
    for (std::size_t i = 0; i < values.size(); ++i) {
      double sum = 0;
      int count = 0;
      for (const std::size_t x : {2 * (i % half), 2 * (i % half) + 1})
        for (const std::size_t y : {2 * (i / half), 2 * (i / half) + 1})
          if (x < width && y < height && !std::isnan(finer[y * width + x]))
            sum += finer[y * width + x], ++count;
      if (count == 0) {
        EXPECT_TRUE(std::isnan(values[i]));
      } else {
        EXPECT_FLOAT_EQ(values[i], static_cast<float>(sum / count));
      }
    }
    finer = values;
    width = half;
    height = (height + 1) / 2;
  }
}

TEST(RasterFile, StatesTheCoordinateSystem) {
  const Scratch scratch;
  const auto keys = [&](const std::string& crs) {
    write_raster(scratch.path("a.tif"), hills(2, 2), crs);
    const TiffReader tiff(scratch.path("a.tif"));
    std::map<int, int> found;
    const auto& numbers = tiff.directories.front().numbers.at(34735);
    EXPECT_EQ(numbers.size(), 4 + 4 * static_cast<std::size_t>(numbers[3]));
    for (std::size_t i = 4; i < numbers.size(); i += 4)
      found[static_cast<int>(numbers[i])] = static_cast<int>(numbers[i + 3]);
    if (found.contains(1026)) {
      EXPECT_EQ(tiff.directories.front().texts.at(34737), crs + "|");
    }
    return found;
  };
  using Keys = std::map<int, int>;
  const Keys utm{{1024, 1}, {1025, 1}, {3072, 32633}};
  EXPECT_EQ(keys("EPSG:32633"), utm);
  EXPECT_EQ(keys("PROJCS[\"x\",GEOGCS[\"y\",AUTHORITY[\"EPSG\",\"4326\"]],AUTHORITY[\"EPSG\",\"32633\"]]"),
            utm);
  EXPECT_EQ(keys("PROJCRS[\"x\",BASEGEOGCRS[\"y\",ID[\"EPSG\",4326]],ID[\"EPSG\",32633]]"), utm);
  EXPECT_EQ(keys("EPSG:4326"), (Keys{{1024, 2}, {1025, 1}, {2048, 4326}}));
  EXPECT_EQ(keys(""), (Keys{{1025, 1}}));
  // The code of a part is not that of the whole.
  EXPECT_EQ(keys("PROJCS[\"own\",GEOGCS[\"y\",AUTHORITY[\"EPSG\",\"4326\"]],UNIT[\"metre\",1]]"),
            (Keys{{1025, 1}, {1026, 0}}));
}

TEST(RasterFile, RefusesWhatItCannotWrite) {
  const Scratch scratch;
  EXPECT_THROW(write_raster(scratch.path("a.png"), hills(2, 2), ""), Error);
  EXPECT_THROW(write_raster(scratch.path("a.tif"), Raster{}, ""), Error);
  EXPECT_THROW(write_raster(scratch.path("none/a.tif"), hills(2, 2), ""), Error);
  EXPECT_TRUE(std::filesystem::is_empty(scratch.folder()));
}

}  // namespace
}  // namespace ray
