#pragma once
/// A PLY writer for tests that shares no code with the library, and small ways to read files back.

#include <raycloud/core/error.h>
#include <raycloud/core/ray_stream.h>

#include <gtest/gtest.h>

#include <cstdint>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>
#include <string>
#include <vector>

namespace ray::test {

enum class Encoding { ascii, little, big };

struct FixtureProperty {
  std::string type;  ///< any PLY spelling
  std::string name;
  std::string list_count_type;  ///< empty unless a list
};

struct FixtureElement {
  std::string name;
  std::vector<FixtureProperty> properties;
  std::vector<std::vector<std::vector<double>>> rows;  ///< row, property, values: one unless a list
};

struct FixtureFile {
  Encoding encoding = Encoding::little;
  std::string line_end = "\n";
  std::vector<std::string> notes;  ///< whole header lines
  std::vector<FixtureElement> elements;
  std::string blank = " ";  ///< between values of a text
  bool last_line_end = true;
};

inline void put_value(std::string& out, const FixtureFile& file, const std::string& type, double value) {
  const auto raw = [&](auto number) {
    char bytes[sizeof number];
    std::memcpy(bytes, &number, sizeof number);
    for (std::size_t i = 0; i < sizeof number; ++i)
      out += bytes[file.encoding == Encoding::big ? sizeof number - 1 - i : i];
  };
  if (file.encoding == Encoding::ascii) {
    char text[64];
    std::snprintf(text, sizeof text, type.starts_with("float") ? "%.9g" : "%.17g", value);
    out += text + file.blank;
  } else if (type == "char" || type == "int8")
    raw(static_cast<std::int8_t>(value));
  else if (type == "uchar" || type == "uint8")
    raw(static_cast<std::uint8_t>(value));
  else if (type == "short" || type == "int16")
    raw(static_cast<std::int16_t>(value));
  else if (type == "ushort" || type == "uint16")
    raw(static_cast<std::uint16_t>(value));
  else if (type == "int" || type == "int32")
    raw(static_cast<std::int32_t>(value));
  else if (type == "uint" || type == "uint32")
    raw(static_cast<std::uint32_t>(value));
  else if (type == "int64")
    raw(static_cast<std::int64_t>(value));
  else if (type == "uint64")
    raw(static_cast<std::uint64_t>(value));
  else if (type == "float" || type == "float32")
    raw(static_cast<float>(value));
  else
    raw(value);
}

inline std::string header_of(const FixtureFile& file) {
  const char* format = file.encoding == Encoding::ascii    ? "ascii"
                       : file.encoding == Encoding::little ? "binary_little_endian"
                                                           : "binary_big_endian";
  std::string text = "ply" + file.line_end + "format " + format + " 1.0" + file.line_end;
  for (const auto& note : file.notes)
    text += note + file.line_end;
  for (const auto& element : file.elements) {
    text += "element " + element.name + " " + std::to_string(element.rows.size()) + file.line_end;
    for (const auto& property : element.properties) {
      const std::string list =
          property.list_count_type.empty() ? "" : "list " + property.list_count_type + " ";
      text += "property " + list + property.type + " " + property.name + file.line_end;
    }
  }
  return text + "end_header" + file.line_end;
}

inline std::string bytes_of(const FixtureFile& file) {
  std::string out = header_of(file);
  for (const auto& element : file.elements) {
    for (const auto& row : element.rows) {
      for (std::size_t p = 0; p < row.size(); ++p) {
        const FixtureProperty& property = element.properties[p];
        if (!property.list_count_type.empty())
          put_value(out, file, property.list_count_type, static_cast<double>(row[p].size()));
        for (const double value : row[p])
          put_value(out, file, property.type, value);
      }
      if (file.encoding == Encoding::ascii) out += file.line_end;
    }
  }
  if (file.encoding == Encoding::ascii && !file.last_line_end) out.resize(out.size() - file.line_end.size());
  return out;
}

inline void write_file(const std::filesystem::path& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary) << bytes;
}

inline std::string read_file(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

struct ReadBack {
  RayCloud rays;
  std::size_t dropped = 0;
};

/// Times read alone must be those of the rays.
inline ReadBack read_rest(RaySource& source) {
  ReadBack result;
  result.rays.set_schema(source.info().extras);
  RawChunk raw;
  RayCloud chunk;
  std::vector<double> times;
  while (source.fetch(raw)) {
    const std::size_t dropped = source.decode(raw, chunk);
    EXPECT_EQ(source.decode_times(raw, times), dropped);
    EXPECT_EQ(times, chunk.times);
    result.dropped += dropped;
    result.rays.append(chunk);
  }
  return result;
}

inline void write_all(RaySink& sink, const RayCloud& rays) {
  RawChunk raw;
  sink.encode(rays, raw);
  sink.write(raw);
  sink.finish();
}

/// The error that `action` ends with; nothing if it succeeds.
template <class Action>
std::optional<Error> error_of(const Action& action) {
  try {
    action();
  } catch (const Error& error) {
    return error;
  }
  return std::nullopt;
}

inline std::size_t files_in(const std::filesystem::path& folder) {
  return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(folder), {}));
}

}  // namespace ray::test
