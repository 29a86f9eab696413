#include "file_kind.h"

#include <raycloud/core/error.h>

#include <algorithm>

namespace ray {

std::string lower_extension(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  return extension;
}

std::string known_extension(const std::filesystem::path& path,
                            std::initializer_list<std::string_view> known) {
  std::string extension = lower_extension(path);
  if (std::find(known.begin(), known.end(), extension) != known.end()) return extension;
  std::string list;
  for (const auto name : known)
    list.append(" ").append(name);
  const std::string problem =
      extension.empty() ? "a file name needs an extension" : "unknown extension " + extension;
  throw Error(ErrorCode::usage, path.string() + ": " + problem + "; known are" + list);
}

}  // namespace ray
