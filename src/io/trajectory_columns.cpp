#include "trajectory_columns.h"

#include "text_fields.h"

#include <algorithm>
#include <cmath>

namespace ray::text {
namespace {

constexpr std::string_view kAxes = "wxyz";

bool contains_any(std::string_view text, std::initializer_list<std::string_view> parts) {
  return std::any_of(parts.begin(), parts.end(),
                     [&](std::string_view part) { return text.find(part) != std::string_view::npos; });
}

bool is_time(std::string_view name) {
  return name == "t" || name == "stamp" || name == "sec" || name == "seconds" || name.starts_with("time") ||
         name.starts_with("gpstime");
}

// Index into kAxes of what the name is a component of, if it is one of a quaternion (or of a position).
std::optional<std::size_t> axis_of(std::string_view name, bool quaternion) {
  if (name.empty()) return std::nullopt;
  const std::size_t axis = kAxes.find(name.back());
  if (axis == std::string_view::npos) return std::nullopt;
  const std::string_view stem = name.substr(0, name.size() - 1);
  const bool turns = stem.starts_with('q') || contains_any(stem, {"quat", "orient", "rot"});
  const bool moves =
      stem.empty() || stem == "p" || stem == "t" || stem.starts_with("prs") || contains_any(stem, {"pos"});
  if (quaternion ? !turns : (turns || !moves || axis == 0)) return std::nullopt;
  return axis;
}

double unit_scale(const std::string& name) {
  if (contains_any(name, {"[ns]", "(ns)", "_ns", "nsec", "nanosec"})) return 1e-9;
  if (contains_any(name, {"[us]", "(us)", "_us", "usec", "microsec"})) return 1e-6;
  if (contains_any(name, {"[ms]", "(ms)", "_ms", "msec", "millisec"})) return 1e-3;
  return 1.0;
}

bool rises(const std::vector<Row>& rows, std::size_t column) {
  for (std::size_t i = 1; i < rows.size(); ++i)
    if (!(rows[i][column] >= rows[i - 1][column])) return false;
  return rows.back()[column] > rows.front()[column];
}

bool unit_length(const std::vector<Row>& rows, std::size_t first) {
  return std::all_of(rows.begin(), rows.end(), [&](const Row& row) {
    double squared = 0.0;
    for (std::size_t i = first; i < first + 4; ++i)
      squared += row[i] * row[i];
    return std::abs(std::sqrt(squared) - 1.0) < 1e-3;
  });
}

// Which end of the quaternion is w: the one that leaves less tilt, 1 − cos = 2 (x² + y²), over all rows.
bool more_level_with_w_last(const std::vector<Row>& rows, std::size_t first) {
  std::array<double, 4> squares{};
  for (const Row& row : rows)
    for (std::size_t i = 0; i < 4; ++i)
      squares[i] += row[first + i] * row[first + i];
  if (squares[0] != squares[2]) return squares[0] < squares[2];
  return squares[3] > squares[0];
}

}  // namespace

std::optional<TrajectoryColumns> columns_from_names(const std::vector<std::string>& names) {
  TrajectoryColumns columns;
  bool has_time = false;
  unsigned position = 0;
  unsigned orientation = 0;
  std::array<std::size_t, 4> quaternion{};
  for (std::size_t i = 0; i < names.size(); ++i) {
    const std::string plain = plain_name(names[i]);
    if (!has_time && is_time(plain)) {
      has_time = true;
      columns.time = i;
      columns.time_scale = unit_scale(names[i]);
    } else if (const auto turn = axis_of(plain, true)) {
      quaternion[*turn] = i;
      orientation |= 1u << *turn;
    } else if (const auto move = axis_of(plain, false); move && (position >> *move & 1u) == 0) {
      columns.position[*move - 1] = i;
      position |= 1u << *move;
    }
  }
  if (!has_time || position != 0b1110u) return std::nullopt;
  if (orientation == 0b1111u) columns.orientation = quaternion;
  return columns;
}

TrajectoryColumns columns_from_content(const std::vector<Row>& rows, bool w_last) {
  TrajectoryColumns columns;
  columns.decided_by = "content";
  const std::size_t count = rows.front().size();
  if (count == 4 && !rises(rows, 0) && rises(rows, 3)) {
    columns.time = 3;
    columns.position = {0, 1, 2};
    return columns;
  }
  columns.position = {1, 2, 3};
  for (std::size_t first = 4; first + 4 <= count; ++first) {
    if (!unit_length(rows, first)) continue;
    const bool last = w_last || more_level_with_w_last(rows, first);
    columns.orientation = last ? std::array{first + 3, first, first + 1, first + 2}
                               : std::array{first, first + 1, first + 2, first + 3};
    break;
  }
  return columns;
}

std::string format_of(const TrajectoryColumns& columns, std::size_t count) {
  std::vector<std::string> names(count, "-");
  names[columns.time] = "t";
  for (std::size_t i = 0; i < 3; ++i)
    names[columns.position[i]] = std::string(1, kAxes[i + 1]);
  if (columns.orientation)
    for (std::size_t i = 0; i < 4; ++i)
      names[(*columns.orientation)[i]] = std::string("q") + kAxes[i];
  while (names.back() == "-")
    names.pop_back();
  std::string format;
  for (const std::string& name : names)
    format += (format.empty() ? "" : ",") + name;
  return format;
}

std::size_t width_of(const TrajectoryColumns& columns) {
  std::size_t most =
      std::max(columns.time, *std::max_element(columns.position.begin(), columns.position.end()));
  if (columns.orientation)
    most = std::max(most, *std::max_element(columns.orientation->begin(), columns.orientation->end()));
  return most + 1;
}

}  // namespace ray::text
