#pragma once
/// What a file of this project says in its VLRs of user id "raycloud", which LAS has no other place for:
/// lines of text, cut into records 1, 2 … where they are long.

#include <raycloud/core/cloud_info.h>

#include <string>
#include <string_view>
#include <vector>

namespace ray {

struct LasNotes {
  bool there = false;  ///< the file is one of this project's
  std::string crs;
  std::string time_base;
  std::vector<std::string> history;
  std::vector<std::string> comments;
  std::vector<ColumnInfo> columns;  ///< the extra columns, in order
  bool without_times = false;
  bool without_colours = false;
};

[[nodiscard]] std::string las_notes_text(const CloudInfo& info);
/// Lines it does not know are left out.
[[nodiscard]] LasNotes parse_las_notes(std::string_view text);

/// The name of the extra bytes that hold column `index`: its own, unless that is too long for LAS or taken.
[[nodiscard]] std::string extra_bytes_name(const std::vector<ColumnInfo>& columns, std::size_t index);

}  // namespace ray
