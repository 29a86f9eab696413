#include "deflate.h"
#include "file_kind.h"
#include "las_crs.h"

#include <raycloud/core/error.h>
#include <raycloud/io/atomic_file.h>
#include <raycloud/io/raster_file.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>

namespace ray {
namespace {

static_assert(std::endian::native == std::endian::little);

constexpr std::size_t kTile = 256;  // cells on a side
constexpr float kNoData = -9999.0F;

using Bytes = std::vector<std::byte>;

enum TiffType : std::uint16_t { kAscii = 2, kShort = 3, kLong = 4, kDouble = 12 };

/// An image file directory: TIFF 6.0, section 2.
class TiffDirectory {
 public:
  template <class Value>
  void add(std::uint16_t tag, TiffType type, const std::vector<Value>& values) {
    Field field{tag, type, static_cast<std::uint32_t>(values.size()), Bytes(sizeof(Value) * values.size())};
    std::memcpy(field.bytes.data(), values.data(), field.bytes.size());
    fields_.push_back(std::move(field));
  }
  void add_short(std::uint16_t tag, std::size_t value) {
    add(tag, kShort, std::vector{static_cast<std::uint16_t>(value)});
  }
  void add_long(std::uint16_t tag, std::size_t value) {
    add(tag, kLong, std::vector{static_cast<std::uint32_t>(value)});
  }
  void add_text(std::uint16_t tag, const std::string& text) {
    add(tag, kAscii, std::vector<char>(text.c_str(), text.c_str() + text.size() + 1));
  }

  [[nodiscard]] std::size_t size() const {
    std::size_t size = 2 + 12 * fields_.size() + 4;
    for (const Field& field : fields_)
      if (field.bytes.size() > 4) size += padded(field.bytes.size());
    return size;
  }

  /// At byte `at` of the file; `next` is where the following directory is, 0 for none.
  void write(Bytes& file, std::size_t at, std::size_t next) {
    std::sort(fields_.begin(), fields_.end(), [](const Field& a, const Field& b) { return a.tag < b.tag; });
    std::size_t far = at + 2 + 12 * fields_.size() + 4;
    put(file, at, static_cast<std::uint16_t>(fields_.size()));
    at += 2;
    for (const Field& field : fields_) {
      put(file, at, field.tag);
      put(file, at + 2, static_cast<std::uint16_t>(field.type));
      put(file, at + 4, field.count);
      std::size_t place = at + 8;
      if (field.bytes.size() > 4) {
        put(file, at + 8, static_cast<std::uint32_t>(far));
        place = far;
        far += padded(field.bytes.size());
      }
      std::memcpy(file.data() + place, field.bytes.data(), field.bytes.size());
      at += 12;
    }
    put(file, at, static_cast<std::uint32_t>(next));
  }

 private:
  struct Field {
    std::uint16_t tag;
    TiffType type;
    std::uint32_t count;
    Bytes bytes;
  };
  static std::size_t padded(std::size_t size) { return (size + 7) / 8 * 8; }
  template <class Value>
  static void put(Bytes& file, std::size_t at, Value value) {
    std::memcpy(file.data() + at, &value, sizeof value);
  }
  std::vector<Field> fields_;
};

/// Bytes of a row sorted by how much they count, each as the difference from the one before: heights that
/// hardly change become zeros (Adobe, "TIFF Technical Note 3", 2005).
void append_predicted(const float* row, Bytes& bytes) {
  const std::size_t begin = bytes.size();
  bytes.resize(begin + 4 * kTile);
  for (std::size_t i = 0; i < kTile; ++i) {
    const auto bits = std::bit_cast<std::uint32_t>(row[i]);
    for (std::size_t byte = 0; byte < 4; ++byte)
      bytes[begin + byte * kTile + i] = static_cast<std::byte>(bits >> (24 - 8 * byte));
  }
  for (std::size_t i = bytes.size() - 1; i > begin; --i)
    bytes[i] =
        static_cast<std::byte>(std::to_integer<unsigned>(bytes[i]) - std::to_integer<unsigned>(bytes[i - 1]));
}

std::vector<Bytes> tiles_of(const Raster& raster) {
  std::vector<Bytes> tiles;
  for (std::size_t top = 0; top < raster.height; top += kTile) {
    for (std::size_t left = 0; left < raster.width; left += kTile) {
      Bytes plain;
      for (std::size_t row = top; row < top + kTile; ++row) {
        std::array<float, kTile> line{};
        line.fill(kNoData);
        for (std::size_t column = left; column < std::min(left + kTile, raster.width); ++column) {
          if (row >= raster.height) break;
          const float value = raster.values[row * raster.width + column];
          if (!std::isnan(value)) line[column - left] = value;
        }
        append_predicted(line.data(), plain);
      }
      tiles.push_back(deflated(plain));
    }
  }
  return tiles;
}

/// Half as many cells a side, each the mean of those of the four that have a value.
Raster overview_of(const Raster& raster) {
  Raster half{(raster.width + 1) / 2, (raster.height + 1) / 2, 2.0 * raster.cell, raster.corner, {}};
  half.values.reserve(half.width * half.height);
  for (std::size_t row = 0; row < half.height; ++row) {
    for (std::size_t column = 0; column < half.width; ++column) {
      double sum = 0.0;
      int count = 0;
      for (std::size_t r = 2 * row; r < std::min(2 * row + 2, raster.height); ++r) {
        for (std::size_t c = 2 * column; c < std::min(2 * column + 2, raster.width); ++c) {
          const float value = raster.values[r * raster.width + c];
          if (std::isnan(value)) continue;
          sum += static_cast<double>(value);
          ++count;
        }
      }
      half.values.push_back(count > 0 ? static_cast<float>(sum / count)
                                      : std::numeric_limits<float>::quiet_NaN());
    }
  }
  return half;
}

TiffDirectory layout_of(const Raster& raster, bool is_overview) {
  TiffDirectory directory;
  directory.add_long(254, is_overview ? 1 : 0);
  directory.add_long(256, raster.width);
  directory.add_long(257, raster.height);
  directory.add_short(258, 32);
  directory.add_short(259, 8);  // deflate
  directory.add_short(262, 1);
  directory.add_short(277, 1);
  directory.add_short(317, 3);  // append_predicted
  directory.add_short(322, kTile);
  directory.add_short(323, kTile);
  directory.add_short(339, 3);  // real numbers
  directory.add_text(42113, std::to_string(static_cast<int>(kNoData)));
  return directory;
}

/// The code that a WKT states for the whole system, which comes last: AUTHORITY["EPSG","n"] or ID["EPSG",n].
std::string epsg_of_wkt(const std::string& wkt) {
  for (const char* word : {"AUTHORITY[\"EPSG\",\"", "ID[\"EPSG\","}) {
    const std::size_t at = wkt.rfind(word);
    if (at == std::string::npos) continue;
    const std::size_t begin = at + std::strlen(word);
    const std::size_t end = wkt.find_first_not_of("0123456789", begin);
    // Nothing but its own brackets and those of the system may follow.
    const std::size_t rest = end == std::string::npos ? end : wkt.find_first_not_of("\"] ", end);
    if (end != begin && rest == std::string::npos) return "EPSG:" + wkt.substr(begin, end - begin);
  }
  return {};
}

/// Where the raster lies (GeoTIFF 1.1, sections 7.1 and B.6).
void add_place(TiffDirectory& directory, const Raster& raster, const std::string& crs) {
  directory.add(33550, kDouble, std::vector{raster.cell, raster.cell, 0.0});
  directory.add(33922, kDouble, std::vector{0.0, 0.0, 0.0, raster.corner.x(), raster.corner.y(), 0.0});
  Bytes keys = geokeys_of_epsg(is_wkt(crs) ? epsg_of_wkt(crs) : crs);
  if (keys.empty()) {
    // Cells are areas; of the system no more is known than its words.
    std::vector<std::uint16_t> plain{1, 1, 0, 1, 1025, 0, 1, 1};
    if (!crs.empty()) {
      plain[3] = 2;
      plain.insert(plain.end(), {1026, 34737, static_cast<std::uint16_t>(crs.size() + 1), 0});
      directory.add_text(34737, crs + "|");
    }
    directory.add(34735, kShort, plain);
    return;
  }
  std::vector<std::uint16_t> values(keys.size() / 2);
  std::memcpy(values.data(), keys.data(), keys.size());
  directory.add(34735, kShort, values);
}

}  // namespace

void write_raster(const std::filesystem::path& path, const Raster& raster, const std::string& crs,
                  const WriteOptions& options) {
  (void)known_extension(path, {".tif", ".tiff"});
  if (raster.values.empty() || raster.values.size() > kMostRasterCells)
    throw Error(ErrorCode::out_of_range, path.string() + ": a raster of " + std::to_string(raster.width) +
                                             " x " + std::to_string(raster.height) +
                                             " cells cannot be written");
  std::vector<Raster> halves;
  for (const Raster* last = &raster; std::max(last->width, last->height) > kTile; last = &halves.back())
    halves.push_back(overview_of(*last));

  std::vector<TiffDirectory> directories;
  std::vector<std::vector<Bytes>> tiles;
  for (std::size_t level = 0; level <= halves.size(); ++level) {
    const Raster& own = level == 0 ? raster : halves[level - 1];
    directories.push_back(layout_of(own, level > 0));
    tiles.push_back(tiles_of(own));
  }
  add_place(directories.front(), raster, crs.size() < 0xFFFF ? crs : "");

  // Directories first; then the smallest overview, so that a glance needs the beginning of the file only.
  std::size_t end = 8;
  std::vector<std::size_t> places;
  for (std::size_t level = 0; level < directories.size(); ++level) {
    places.push_back(end);
    TiffDirectory measured = directories[level];
    measured.add(324, kLong, std::vector<std::uint32_t>(tiles[level].size()));
    measured.add(325, kLong, std::vector<std::uint32_t>(tiles[level].size()));
    end += (measured.size() + 7) / 8 * 8;
  }
  Bytes head(end);
  for (std::size_t level = directories.size(); level-- > 0;) {
    std::vector<std::uint32_t> offsets, sizes;
    for (const Bytes& tile : tiles[level]) {
      offsets.push_back(static_cast<std::uint32_t>(end));
      sizes.push_back(static_cast<std::uint32_t>(tile.size()));
      end += tile.size();
    }
    directories[level].add(324, kLong, offsets);
    directories[level].add(325, kLong, sizes);
    directories[level].write(head, places[level], level + 1 < places.size() ? places[level + 1] : 0);
  }
  constexpr std::array<std::uint8_t, 8> kMagic{'I', 'I', 42, 0, 8, 0, 0, 0};
  std::memcpy(head.data(), kMagic.data(), kMagic.size());
  AtomicFile file(path, options);
  file.write(head);
  for (std::size_t level = tiles.size(); level-- > 0;) {
    Bytes all;
    for (const Bytes& tile : tiles[level])
      all.insert(all.end(), tile.begin(), tile.end());
    file.write(all);
  }
  file.commit();
}

}  // namespace ray
