#include "real_data.h"

#include <cstdlib>
#include <filesystem>

namespace bench {

std::string real_file(const std::string& name) {
  const char* set = std::getenv("RAYCLOUD_TEST_DATA");
  std::filesystem::path folder = set != nullptr ? set : "";
  for (auto above = std::filesystem::current_path(); folder.empty(); above = above.parent_path()) {
    if (std::filesystem::is_directory(above / "shared" / "data")) folder = above / "shared" / "data";
    if (above == above.root_path()) break;
  }
  for (const char* extension : {".ply", ".ply.xz"}) {
    const auto file = folder / (name + extension);
    if (std::filesystem::exists(file)) return file.string();
  }
  return {};
}

std::string printing(const std::string& file) {
  return (file.ends_with(".xz") ? "xz -dc " : "cat ") + file;
}

}  // namespace bench
