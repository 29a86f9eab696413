#pragma once
/// Real and odd files that are too large, or not ours, to ship: beside the checkout, where there are any.

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

namespace ray::test {

/// The files of the folder `name` of RAYCLOUD_TEST_DATA, or else of the nearest shared/data above the current
/// folder, by name; none if there is no such folder. A test without them skips and says so.
inline std::vector<std::filesystem::path> shared_files(const std::string& name) {
  std::filesystem::path data;
  if (const char* given = std::getenv("RAYCLOUD_TEST_DATA")) data = given;
  auto above = std::filesystem::current_path();
  while (data.empty() && above.has_relative_path()) {
    if (std::filesystem::is_directory(above / "shared" / "data")) data = above / "shared" / "data";
    above = above.parent_path();
  }
  std::vector<std::filesystem::path> files;
  if (data.empty() || !std::filesystem::is_directory(data / name)) return files;
  for (const auto& entry : std::filesystem::directory_iterator(data / name))
    if (entry.path().extension() != ".tsv") files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

inline constexpr const char* kNoSharedFiles = "no such files: set RAYCLOUD_TEST_DATA";

}  // namespace ray::test
