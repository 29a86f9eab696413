#include "decimation_note.h"

#include <raycloud/core/error.h>

#include <algorithm>
#include <sstream>
#include <string_view>

namespace ray::tools {
namespace {

constexpr const char* kStart = "decimated ";

std::string centimetres(Metres width) {
  std::ostringstream text;
  text.precision(12);
  text << width.value * 100.0 << " cm";
  return text.str();
}

/// Without the zeros before the number of rays.
std::string readable(std::string note) {
  constexpr std::string_view kOf = " of ";
  const std::size_t of = note.rfind(kOf);
  if (of == std::string::npos) return note;
  const std::size_t digits = of + kOf.size();
  const std::size_t last_digit = std::min(note.find(' ', digits), note.size()) - 1;
  note.erase(digits, std::min(note.find_first_not_of('0', digits), last_digit) - digits);
  return note;
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

std::string decimation_note(const cli::Match& match, std::optional<std::uint64_t> full_rays) {
  constexpr std::size_t kDigits = 12;  // as many as the header of a PLY file has for them
  const std::string count = std::to_string(full_rays.value_or(0));
  const std::string zeros(count.size() < kDigits ? kDigits - count.size() : 0, '0');
  return kStart + form(match) + " of " + zeros + count + " rays";
}

void check_decimation(const CloudInfo& decimated, const std::string& path, const std::string& note) {
  const std::string wanted = readable(note);
  std::optional<std::string> last;
  for (const std::string& line : decimated.comments) {
    if (!line.starts_with(kStart)) continue;
    last = readable(line);
    if (last == wanted) return;
  }
  if (!last) return;
  throw Error(ErrorCode::wrong_content, path + ": was " + *last + ", which cannot be restored as " + wanted);
}

}  // namespace ray::tools
