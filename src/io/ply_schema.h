#pragma once
/// What the properties of a PLY vertex mean, whatever their names, types and order.

#include "ply_header.h"

#include <raycloud/core/cloud_info.h>
#include <raycloud/core/column.h>

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace ray {

/// One scalar property in a row of fixed size that holds the scalar properties alone, in order: the row of a
/// binary file without lists; other files are brought to this form (ply_rows.h).
struct PlyField {
  std::string name;
  ScalarType type = ScalarType::float32;
  std::size_t offset = 0;
};

struct PlyLayout {
  std::vector<PlyField> fields;
  std::size_t row_bytes = 0;
  bool big_endian = false;
};

[[nodiscard]] PlyLayout layout_of(const PlyHeader& header);

/// How the caller sees the file.
enum class PlyContent { rays, points };
/// What `nx ny nz` are.
enum class PlyNormals { rays, surface };

struct PlyExtra {
  ColumnInfo info;
  PlyField field;                ///< the low half where there is a high one
  std::optional<PlyField> high;  ///< of a 64-bit integer stored in two halves
};

struct PlySchema {
  std::array<PlyField, 3> end;
  std::optional<std::array<PlyField, 3>> ray;  ///< end to sensor
  bool ray_is_normal = false;                  ///< it is nx ny nz, which might be surface normals
  std::optional<PlyField> time;
  std::optional<std::array<PlyField, 3>> colour;
  std::optional<PlyField> alpha;
  std::vector<PlyExtra> extras;  ///< all others, in file order
};

/// Throws Error(wrong_content) that names `path` if there is no x y z.
[[nodiscard]] PlySchema schema_of(const PlyLayout& layout, PlyContent content, PlyNormals normals,
                                  const std::string& path);

/// What the header says of the whole cloud.
struct PlyNotes {
  CloudInfo info;                  ///< crs, time_base, history and comments
  bool ours = false;               ///< written by this project, so that nx ny nz are rays
  std::array<double, 3> origin{};  ///< to add to coordinates, m
};

/// Throws Error(file_format) that names `path` for a version of the future or a malformed origin.
[[nodiscard]] PlyNotes notes_of(const PlyHeader& header, const std::string& path);

/// All that header and columns tell of the cloud but the number of its rows.
[[nodiscard]] CloudInfo described(const PlyNotes& notes, const PlySchema& schema);

}  // namespace ray
