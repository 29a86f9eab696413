#include "ply_schema.h"

#include <raycloud/core/error.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string_view>
#include <unordered_map>
#include <unordered_set>
#include <utility>

namespace ray {
namespace {

std::string lower_case(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  return text;
}

/// The fields that have no meaning yet; taking one gives it its meaning.
class Fields {
 public:
  explicit Fields(const std::vector<PlyField>& fields) : fields_(fields), taken_(fields.size(), false) {
    for (std::size_t i = 0; i < fields.size(); ++i) {
      by_name_.emplace(fields[i].name, i);
      by_lower_name_.emplace(lower_case(fields[i].name), i);
    }
  }

  /// By exact name, else by name without regard to capitals. Precondition: `name` is in lower case.
  std::optional<std::size_t> find(std::string_view name) const {
    for (const auto* names : {&by_name_, &by_lower_name_}) {
      const auto found = names->find(std::string(name));
      if (found != names->end() && !taken_[found->second]) return found->second;
    }
    return std::nullopt;
  }

  [[nodiscard]] bool has(const std::string& name) const { return by_name_.contains(name); }

  PlyField take(std::size_t index) {
    taken_[index] = true;
    return fields_[index];
  }

  std::optional<PlyField> take_one(std::initializer_list<std::string_view> names) {
    for (const auto name : names) {
      if (const auto index = find(name)) return take(*index);
    }
    return std::nullopt;
  }

  /// All three or none.
  std::optional<std::array<PlyField, 3>> take_three(const std::array<std::string_view, 3>& names) {
    const auto a = find(names[0]), b = find(names[1]), c = find(names[2]);
    if (!a || !b || !c) return std::nullopt;
    return std::array{take(*a), take(*b), take(*c)};
  }

  [[nodiscard]] bool taken(std::size_t index) const { return taken_[index]; }

 private:
  const std::vector<PlyField>& fields_;
  std::vector<bool> taken_;
  std::unordered_map<std::string, std::size_t> by_name_;
  std::unordered_map<std::string, std::size_t> by_lower_name_;
};

/// The 64-bit column that two neighbours are the halves of.
std::optional<ColumnInfo> joined(const PlyField& low, const PlyField& high) {
  constexpr std::string_view kLow = "__low";
  if (!low.name.ends_with(kLow) || low.type != ScalarType::uint32) return std::nullopt;
  std::string name = low.name.substr(0, low.name.size() - kLow.size());
  if (name.empty() || high.name != name + "__high") return std::nullopt;
  if (high.type == ScalarType::uint32) return ColumnInfo{std::move(name), ScalarType::uint64};
  if (high.type == ScalarType::int32) return ColumnInfo{std::move(name), ScalarType::int64};
  return std::nullopt;
}

/// The name by which this project knows an extra column. Names that mean a standard column are kept for
/// those: a surface normal must not be mistaken for a ray when the cloud is written.
std::string column_name(const std::string& name, PlyContent content) {
  const std::string lower = lower_case(name);
  if (lower == "nx" || lower == "ny" || lower == "nz") return std::string("normal_") + lower[1];
  if (lower == "red" || lower == "green" || lower == "blue") return "lone_" + lower;
  if (content == PlyContent::points && (lower == "intensity" || lower == "scalar_intensity"))
    return "intensity";
  return name;
}

void rename_columns(std::vector<PlyExtra>& extras, PlyContent content) {
  std::unordered_set<std::string> names;
  for (const PlyExtra& extra : extras)
    names.insert(extra.info.name);
  for (PlyExtra& extra : extras) {
    std::string name = column_name(extra.info.name, content);
    if (names.insert(name).second) extra.info.name = std::move(name);
  }
}

bool starts_with_word(std::string_view text, std::string_view word) {
  return text.starts_with(word) && (text.size() == word.size() || text[word.size()] == ' ');
}

std::array<double, 3> parse_origin(std::string_view text, const std::string& path) {
  std::array<double, 3> origin{};
  const char* next = text.data();
  const char* const end = text.data() + text.size();
  for (double& value : origin) {
    while (next != end && (*next == ' ' || *next == '\t'))
      ++next;
    if (next != end && *next == '+') ++next;
    const auto [rest, error] = std::from_chars(next, end, value);
    if (error != std::errc() || !std::isfinite(value)) {
      throw Error(ErrorCode::file_format, path + ": comment origin needs three numbers, not '" +
                                              std::string(text.substr(0, 60)) + "'");
    }
    next = rest;
  }
  return origin;
}

}  // namespace

PlyLayout layout_of(const PlyHeader& header) {
  PlyLayout layout;
  // Text is turned into rows of this machine's own byte order.
  layout.big_endian = header.format == PlyFormat::big_endian;
  for (const PlyProperty& property : header.elements[header.vertex].properties) {
    if (property.list_count) continue;
    layout.fields.push_back({property.name, property.type, layout.row_bytes});
    layout.row_bytes += size_of(property.type);
  }
  return layout;
}

PlySchema schema_of(const PlyLayout& layout, PlyContent content, PlyNormals normals,
                    const std::string& path) {
  Fields fields(layout.fields);
  PlySchema schema;
  auto end = fields.take_three({"x", "y", "z"});
  if (!end) throw Error(ErrorCode::wrong_content, path + ": its vertices have no x, y and z");
  schema.end = *std::move(end);
  schema.ray = fields.take_three({"rayx", "rayy", "rayz"});
  if (!schema.ray && normals == PlyNormals::rays) {
    schema.ray = fields.take_three({"nx", "ny", "nz"});
    schema.ray_is_normal = schema.ray.has_value();
  }
  schema.time = fields.take_one({"time", "timestamp", "gps_time", "gpstime", "scalar_time",
                                 "scalar_timestamp", "scalar_gpstime", "scalar_gps_time", "time_stamp"});
  // Beside an s, t is a texture coordinate.
  if (!schema.time && !fields.find("s")) schema.time = fields.take_one({"t"});
  schema.colour = fields.take_three({"red", "green", "blue"});
  if (!schema.colour) schema.colour = fields.take_three({"diffuse_red", "diffuse_green", "diffuse_blue"});
  if (!schema.colour) schema.colour = fields.take_three({"r", "g", "b"});
  schema.alpha = fields.take_one({"alpha"});
  for (std::size_t i = 0; i < layout.fields.size(); ++i) {
    if (fields.taken(i)) continue;
    const PlyField& field = layout.fields[i];
    if (i + 1 < layout.fields.size() && !fields.taken(i + 1)) {
      auto whole = joined(field, layout.fields[i + 1]);
      if (whole && !fields.has(whole->name)) {
        schema.extras.push_back({*std::move(whole), field, fields.take(i + 1)});
        continue;
      }
    }
    schema.extras.push_back({{field.name, field.type}, field, std::nullopt});
  }
  rename_columns(schema.extras, content);
  return schema;
}

PlyNotes notes_of(const PlyHeader& header, const std::string& path) {
  PlyNotes notes;
  const auto text_after = [](std::string_view comment, std::string_view word) {
    return std::string(comment.substr(std::min(comment.size(), word.size() + 1)));
  };
  for (const std::string& comment : header.comments) {
    if (comment == "raycloud version 1") {
      notes.ours = true;
    } else if (comment.starts_with("raycloud version ")) {
      throw Error(ErrorCode::file_format,
                  path + ": written by a later release (" + comment.substr(0, 40) + ")");
    } else if (starts_with_word(comment, "crs") && notes.info.crs.empty()) {
      notes.info.crs = text_after(comment, "crs");
    } else if (starts_with_word(comment, "time_base") && notes.info.time_base.empty()) {
      notes.info.time_base = text_after(comment, "time_base");
    } else if (starts_with_word(comment, "history")) {
      notes.info.history.push_back(text_after(comment, "history"));
    } else if (starts_with_word(comment, "origin") && comment.size() > 6) {
      notes.origin = parse_origin(std::string_view(comment).substr(6), path);
    } else {
      notes.info.comments.push_back(comment);
    }
  }
  return notes;
}

CloudInfo described(const PlyNotes& notes, const PlySchema& schema) {
  const auto is_wide = [](const PlyField& field) {
    return field.type != ScalarType::float32 && size_of(field.type) > 2;
  };
  const bool moved = notes.origin != std::array<double, 3>{};
  const bool wide = moved || std::any_of(schema.end.begin(), schema.end.end(), is_wide) ||
                    (schema.ray && std::any_of(schema.ray->begin(), schema.ray->end(), is_wide));
  CloudInfo info = notes.info;
  info.precision = wide ? Precision::double_ : Precision::single;
  for (const PlyExtra& extra : schema.extras)
    info.extras.push_back(extra.info);
  const bool has_intensity = std::any_of(info.extras.begin(), info.extras.end(),
                                         [](const ColumnInfo& column) { return column.name == "intensity"; });
  info.present.starts = schema.ray.has_value();
  info.present.times = schema.time.has_value();
  info.present.colours = schema.colour.has_value();
  info.present.intensity =
      schema.alpha.has_value() && (schema.ray.has_value() || !has_intensity || !info.history.empty());
  return info;
}

}  // namespace ray
