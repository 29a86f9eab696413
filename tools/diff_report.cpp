#include "diff_report.h"

#include "cli/grouped.h"

#include <nlohmann/json.hpp>

#include <array>
#include <cstdio>
#include <utility>

namespace ray::tools {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::array<std::pair<Difference, const char*>, kDifferences - 1> kKinds{
    {{Difference::same, "same"},
     {Difference::removed, "removed"},
     {Difference::added, "added"},
     {Difference::unobserved, "unobserved"}}};

std::string fixed(const char* pattern, double value) {
  std::array<char, 400> text;
  std::snprintf(text.data(), text.size(), pattern, value);
  return text.data();
}

/// Cells to the right of their columns.
std::string row(const char* name, const std::array<std::string, 3>& cells) {
  constexpr std::array<std::size_t, 3> kWidths{14, 14, 14};
  std::string line = name;
  line.resize(std::max<std::size_t>(line.size(), 12), ' ');
  for (std::size_t i = 0; i < cells.size(); ++i)
    line += std::string(kWidths[i] - std::min(kWidths[i], cells[i].size()), ' ') + cells[i];
  return line + "\n";
}

}  // namespace

std::string as_text(const CloudComparison& comparison) {
  std::string text = "                      rays       area, m2     volume, m3\n";
  for (const auto& [kind, name] : kKinds) {
    const DifferenceTotals& totals = comparison.of(kind);
    text += row(name, {cli::grouped(totals.rays), fixed("%.3f", totals.area), fixed("%.4f", totals.volume)});
  }
  text += "distance    " + fixed("%.4g m", comparison.distance) + "\n";
  text += "similarity  ";
  text += comparison.similarity ? fixed("%.4f", *comparison.similarity)
                                : "unknown: neither cloud saw the places of the other";
  return text + "\n";
}

std::string as_json(const CloudComparison& comparison) {
  Json root;
  for (const auto& [kind, name] : kKinds) {
    const DifferenceTotals& totals = comparison.of(kind);
    root[name] = {{"rays", totals.rays}, {"area", totals.area}, {"volume", totals.volume}};
  }
  root["similarity"] = comparison.similarity ? Json(*comparison.similarity) : Json(nullptr);
  root["distance"] = comparison.distance;
  root["left_out"] = comparison.dropped;
  return root.dump(2) + "\n";
}

}  // namespace ray::tools
