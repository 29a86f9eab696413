#include "info_report.h"

#include <nlohmann/json.hpp>

#include <cstdarg>
#include <cstdio>

namespace ray::tools {

namespace {

using Json = nlohmann::ordered_json;

__attribute__((format(printf, 1, 2))) std::string format(const char* pattern, ...) {
  char text[512];
  va_list arguments;
  va_start(arguments, pattern);
  std::vsnprintf(text, sizeof text, pattern, arguments);
  va_end(arguments);
  return text;
}

std::string grouped(std::uint64_t value) {
  std::string digits = std::to_string(value);
  for (std::size_t i = digits.size(); i > 3; i -= 3)
    digits.insert(i - 3, ",");
  return digits;
}

void line(std::string& text, const char* name, const std::string& value) {
  text += format("%-16s", name) + value + "\n";
}

std::string box(const Bounds& bounds) {
  if (bounds.empty()) return "none";
  const Eigen::Vector3d size = bounds.extent();
  return format("x %.3f to %.3f, y %.3f to %.3f, z %.3f to %.3f (%.3g x %.3g x %.3g m)", bounds.min.x(),
                bounds.max.x(), bounds.min.y(), bounds.max.y(), bounds.min.z(), bounds.max.z(), size.x(),
                size.y(), size.z());
}

std::string spread(const Statistics& values) {
  if (values.count == 0) return "none";
  if (values.constant()) return format("all %.6g", values.min);
  return format("%.6g to %.6g, mean %.6g", values.min, values.max, values.mean);
}

std::string colours(const CloudSummary& summary) {
  if (summary.red.count == 0) return "none";
  if (summary.red.constant() && summary.green.constant() && summary.blue.constant()) {
    return format("all %.0f,%.0f,%.0f", summary.red.min, summary.green.min, summary.blue.min);
  }
  return "red " + spread(summary.red) + "; green " + spread(summary.green) + "; blue " + spread(summary.blue);
}

const char* precision_name(Precision precision) {
  return precision == Precision::single ? "single" : "double";
}

std::string times(const CloudSummary& summary, const CloudInfo& info) {
  if (summary.rays == 0) return "none";
  std::string text = format("%.6f to %.6f s (%.3f s), ", summary.earliest_time, summary.latest_time,
                            summary.latest_time - summary.earliest_time);
  text += summary.in_time_order() ? "in order" : grouped(summary.backward_steps) + " steps backwards";
  if (!info.time_base.empty()) text += ", " + info.time_base;
  return text;
}

Json json(const Statistics& values) {
  if (values.count == 0) return nullptr;
  return {{"min", values.min}, {"mean", values.mean}, {"max", values.max}};
}

Json json(const Bounds& bounds) {
  if (bounds.empty()) return nullptr;
  return {{"min", {bounds.min.x(), bounds.min.y(), bounds.min.z()}},
          {"max", {bounds.max.x(), bounds.max.y(), bounds.max.z()}}};
}

}  // namespace

std::string as_text(const InfoReport& report) {
  const CloudSummary& summary = report.summary;
  std::string text = report.file + "\n";
  const double unbounded_percent =
      summary.rays == 0 ? 0.0
                        : 100.0 * static_cast<double>(summary.unbounded) / static_cast<double>(summary.rays);
  line(text, "rays", grouped(summary.rays));
  line(text, "  bounded", grouped(summary.bounded) + ", range " + spread(summary.bounded_lengths) + " m");
  line(text, "  unbounded", grouped(summary.unbounded) + format(" (%.1f %%)", unbounded_percent));
  if (summary.zero_length > 0) line(text, "  zero length", grouped(summary.zero_length));
  if (summary.dropped > 0)
    line(text, "  left out", grouped(summary.dropped) + " with NaN or infinite values");
  line(text, "surfaces", box(summary.bounded_ends));
  line(text, "all ends", box(summary.ends));
  line(text, "sensor", box(summary.starts));
  line(text, "sensor path", format("%.3f m", summary.path_length.value));
  line(text, "time", times(summary, report.info));
  line(
      text, "point spacing",
      summary.mean_spacing.value > 0.0 ? format("%.4f m on average", summary.mean_spacing.value) : "unknown");
  line(text, "intensity", spread(summary.intensity));
  line(text, "colour", colours(summary));
  for (const ColumnSummary& extra : summary.extras) {
    line(text, "extra column",
         extra.column.name + " (" + std::string(name_of(extra.column.type)) + "): " + spread(extra.values));
  }
  line(text, "precision", precision_name(report.info.precision));
  line(text, "crs", report.info.crs.empty() ? "unknown" : report.info.crs);
  for (const std::string& step : report.info.history)
    line(text, "history", step);
  for (const std::string& comment : report.info.comments)
    line(text, "comment", comment);
  if (report.checked && report.findings.empty()) line(text, "check", "the sensor positions look right");
  for (const std::string& finding : report.findings)
    line(text, "check", finding);
  return text;
}

std::string as_json(const InfoReport& report) {
  const CloudSummary& summary = report.summary;
  Json root;
  root["file"] = report.file;
  root["rays"] = summary.rays;
  root["bounded"] = summary.bounded;
  root["unbounded"] = summary.unbounded;
  root["zero_length"] = summary.zero_length;
  root["left_out"] = summary.dropped;
  root["range"] = json(summary.bounded_lengths);
  root["surfaces"] = json(summary.bounded_ends);
  root["ends"] = json(summary.ends);
  root["starts"] = json(summary.starts);
  root["path_length"] = summary.path_length.value;
  root["time"] =
      summary.rays == 0 ? Json(nullptr) : Json{{"min", summary.earliest_time}, {"max", summary.latest_time}};
  root["time_backward_steps"] = summary.backward_steps;
  root["time_base"] = report.info.time_base;
  root["point_spacing"] = summary.mean_spacing.value;
  root["intensity"] = json(summary.intensity);
  root["red"] = json(summary.red);
  root["green"] = json(summary.green);
  root["blue"] = json(summary.blue);
  root["extra_columns"] = Json::array();
  for (const ColumnSummary& extra : summary.extras) {
    root["extra_columns"].push_back({{"name", extra.column.name},
                                     {"type", std::string(name_of(extra.column.type))},
                                     {"values", json(extra.values)}});
  }
  root["precision"] = precision_name(report.info.precision);
  root["crs"] = report.info.crs;
  root["history"] = report.info.history;
  root["comments"] = report.info.comments;
  if (report.checked) root["findings"] = report.findings;
  // Names and comments come from files of any encoding; what is not UTF-8 is replaced rather than refused.
  return root.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace ray::tools
