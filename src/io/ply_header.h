#pragma once
/// The header of a PLY file: which elements follow, of what, in which encoding.

#include "input_file.h"

#include <raycloud/core/scalar.h>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace ray {

enum class PlyFormat { ascii, little_endian, big_endian };

struct PlyProperty {
  std::string name;
  ScalarType type = ScalarType::float32;  ///< of the value, or of a list's items
  std::optional<ScalarType> list_count;   ///< set for a list: the type of its length
};

struct PlyElement {
  std::string name;
  std::uint64_t count = 0;
  std::vector<PlyProperty> properties;

  [[nodiscard]] bool has_lists() const;
  /// Of one row in a binary file, where a list counts for its length alone.
  [[nodiscard]] std::size_t least_row_bytes() const;
};

struct PlyHeader {
  PlyFormat format = PlyFormat::ascii;
  char line_end = '\n';  ///< '\r' for files of old Macintoshes
  std::vector<PlyElement> elements;
  std::vector<std::string> comments;  ///< the texts of `comment` and `obj_info`, in order
  std::uint64_t bytes = 0;            ///< where the data begins

  /// The index of the element "vertex" in `elements`.
  std::size_t vertex = 0;
};

/// Reads `text`, the first bytes of a file. Nothing where the header goes on beyond it. Throws
/// Error(file_format) that names `path` and the line for whatever is not a PLY header that has a vertex
/// element with properties.
[[nodiscard]] std::optional<PlyHeader> parse_ply_header(std::string_view text, const std::string& path);

/// Reads the header of a file, which may have up to 16 MiB.
[[nodiscard]] PlyHeader read_ply_header(const InputFile& file);

}  // namespace ray
