#include "text_fields.h"
#include "text_file.h"
#include "trajectory_columns.h"

#include <raycloud/core/error.h>
#include <raycloud/io/atomic_file.h>
#include <raycloud/io/ply_cloud.h>
#include <raycloud/io/point_file.h>
#include <raycloud/io/trajectory_file.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace ray {
namespace {

using text::Row;

std::string lower_extension(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  for (char& c : extension)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return extension;
}

std::string counted(std::size_t count, const std::string& one, const std::string& many) {
  return std::to_string(count) + " " + (count == 1 ? one : many);
}

struct Table {
  std::vector<Row> rows;
  std::vector<std::string> heading;
};

[[noreturn]] void fail_line(const std::string& name, std::size_t line, const std::string& what) {
  throw Error(ErrorCode::file_format, name + ": line " + std::to_string(line) + " " + what);
}

std::vector<std::string> names_in(std::string_view line) {
  const auto fields = text::all_fields(line, text::separator_of(line));
  return {fields.begin(), fields.end()};
}

Row row_of(const std::vector<std::string_view>& fields, const std::string& name, std::size_t line) {
  Row row;
  for (const std::string_view field : fields) {
    const auto value = text::number(field);
    if (!value) fail_line(name, line, "has " + text::quoted(field) + " where a number should be");
    row.push_back(*value);
  }
  return row;
}

Table read_table(std::string_view content, const std::string& name) {
  Table table;
  if (content.starts_with("\xEF\xBB\xBF")) content.remove_prefix(3);
  for (std::size_t number = 1; !content.empty(); ++number) {
    const std::string_view line = text::take_line(content);
    if (text::is_blank(line)) continue;
    if (text::is_comment(line)) {
      auto names = names_in(text::comment_text(line));
      if (table.rows.empty() && text::columns_from_names(names)) table.heading = std::move(names);
      continue;
    }
    if (table.rows.empty() && table.heading.empty() && text::columns_from_names(names_in(line))) {
      table.heading = names_in(line);
      continue;
    }
    auto fields = text::all_fields(line, text::separator_of(line));
    if (fields.size() > 1 && fields.back().empty()) fields.pop_back();
    table.rows.push_back(row_of(fields, name, number));
    const std::size_t count = table.rows.front().size();
    if (count < 4)
      fail_line(name, number,
                "has " + counted(count, "number", "numbers") + ", but a trajectory needs time x y z");
    if (fields.size() != count)
      fail_line(name, number,
                "has " + std::to_string(fields.size()) + " of " + std::to_string(count) + " numbers");
  }
  return table;
}

text::TrajectoryColumns columns_of(const Table& table, const std::string& name,
                                   const TrajectoryReadOptions& options) {
  std::optional<text::TrajectoryColumns> columns;
  if (!options.format.empty()) {
    columns = text::columns_from_names(names_in(options.format));
    if (!columns)
      throw Error(ErrorCode::usage, "trajectory format " + text::quoted(options.format) +
                                        " is not like t,x,y,z or t,x,y,z,qw,qx,qy,qz");
    columns->decided_by = "request";
  } else if (!table.heading.empty()) {
    columns = text::columns_from_names(table.heading);
    columns->decided_by = "heading";
  } else {
    columns = text::columns_from_content(table.rows, lower_extension(name) == ".tum");
  }
  const std::size_t count = table.rows.front().size();
  if (text::width_of(*columns) > count)
    throw Error(ErrorCode::file_format, name + ": has " + std::to_string(count) + " columns, but the " +
                                            columns->decided_by + " names " +
                                            std::to_string(text::width_of(*columns)));
  return *columns;
}

bool finite(const Trajectory& path, std::size_t i) {
  const bool place = std::isfinite(path.times[i]) && path.positions[i].allFinite();
  return place && (path.orientations.empty() || path.orientations[i].coeffs().allFinite());
}

Trajectory gather(const Trajectory& path, const std::vector<std::size_t>& order) {
  Trajectory result;
  for (const std::size_t i : order) {
    result.times.push_back(path.times[i]);
    result.positions.push_back(path.positions[i]);
    if (!path.orientations.empty()) result.orientations.push_back(path.orientations[i]);
  }
  return result;
}

// Finite nodes only, in strictly increasing time, with a note on everything that had to be put right.
TrajectoryFile put_right(const Trajectory& raw, const std::string& name, std::vector<std::string> notes) {
  std::vector<std::size_t> order(raw.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::erase_if(order, [&](std::size_t i) { return !finite(raw, i); });
  if (order.empty()) throw Error(ErrorCode::no_data, name + ": has no trajectory nodes");
  if (order.size() < raw.size())
    notes.push_back(counted(raw.size() - order.size(), "node", "nodes") +
                    " left out for a NaN or infinite value");
  const auto earlier = [&](std::size_t a, std::size_t b) { return raw.times[a] < raw.times[b]; };
  if (!std::is_sorted(order.begin(), order.end(), earlier)) {
    std::stable_sort(order.begin(), order.end(), earlier);
    notes.emplace_back("nodes were not in order of time and have been sorted");
  }
  const std::size_t before = order.size();
  const auto same_time = [&](std::size_t a, std::size_t b) { return raw.times[a] == raw.times[b]; };
  order.erase(std::unique(order.begin(), order.end(), same_time), order.end());
  if (order.size() < before)
    notes.push_back(counted(before - order.size(), "node", "nodes") +
                    " merged into an earlier one of the same time");
  if (order.size() == 1) notes.emplace_back("has one node, so only points of exactly its time can be placed");
  return {gather(raw, order), std::move(notes)};
}

TrajectoryFile read_points(const std::filesystem::path& path, const TrajectoryReadOptions& options) {
  const auto source = open_points(path);
  if (!source->info().present.times)
    throw Error(ErrorCode::wrong_content, path.string() + ": is no trajectory: its points have no times");
  Trajectory raw;
  std::size_t dropped = 0;
  RawChunk chunk;
  RayCloud rays;
  while (source->fetch(chunk)) {
    dropped += source->decode(chunk, rays);
    // A ray cloud gives the path of its sensor; of plain points it is they that are the path.
    raw.positions.insert(raw.positions.end(), rays.starts.begin(), rays.starts.end());
    for (const double time : rays.times)
      raw.times.push_back(time * options.time_scale + options.time_offset);
  }
  std::vector<std::string> notes;
  if (dropped > 0)
    notes.push_back(counted(dropped, "node", "nodes") + " left out for a NaN or infinite value");
  return put_right(raw, path.string(), std::move(notes));
}

void append_values(std::string& text, char separator, std::initializer_list<double> values) {
  for (const double value : values)
    text::append_number(text += separator, value);
}

std::string text_of(const Trajectory& path, char separator, bool tum) {
  std::string text;
  for (std::size_t i = 0; i < path.size(); ++i) {
    text::append_number(text, path.times[i]);
    const Eigen::Vector3d& p = path.positions[i];
    append_values(text, separator, {p.x(), p.y(), p.z()});
    const bool turns = !path.orientations.empty();
    const Eigen::Quaterniond q = turns ? path.orientations[i] : Eigen::Quaterniond::Identity();
    if (tum)
      append_values(text, separator, {q.x(), q.y(), q.z(), q.w()});
    else if (turns)
      append_values(text, separator, {q.w(), q.x(), q.y(), q.z()});
    text += '\n';
  }
  return text;
}

void write_ply(const std::filesystem::path& path, const Trajectory& trajectory) {
  CloudInfo info{.ray_count = trajectory.size(), .precision = Precision::double_};
  info.present = {.starts = false, .times = true, .colours = false, .intensity = false};
  const auto sink = create_ply_points(path, info);
  RayCloud nodes;
  nodes.resize(trajectory.size());
  nodes.starts = nodes.ends = trajectory.positions;
  nodes.times = trajectory.times;
  RawChunk raw;
  sink->encode(nodes, raw);
  sink->write(raw);
  sink->finish();
}

}  // namespace

TrajectoryFile parse_trajectory(std::string_view content, const std::string& name,
                                const TrajectoryReadOptions& options) {
  const Table table = read_table(content, name);
  if (table.rows.empty()) throw Error(ErrorCode::no_data, name + ": has no trajectory nodes");
  const text::TrajectoryColumns columns = columns_of(table, name, options);
  const double scale = options.time_scale != 1.0 ? options.time_scale : columns.time_scale;
  Trajectory raw;
  for (const Row& row : table.rows) {
    raw.times.push_back(row[columns.time] * scale + options.time_offset);
    raw.positions.emplace_back(row[columns.position[0]], row[columns.position[1]], row[columns.position[2]]);
    if (!columns.orientation) continue;
    const auto& [w, x, y, z] = *columns.orientation;
    const Eigen::Vector4d coefficients(row[x], row[y], row[z], row[w]);
    raw.orientations.emplace_back(Eigen::Vector4d(coefficients / coefficients.norm()));
  }
  std::vector<std::string> notes;
  if (columns.decided_by != "request")
    notes.push_back("columns are " + text::format_of(columns, table.rows.front().size()) + ", by " +
                    columns.decided_by);
  if (scale != 1.0 && options.time_scale == 1.0)
    notes.emplace_back("times are converted to seconds, as the heading says");
  return put_right(raw, name, std::move(notes));
}

TrajectoryFile read_trajectory(const std::filesystem::path& path, const TrajectoryReadOptions& options) {
  const std::string extension = lower_extension(path);
  if (extension == ".ply" || extension == ".las" || extension == ".laz") return read_points(path, options);
  text::TextFile file(path);
  std::string content;
  for (std::string more = file.read(1 << 20); !more.empty(); more = file.read(1 << 20))
    content += more;
  return parse_trajectory(content, path.string(), options);
}

void write_trajectory(const std::filesystem::path& path, const Trajectory& trajectory) {
  const std::string extension = lower_extension(path);
  if (extension == ".ply") return write_ply(path, trajectory);
  const bool tum = extension == ".tum";
  const bool csv = extension == ".csv";
  if (!tum && !csv && extension != ".txt")
    throw Error(ErrorCode::usage, path.string() + ": trajectories are written to .txt, .csv, .tum or .ply");
  const char separator = csv ? ',' : ' ';
  std::string heading = csv ? "time,x,y,z" : "%time x y z";
  if (!trajectory.orientations.empty()) heading += csv ? ",qw,qx,qy,qz" : " qw qx qy qz";
  if (tum) heading = "# time x y z qx qy qz qw";
  AtomicFile file(path);
  file.write(heading + "\n" + text_of(trajectory, separator, tum));
  file.commit();
}

}  // namespace ray
