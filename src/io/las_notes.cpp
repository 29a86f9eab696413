#include "las_notes.h"

#include <algorithm>
#include <array>
#include <optional>

namespace ray {
namespace {

constexpr std::size_t kMaxName = 32;
constexpr std::array<std::string_view, 5> kOwnExtraBytes{"BeamOriginX", "BeamOriginY", "BeamOriginZ",
                                                         "Bounded", "Alpha"};

void add_line(std::string& text, std::string_view key, std::string_view value) {
  text.append(key).append(" ");
  std::transform(value.begin(), value.end(), std::back_inserter(text),
                 [](char letter) { return letter == '\n' || letter == '\0' ? ' ' : letter; });
  text.append("\n");
}

std::optional<ScalarType> type_named(std::string_view name) {
  for (int i = 0; i <= static_cast<int>(ScalarType::float64); ++i) {
    const auto type = static_cast<ScalarType>(i);
    if (name_of(type) == name) return type;
  }
  return std::nullopt;
}

void parse_line(std::string_view key, std::string_view value, LasNotes& notes) {
  if (key == "raycloud") notes.there = true;
  if (key == "crs") notes.crs = value;
  if (key == "time_base") notes.time_base = value;
  if (key == "history") notes.history.emplace_back(value);
  if (key == "comment") notes.comments.emplace_back(value);
  if (key == "without") (value == "times" ? notes.without_times : notes.without_colours) = true;
  if (key == "column") {
    const std::size_t space = value.find(' ');
    const auto type = type_named(value.substr(0, space));
    if (type && space != value.npos) notes.columns.push_back({std::string(value.substr(space + 1)), *type});
  }
}

}  // namespace

std::string las_notes_text(const CloudInfo& info) {
  std::string text;
  add_line(text, "raycloud", "version 1");
  if (!info.crs.empty()) add_line(text, "crs", info.crs);
  if (!info.time_base.empty()) add_line(text, "time_base", info.time_base);
  if (!info.present.times) add_line(text, "without", "times");
  if (!info.present.colours) add_line(text, "without", "colours");
  for (const std::string& line : info.history)
    add_line(text, "history", line);
  for (const std::string& line : info.comments)
    add_line(text, "comment", line);
  for (const ColumnInfo& column : info.extras)
    add_line(text, "column", std::string(name_of(column.type)) + " " + column.name);
  return text;
}

LasNotes parse_las_notes(std::string_view text) {
  LasNotes notes;
  while (!text.empty()) {
    const std::string_view line = text.substr(0, text.find('\n'));
    text.remove_prefix(std::min(text.size(), line.size() + 1));
    const std::size_t space = line.find(' ');
    if (space != line.npos) parse_line(line.substr(0, space), line.substr(space + 1), notes);
  }
  return notes;
}

std::string extra_bytes_name(const std::vector<ColumnInfo>& columns, std::size_t index) {
  const std::string& name = columns[index].name;
  const bool taken = std::find(kOwnExtraBytes.begin(), kOwnExtraBytes.end(), name) != kOwnExtraBytes.end();
  const bool usable = !name.empty() && name.size() <= kMaxName && !taken && name.find('\0') == name.npos;
  return usable ? name : "raycloud column " + std::to_string(index);
}

}  // namespace ray
