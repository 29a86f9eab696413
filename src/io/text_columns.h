#pragma once
/// What the columns of a text file of points are.

#include <raycloud/core/cloud_info.h>

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace ray::text {

enum class Role { ignored, x, y, z, time, red, green, blue, alpha, start_x, start_y, start_z, extra };

struct TextColumn {
  Role role = Role::ignored;
  std::size_t extra = 0;  ///< index into the extras, for Role::extra
};

struct TextLayout {
  char separator = ' ';
  std::vector<TextColumn> columns;
  double colour_scale = 1.0;     ///< a colour times this is 0 to 255
  std::size_t data_begin = 0;    ///< byte where rows (and comments between them) begin
  std::size_t lines_before = 0;  ///< lines before that byte
  CloudInfo info;
};

/// Learns the layout from the first lines of a file. Throws Error(file_format) if they are not points.
[[nodiscard]] TextLayout find_layout(std::string_view sample, const std::string& name);

}  // namespace ray::text
