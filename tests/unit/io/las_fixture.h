#pragma once
// LAS files made by hand and read by LASzip's own loop: what the reader is held against.

#include <raycloud/core/ray_cloud.h>
#include <raycloud/core/ray_stream.h>
#include <raycloud/exec/random.h>
#include <raycloud/exec/stream.h>
#include <raycloud/io/las_cloud.h>

#include <laszip/laszip_api.h>

#include <array>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace ray::test::las {

/// A point as the standard describes it, not as any format stores it.
struct LasPoint {
  std::array<std::int32_t, 3> xyz{};
  std::uint16_t intensity = 0;
  std::uint8_t return_number = 1;
  std::uint8_t number_of_returns = 1;
  std::uint8_t classification = 0;
  bool synthetic = false;
  bool key_point = false;
  bool withheld = false;
  bool overlap = false;
  std::uint8_t channel = 0;
  bool direction = false;
  bool edge = false;
  int scan_angle = 0;  ///< as stored: degrees in formats 0–5, 0.006 degrees in 6–10
  std::uint8_t user_data = 0;
  std::uint16_t source = 0;
  double time = 0.0;
  std::array<std::uint16_t, 4> rgbi{};
  std::array<std::uint8_t, 29> wave{};
  std::string extra;  ///< bytes
};

struct LasFile {
  int minor = 2;
  int format = 0;
  std::array<double, 3> scale{0.01, 0.01, 0.01};
  std::array<double, 3> offset{0.0, 0.0, 0.0};
  std::uint16_t global_encoding = 0;
  struct Record {
    std::string user;
    std::uint16_t id = 0;
    std::string data;
  };
  std::vector<Record> records;
  std::size_t extra_bytes = 0;
  std::vector<LasPoint> points;
};

template <class T>
void put(std::string& bytes, T value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

template <class T>
void put_at(std::string& bytes, std::size_t at, T value) {
  std::memcpy(bytes.data() + at, &value, sizeof value);
}

inline bool has_time(int format) {
  return format != 0 && format != 2;
}
inline bool has_colour(int format) {
  return format == 2 || format == 3 || format == 5 || format == 7 || format == 8 || format == 10;
}
inline bool has_infrared(int format) {
  return format == 8 || format == 10;
}
inline bool has_wave(int format) {
  return format == 4 || format == 5 || format == 9 || format == 10;
}

inline std::string record_of(const LasPoint& p, int format) {
  std::string r;
  for (const std::int32_t v : p.xyz)
    put(r, v);
  put(r, p.intensity);
  const int line = (p.direction ? 64 : 0) | (p.edge ? 128 : 0);
  if (format < 6) {
    put(r, static_cast<std::uint8_t>(p.return_number | p.number_of_returns << 3 | line));
    put(r,
        static_cast<std::uint8_t>(p.classification | p.synthetic << 5 | p.key_point << 6 | p.withheld << 7));
    put(r, static_cast<std::int8_t>(p.scan_angle));
    put(r, p.user_data);
    put(r, p.source);
  } else {
    put(r, static_cast<std::uint8_t>(p.return_number | p.number_of_returns << 4));
    put(r, static_cast<std::uint8_t>(p.synthetic | p.key_point << 1 | p.withheld << 2 | p.overlap << 3 |
                                     p.channel << 4 | line));
    put(r, p.classification);
    put(r, p.user_data);
    put(r, static_cast<std::int16_t>(p.scan_angle));
    put(r, p.source);
  }
  if (has_time(format)) put(r, p.time);
  if (has_colour(format))
    for (int i = 0; i < (has_infrared(format) ? 4 : 3); ++i)
      put(r, p.rgbi[static_cast<std::size_t>(i)]);
  if (has_wave(format)) r.append(reinterpret_cast<const char*>(p.wave.data()), p.wave.size());
  return r + p.extra;
}

inline std::string bytes_of(const LasFile& file) {
  std::string head(file.minor >= 4 ? 375 : file.minor == 3 ? 235 : 227, '\0');
  std::string records;
  for (const auto& record : file.records) {
    std::string vlr(54, '\0');
    record.user.copy(vlr.data() + 2, 16);
    put_at(vlr, 18, record.id);
    put_at(vlr, 20, static_cast<std::uint16_t>(record.data.size()));
    records += vlr + record.data;
  }
  head.replace(0, 4, "LASF");
  put_at(head, 6, file.global_encoding);
  put_at<std::uint8_t>(head, 24, 1);
  put_at(head, 25, static_cast<std::uint8_t>(file.minor));
  put_at(head, 94, static_cast<std::uint16_t>(head.size()));
  put_at(head, 96, static_cast<std::uint32_t>(head.size() + records.size()));
  put_at(head, 100, static_cast<std::uint32_t>(file.records.size()));
  put_at(head, 104, static_cast<std::uint8_t>(file.format));
  const std::size_t length = record_of(LasPoint{}, file.format).size() + file.extra_bytes;
  put_at(head, 105, static_cast<std::uint16_t>(length));
  put_at(head, 107, static_cast<std::uint32_t>(file.format < 6 ? file.points.size() : 0));
  for (std::size_t axis = 0; axis < 3; ++axis) {
    put_at(head, 131 + 8 * axis, file.scale[axis]);
    put_at(head, 155 + 8 * axis, file.offset[axis]);
  }
  if (file.minor >= 4) put_at(head, 247, static_cast<std::uint64_t>(file.points.size()));
  std::string bytes = head + records;
  for (const LasPoint& point : file.points)
    bytes += record_of(point, file.format);
  return bytes;
}

inline void store_bytes(const std::filesystem::path& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary) << bytes;
}

inline std::string load_bytes(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

/// Every field random, within what the format holds.
inline LasPoint random_point(const RandomStream& random, std::uint64_t i, int format) {
  const auto draw = [&](std::uint64_t field, std::uint64_t below) { return random.below(below, i, field); };
  const bool newest = format >= 6;
  LasPoint p;
  for (std::size_t axis = 0; axis < 3; ++axis)
    p.xyz[axis] = static_cast<std::int32_t>(draw(axis, std::uint64_t{1} << 32));
  p.intensity = static_cast<std::uint16_t>(draw(3, 65536));
  p.return_number = static_cast<std::uint8_t>(draw(4, newest ? 16 : 8));
  p.number_of_returns = static_cast<std::uint8_t>(draw(5, newest ? 16 : 8));
  p.classification = static_cast<std::uint8_t>(draw(6, newest ? 256 : 32));
  p.synthetic = draw(7, 2) != 0;
  p.key_point = draw(8, 2) != 0;
  p.withheld = draw(9, 2) != 0;
  p.overlap = newest && draw(10, 2) != 0;
  p.channel = static_cast<std::uint8_t>(newest ? draw(11, 4) : 0);
  p.direction = draw(12, 2) != 0;
  p.edge = draw(13, 2) != 0;
  p.scan_angle = newest ? static_cast<int>(draw(14, 60001)) - 30000 : static_cast<int>(draw(14, 181)) - 90;
  p.user_data = static_cast<std::uint8_t>(draw(15, 256));
  p.source = static_cast<std::uint16_t>(draw(16, 65536));
  p.time = static_cast<double>(draw(17, 1 << 30)) / 1024.0;
  for (std::size_t c = 0; c < 4; ++c)
    p.rgbi[c] = static_cast<std::uint16_t>(draw(18 + c, 65536));
  for (std::size_t c = 0; c < 29; ++c)
    p.wave[c] = static_cast<std::uint8_t>(draw(30 + c, 100));
  return p;
}

inline LasFile random_file(std::uint64_t seed, int format, std::size_t points) {
  const RandomStream random(seed, "las");
  LasFile file;
  file.format = format;
  file.minor = format >= 6 ? 4 : format >= 4 ? 3 : 2;
  file.offset = {500000.0, 6900000.0, 100.0};
  for (std::size_t i = 0; i < points; ++i)
    file.points.push_back(random_point(random, i, format));
  return file;
}

/// What a loop over LASzip's own functions gives for a file of that name.
struct PlainPoints {
  std::vector<Eigen::Vector3d> ends;
  std::vector<laszip_point_struct> points;
  std::vector<std::string> extra_bytes;
  laszip_header_struct header{};  ///< its pointers are not valid
  bool whole = false;
};

inline PlainPoints plain_loop(const std::filesystem::path& path) {
  PlainPoints plain;
  laszip_POINTER laszip = nullptr;
  laszip_create(&laszip);
  laszip_BOOL compressed = 0;
  if (laszip_open_reader(laszip, path.c_str(), &compressed) == 0) {
    laszip_header_struct* header = nullptr;
    laszip_point_struct* point = nullptr;
    laszip_get_header_pointer(laszip, &header);
    laszip_get_point_pointer(laszip, &point);
    plain.header = *header;
    const std::uint64_t few = header->number_of_point_records;
    const std::uint64_t count = few != 0 ? few : header->extended_number_of_point_records;
    plain.whole = true;
    for (std::uint64_t i = 0; i < count; ++i) {
      if (laszip_read_point(laszip) != 0) {
        plain.whole = false;
        break;
      }
      Eigen::Vector3d end;
      laszip_get_coordinates(laszip, end.data());
      plain.ends.push_back(end);
      plain.points.push_back(*point);
      plain.extra_bytes.emplace_back(reinterpret_cast<const char*>(point->extra_bytes),
                                     static_cast<std::size_t>(point->num_extra_bytes));
    }
    laszip_close_reader(laszip);
  }
  laszip_destroy(laszip);
  return plain;
}

struct CompressOptions {
  std::uint32_t chunk_rows = 50000;
  bool compatible = false;  ///< LAS 1.4 in the clothes of an older version
};

/// The LAS file `from` as LAZ, by LASzip.
inline void compress(const std::filesystem::path& from, const std::filesystem::path& to,
                     const CompressOptions& options = {}) {
  laszip_POINTER reader = nullptr;
  laszip_POINTER writer = nullptr;
  laszip_create(&reader);
  laszip_create(&writer);
  laszip_BOOL compressed = 0;
  laszip_header_struct* header = nullptr;
  laszip_point_struct* point = nullptr;
  bool good = laszip_open_reader(reader, from.c_str(), &compressed) == 0;
  laszip_get_header_pointer(reader, &header);
  laszip_get_point_pointer(reader, &point);
  const std::uint64_t few = header->number_of_point_records;
  const std::uint64_t count = few != 0 ? few : header->extended_number_of_point_records;
  laszip_request_native_extension(writer, options.compatible ? 0 : 1);
  laszip_request_compatibility_mode(writer, options.compatible ? 1 : 0);
  good = good && laszip_set_header(writer, header) == 0;
  laszip_set_chunk_size(writer, options.chunk_rows);
  good = good && laszip_open_writer(writer, to.c_str(), 1) == 0;
  for (std::uint64_t i = 0; good && i < count; ++i)
    good = laszip_read_point(reader) == 0 && laszip_set_point(writer, point) == 0 &&
           laszip_write_point(writer) == 0;
  good = good && laszip_close_writer(writer) == 0;
  if (!good) throw std::runtime_error("LASzip cannot compress " + from.string());
  laszip_close_reader(reader);
  laszip_destroy(reader);
  laszip_destroy(writer);
}

inline RayCloud read_points(const std::filesystem::path& path, unsigned threads = 1,
                            std::size_t chunk_rays = 32768) {
  const auto source = open_las_points(path, {.chunk_rays = chunk_rays});
  return read_all({.threads = threads}, *source);
}

/// An entry of the extra bytes record.
inline std::string extra_entry(std::uint8_t type, const std::string& name, std::uint8_t options = 0,
                               double scale = 0.0, double offset = 0.0) {
  std::string entry(192, '\0');
  put_at(entry, 2, type);
  put_at(entry, 3, options);
  name.copy(entry.data() + 4, 32);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    put_at(entry, 112 + 8 * axis, scale);
    put_at(entry, 136 + 8 * axis, offset);
  }
  return entry;
}

}  // namespace ray::test::las
