#pragma once
/// Rows of an ascii PLY file.

#include "ply_header.h"
#include "ply_rows.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace ray {

/// True if there is nothing but white space.
[[nodiscard]] bool is_blank_line(std::string_view line);

/// Takes the next word off `text`; empty at the end.
[[nodiscard]] std::string_view take_ply_token(std::string_view& text);

/// Writes the value of a word, in this machine's byte order, to `out`. False if it is none of that type.
[[nodiscard]] bool parse_ply_value(std::string_view token, ScalarType type, std::byte* out);

/// Parses the lines of `text` that are not blank into rows of `row_bytes` (ply_schema.h) in this machine's
/// byte order, list properties left out. Numbers may have a plus sign, be nan or inf, and stand in any white
/// space; whole numbers may be written as 255.0. Throws Error(file_format) that names the row, counted from
/// `first_row`, where a value is missing, superfluous, not a number or outside the range of its type.
void parse_ply_lines(std::string_view text, const PlyHeader& header, const PlyRowNames& names,
                     std::uint64_t first_row, std::span<std::byte> rows);

}  // namespace ray
