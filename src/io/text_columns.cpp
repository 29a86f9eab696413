#include "text_columns.h"

#include "text_fields.h"

#include <raycloud/core/error.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <utility>

namespace ray::text {
namespace {

using Names = std::vector<std::string>;

struct NamedRole {
  std::string_view name;
  Role role;
};

constexpr std::array kRoles{
    NamedRole{"x", Role::x},
    NamedRole{"y", Role::y},
    NamedRole{"z", Role::z},
    NamedRole{"time", Role::time},
    NamedRole{"timestamp", Role::time},
    NamedRole{"gpstime", Role::time},
    NamedRole{"scalargpstime", Role::time},
    NamedRole{"t", Role::time},
    NamedRole{"red", Role::red},
    NamedRole{"green", Role::green},
    NamedRole{"blue", Role::blue},
    NamedRole{"r", Role::red},
    NamedRole{"g", Role::green},
    NamedRole{"b", Role::blue},
    NamedRole{"alpha", Role::alpha},
    NamedRole{"originx", Role::start_x},
    NamedRole{"originy", Role::start_y},
    NamedRole{"originz", Role::start_z},
    NamedRole{"beamoriginx", Role::start_x},
    NamedRole{"beamoriginy", Role::start_y},
    NamedRole{"beamoriginz", Role::start_z},
    NamedRole{"sensorx", Role::start_x},
    NamedRole{"sensory", Role::start_y},
    NamedRole{"sensorz", Role::start_z},
    NamedRole{"startx", Role::start_x},
    NamedRole{"starty", Role::start_y},
    NamedRole{"startz", Role::start_z},
};

struct KnownExtra {
  std::string_view name;
  ColumnInfo column;
};

// What LAS calls these and the types it gives them; normals get a name that is not the ray's own nx ny nz.
const std::vector<KnownExtra>& known_extras() {
  static const std::vector<KnownExtra> known{
      {"intensity", {"intensity", ScalarType::float64}},
      {"scalarintensity", {"intensity", ScalarType::float64}},
      {"classification", {"classification", ScalarType::uint8}},
      {"returnnumber", {"return_number", ScalarType::uint8}},
      {"numberofreturns", {"number_of_returns", ScalarType::uint8}},
      {"userdata", {"user_data", ScalarType::uint8}},
      {"pointsourceid", {"point_source_id", ScalarType::uint16}},
      {"nx", {"normal_x", ScalarType::float64}},
      {"ny", {"normal_y", ScalarType::float64}},
      {"nz", {"normal_z", ScalarType::float64}},
  };
  return known;
}

Role role_of(const std::string& plain) {
  const auto* found =
      std::find_if(kRoles.begin(), kRoles.end(), [&](const NamedRole& r) { return r.name == plain; });
  return found == kRoles.end() ? Role::extra : found->role;
}

bool has_role(const TextLayout& layout, Role role) {
  return std::any_of(layout.columns.begin(), layout.columns.end(),
                     [&](const TextColumn& c) { return c.role == role; });
}

// A name a PLY file can hold, unlike the standard columns and those before it.
std::string extra_name(std::string_view name, const std::vector<ColumnInfo>& extras) {
  std::string clean;
  for (const char c : name)
    clean += c > ' ' && c <= '~' ? c : '_';
  const std::string stem = clean;
  const auto taken = [&] {
    return role_of(plain_name(clean)) != Role::extra ||
           std::any_of(extras.begin(), extras.end(), [&](const ColumnInfo& e) { return e.name == clean; });
  };
  for (int n = 2; taken(); ++n)
    clean = stem + "_" + std::to_string(n);
  return clean;
}

void add_extra(TextLayout& layout, std::string_view name) {
  ColumnInfo column{std::string(name), ScalarType::float64};
  for (const KnownExtra& known : known_extras())
    if (known.name == plain_name(name)) column = known.column;
  column.name = extra_name(column.name, layout.info.extras);
  layout.columns.push_back({Role::extra, layout.info.extras.size()});
  layout.info.extras.push_back(column);
}

void add_column(TextLayout& layout, std::string_view name) {
  const Role role = role_of(plain_name(name));
  if (name.empty()) {
    layout.columns.push_back({Role::ignored});
  } else if (role == Role::extra || has_role(layout, role)) {
    add_extra(layout, name);
  } else {
    layout.columns.push_back({role});
  }
}

// The fields, if three of them are x, y and z.
std::optional<Names> heading_names(std::string_view line) {
  Names names;
  std::string axes;
  for (const std::string_view field : all_fields(line, separator_of(line))) {
    names.emplace_back(field);
    const Role role = role_of(plain_name(field));
    if (role == Role::x || role == Role::y || role == Role::z) axes += plain_name(field);
  }
  std::sort(axes.begin(), axes.end());
  return axes == "xyz" ? std::optional(names) : std::nullopt;
}

// How the numbers of a column are written.
struct Spelling {
  int decimals = -1;  // of all; kDiffer if they differ or have exponents
  int digits = 0;     // most significant ones
};
constexpr int kDiffer = -2;
constexpr int kFloatDigits = 9;  // tell every float from every other

// The numbers of the sample, column by column.
struct Sample {
  std::vector<std::vector<double>> columns;
  std::vector<Spelling> spellings;
};

void note_spelling(Spelling& spelling, std::string_view field) {
  const std::string_view mantissa = field.substr(0, field.find_first_of("eE"));
  const std::size_t point = mantissa.find('.');
  int decimals = point == std::string_view::npos ? 0 : static_cast<int>(mantissa.size() - point - 1);
  if (mantissa.size() < field.size()) decimals = kDiffer;
  spelling.decimals = spelling.decimals == -1 || spelling.decimals == decimals ? decimals : kDiffer;
  const std::size_t first = std::min(mantissa.find_first_of("123456789"), mantissa.size());
  const auto digits = std::count_if(mantissa.begin() + static_cast<std::ptrdiff_t>(first), mantissa.end(),
                                    [](char c) { return c >= '0' && c <= '9'; });
  spelling.digits = std::max(spelling.digits, static_cast<int>(digits));
}

Sample read_sample(std::string_view rows, char separator) {
  Sample sample;
  while (!rows.empty()) {
    const std::string_view line = take_line(rows);
    if (is_blank(line) || is_comment(line)) continue;
    const auto fields = all_fields(line, separator);
    if (sample.columns.empty()) {
      sample.columns.resize(fields.size());
      sample.spellings.resize(fields.size());
    }
    if (fields.size() != sample.columns.size()) break;  // decode names the line
    for (std::size_t i = 0; i < fields.size(); ++i) {
      sample.columns[i].push_back(number(fields[i]).value_or(std::nan("")));
      note_spelling(sample.spellings[i], fields[i]);
    }
  }
  return sample;
}

bool whole_within(const std::vector<double>& values, double high) {
  return std::all_of(values.begin(), values.end(),
                     [&](double v) { return v >= 0.0 && v <= high && v == std::floor(v); });
}

bool like_time(const std::vector<double>& values) {
  const bool rising = std::is_sorted(values.begin(), values.end()) && values.front() < values.back();
  const bool small_whole = std::all_of(values.begin(), values.end(),
                                       [](double v) { return std::abs(v) < 65536.0 && v == std::floor(v); });
  return rising && !small_whole;
}

bool like_colour(const Sample& sample, std::size_t first) {
  if (first + 3 > sample.columns.size()) return false;
  return std::all_of(sample.columns.begin() + static_cast<std::ptrdiff_t>(first),
                     sample.columns.begin() + static_cast<std::ptrdiff_t>(first + 3),
                     [](const auto& values) { return whole_within(values, 255.0); });
}

Names names_from_content(const Sample& sample) {
  const std::size_t count = sample.columns.size();
  Names names{"x", "y", "z"};
  if (names.size() < count && like_time(sample.columns[3])) names.emplace_back("time");
  const bool colour_last = count == names.size() + 4 && like_colour(sample, names.size() + 1);
  if (names.size() < count && (colour_last || !like_colour(sample, names.size())))
    names.emplace_back("intensity");
  if (like_colour(sample, names.size())) names.insert(names.end(), {"red", "green", "blue"});
  while (names.size() < count)
    names.push_back("column_" + std::to_string(names.size() + 1));
  return names;
}

double colour_scale(const TextLayout& layout, const Sample& sample) {
  bool fraction = false;
  double highest = 0.0;
  for (std::size_t i = 0; i < std::min(layout.columns.size(), sample.columns.size()); ++i) {
    const Role role = layout.columns[i].role;
    if (role != Role::red && role != Role::green && role != Role::blue) continue;
    for (const double value : sample.columns[i]) {
      fraction = fraction || value != std::floor(value);
      highest = std::max(highest, value);
    }
  }
  if (highest <= 1.0 && fraction) return 255.0;
  return highest > 255.0 ? 1.0 / 257.0 : 1.0;
}

struct Beginning {
  std::optional<Names> names;
  std::optional<std::uint64_t> count;
};

// Goes over the lines before the first row and leaves `layout.data_begin` there.
Beginning read_beginning(std::string_view sample, TextLayout& layout, const std::string& name) {
  Beginning beginning;
  std::string_view rest = sample;
  if (rest.starts_with("\xEF\xBB\xBF")) rest.remove_prefix(3);
  while (!rest.empty()) {
    const std::string_view before = rest;
    const std::string_view line = take_line(rest);
    if (is_comment(line)) {
      if (const auto names = heading_names(comment_text(line))) beginning.names = names;
    } else if (!is_blank(line)) {
      const auto fields = all_fields(line, separator_of(line));
      const auto first = number(fields.front());
      if (fields.size() == 1 && first && whole_within({*first}, 1e15) && !beginning.count) {
        beginning.count = static_cast<std::uint64_t>(*first);
      } else if (const auto names = heading_names(line)) {
        beginning.names = names;
      } else {
        for (const std::string_view field : fields)
          if (!field.empty() && !number(field))
            throw Error(ErrorCode::file_format,
                        name + ": line " + std::to_string(layout.lines_before + 1) + ": " + quoted(field) +
                            " is neither a number nor part of a heading with x, y and z");
        layout.separator = separator_of(line);
        layout.data_begin = static_cast<std::size_t>(before.data() - sample.data());
        return beginning;
      }
    }
    ++layout.lines_before;
  }
  layout.data_begin = sample.size();
  return beginning;
}

std::string joined(const Names& names) {
  std::string line;
  for (const std::string& name : names)
    line += (line.empty() ? "" : " ") + name;
  return line;
}

// The precision and the step that the spelling of the coordinates shows: more digits than a float needs are a
// double's, and decimals that are the same throughout are a step.
void set_resolution(TextLayout& layout, const Sample& sample) {
  int digits = 0;
  int decimals = -1;
  for (std::size_t i = 0; i < std::min(layout.columns.size(), sample.columns.size()); ++i) {
    const Role role = layout.columns[i].role;
    if (role != Role::x && role != Role::y && role != Role::z) continue;
    digits = std::max(digits, sample.spellings[i].digits);
    const int here = sample.spellings[i].decimals;
    if (role != Role::z) decimals = decimals == -1 || decimals == here ? here : kDiffer;
  }
  layout.info.precision = digits > kFloatDigits ? Precision::double_ : Precision::single;
  if (decimals > 0) layout.info.coordinate_step = std::pow(10.0, -decimals);
}

void set_info(TextLayout& layout, const Sample& sample) {
  CloudInfo& info = layout.info;
  set_resolution(layout, sample);
  info.present.starts =
      has_role(layout, Role::start_x) && has_role(layout, Role::start_y) && has_role(layout, Role::start_z);
  info.present.times = has_role(layout, Role::time);
  info.present.colours =
      has_role(layout, Role::red) && has_role(layout, Role::green) && has_role(layout, Role::blue);
  info.present.intensity = has_role(layout, Role::alpha);
}

}  // namespace

TextLayout find_layout(std::string_view sample_text, const std::string& name) {
  TextLayout layout;
  const Beginning beginning = read_beginning(sample_text, layout, name);
  const Sample sample = read_sample(sample_text.substr(layout.data_begin), layout.separator);
  if (!beginning.names && sample.columns.empty())
    throw Error(ErrorCode::file_format, name + ": holds no points");
  if (!beginning.names && sample.columns.size() < 3)
    throw Error(ErrorCode::file_format, name + ": line " + std::to_string(layout.lines_before + 1) + " has " +
                                            std::to_string(sample.columns.size()) +
                                            " numbers, but a point needs x y z");
  const Names names = beginning.names ? *beginning.names : names_from_content(sample);
  for (const std::string& column : names)
    add_column(layout, column);
  if (!beginning.names && names.size() > 3)
    layout.info.comments.push_back("columns by content: " + joined(names));
  layout.colour_scale = colour_scale(layout, sample);
  layout.info.ray_count = beginning.count;
  set_info(layout, sample);
  return layout;
}

}  // namespace ray::text
