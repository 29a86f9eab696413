#include "cli/output_name.h"

namespace ray::cli {

std::filesystem::path output_name(const std::filesystem::path& input, std::string_view suffix,
                                  std::string_view extension) {
  std::filesystem::path name = input.stem();
  name += suffix;
  name += extension.empty() ? input.extension() : std::filesystem::path(extension);
  return input.parent_path() / name;
}

std::filesystem::path main_output(const Match& match, const std::filesystem::path& input,
                                  std::string_view suffix, std::string_view extension) {
  if (match.has("--output")) return match.text("--output");
  return output_name(input, suffix, extension);
}

}  // namespace ray::cli
