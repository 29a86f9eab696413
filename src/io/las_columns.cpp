#include "las_columns.h"

#include <algorithm>
#include <set>

namespace ray {
namespace {

using Kind = LasColumn::Kind;

std::vector<LasColumn> standard_columns(int format) {
  using enum ScalarType;
  if (format < 6)
    return {{{"intensity", uint16}, Kind::copied, 12, {}},
            {{"return_number", uint8}, Kind::return_number, 14, {}},
            {{"number_of_returns", uint8}, Kind::number_of_returns, 14, {}},
            {{"classification", uint8}, Kind::classification, 15, {}},
            {{"flags", uint8}, Kind::flags, 14, {}},
            {{"scan_angle", float32}, Kind::scan_angle_rank, 16, {}},
            {{"user_data", uint8}, Kind::copied, 17, {}},
            {{"point_source_id", uint16}, Kind::copied, 18, {}}};
  return {{{"intensity", uint16}, Kind::copied, 12, {}},
          {{"return_number", uint8}, Kind::return_number_14, 14, {}},
          {{"number_of_returns", uint8}, Kind::number_of_returns_14, 14, {}},
          {{"classification", uint8}, Kind::copied, 16, {}},
          {{"flags", uint8}, Kind::copied, 15, {}},
          {{"scan_angle", float32}, Kind::scan_angle, 18, {}},
          {{"user_data", uint8}, Kind::copied, 17, {}},
          {{"point_source_id", uint16}, Kind::copied, 20, {}}};
}

void add_waveform_columns(std::size_t at, std::vector<LasColumn>& columns) {
  using enum ScalarType;
  for (const auto& [name, type] : {ColumnInfo{"wave_packet_descriptor_index", uint8},
                                   {"byte_offset_to_waveform_data", uint64},
                                   {"waveform_packet_size", uint32},
                                   {"return_point_waveform_location", float32},
                                   {"parametric_dx", float32},
                                   {"parametric_dy", float32},
                                   {"parametric_dz", float32}}) {
    columns.push_back({{name, type}, Kind::copied, at, {}});
    at += size_of(type);
  }
}

LasColumn column_of(const LasExtraField& field, std::string name) {
  if (field.scaled) return {{std::move(name), ScalarType::float64}, Kind::scaled, field.at, field};
  return {{std::move(name), field.type}, Kind::copied, field.at, field};
}

std::vector<LasColumn> all_columns(const LasHeader& header, const std::vector<LasExtraField>& extra) {
  std::vector<LasColumn> columns = standard_columns(header.format);
  if (header.format == 8 || header.format == 10)
    columns.push_back({{"nir", ScalarType::uint16}, Kind::copied, 36, {}});
  if (header.format == 4 || header.format == 5 || header.format >= 9)
    add_waveform_columns(las_format_length(header.format) - 29, columns);
  std::set<std::string, std::less<>> names;
  for (const LasColumn& column : columns)
    names.insert(column.info.name);
  for (const LasExtraField& field : extra) {
    std::string name = field.name;
    for (int i = 2; names.contains(name); ++i)
      name = field.name + "_" + std::to_string(i);
    names.insert(name);
    columns.push_back(column_of(field, std::move(name)));
  }
  return columns;
}

}  // namespace

std::size_t las_times_at(int format) {
  return format >= 6 ? 22 : format == 0 || format == 2 ? 0 : 20;
}

std::size_t las_colours_at(int format) {
  constexpr std::array<std::size_t, 11> kAt{0, 0, 20, 28, 0, 28, 0, 30, 30, 0, 30};
  return kAt[static_cast<std::size_t>(format)];
}

std::vector<LasColumn> las_columns(const LasHeader& header, const std::vector<LasExtraField>& extra) {
  std::vector<LasColumn> all = all_columns(header, extra);
  if (!header.notes.there) return all;
  std::vector<LasColumn> own;
  const auto standard = standard_columns(header.format);
  for (std::size_t i = 0; i < header.notes.columns.size(); ++i) {
    const ColumnInfo& info = header.notes.columns[i];
    const std::string stored = extra_bytes_name(header.notes.columns, i);
    const auto field =
        std::find_if(extra.begin(), extra.end(), [&](const auto& f) { return f.name == stored; });
    if (field != extra.end()) {
      own.push_back(column_of(*field, info.name));
    } else {
      const auto place =
          std::find_if(standard.begin(), standard.end(), [&](const auto& c) { return c.info == info; });
      if (place == standard.end()) return all;
      own.push_back(*place);
    }
    // Another program has changed the file and kept the notes: they are of no use.
    if (!(own.back().info == info)) return all;
  }
  return own;
}

}  // namespace ray
