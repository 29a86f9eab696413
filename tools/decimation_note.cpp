#include "decimation_note.h"

#include <raycloud/core/error.h>

#include <algorithm>
#include <sstream>

namespace ray::tools {
namespace {

constexpr const char* kStart = "decimated ";

std::string centimetres(Metres width) {
  std::ostringstream text;
  text.precision(12);
  text << width.value * 100.0 << " cm";
  return text.str();
}

std::string form(const cli::Match& match) {
  const std::string& usage = match.usage();
  if (usage == "every") return std::to_string(match.integer("N")) + " rays";
  const std::string width = centimetres(match.length("WIDTH"));
  if (usage == "count") return width + " " + std::to_string(match.integer("N")) + " points";
  if (usage == "paths") return width + "/ray";
  return usage == "range" ? width + "/m" : width;
}

}  // namespace

std::string decimation_note(const cli::Match& match, const CloudInfo& full) {
  const std::string start = kStart + form(match);
  return full.ray_count ? start + " of " + std::to_string(*full.ray_count) + " rays" : start;
}

void check_decimation(const CloudInfo& decimated, const std::string& path, const std::string& note) {
  const auto is_note = [](const std::string& line) { return line.starts_with(kStart); };
  const auto& lines = decimated.comments;
  const auto last = std::find_if(lines.rbegin(), lines.rend(), is_note);
  if (last == lines.rend() || std::find(lines.begin(), lines.end(), note) != lines.end()) return;
  throw Error(ErrorCode::wrong_content, path + ": was " + *last + ", which cannot be restored as " + note);
}

}  // namespace ray::tools
