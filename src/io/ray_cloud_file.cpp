#include "file_kind.h"
#include "input_file.h"

#include <raycloud/core/error.h>
#include <raycloud/io/las_cloud.h>
#include <raycloud/io/ply_cloud.h>
#include <raycloud/io/ray_cloud_file.h>

#include <algorithm>
#include <array>
#include <fstream>

namespace ray {
namespace {

constexpr std::array<std::string_view, 3> kCloudExtensions{".ply", ".las", ".laz"};

bool is_cloud_extension(std::string_view extension) {
  return std::find(kCloudExtensions.begin(), kCloudExtensions.end(), extension) != kCloudExtensions.end();
}

}  // namespace

std::string cloud_format(const std::filesystem::path& path) {
  const std::string extension = lower_extension(path);
  if (is_cloud_extension(extension)) return extension;
  constexpr std::size_t kPointFormat = 104;  // in the header of LAS; LAZ sets its highest bit
  std::array<char, kPointFormat + 1> head{};
  std::ifstream file(path, std::ios::binary);
  file.read(head.data(), head.size());
  const std::string_view start(head.data(), static_cast<std::size_t>(file.gcount()));
  if (start.starts_with("ply\n") || start.starts_with("ply\r")) return ".ply";
  if (!start.starts_with("LASF") || start.size() < head.size()) return {};
  return (static_cast<unsigned char>(head[kPointFormat]) & 0x80) != 0 ? ".laz" : ".las";
}

std::unique_ptr<RaySource> open_ray_cloud(const std::filesystem::path& path, const ReadOptions& options) {
  const std::string extension = cloud_format(path);
  if (extension == ".ply") return open_ply(path, options);
  if (extension == ".las" || extension == ".laz") return open_las(path, options);
  if (path.extension().empty()) const InputFile there(path);  // says what is wrong if it is not
  throw Error(ErrorCode::wrong_content,
              path.string() + ": not a ray cloud (.ply, .las or .laz): make one with rayimport");
}

std::unique_ptr<RaySink> create_ray_cloud(const std::filesystem::path& path, const CloudInfo& info,
                                          const WriteOptions& options) {
  const bool by_name = options.format.empty() || is_cloud_extension(lower_extension(path));
  WriteOptions with = options;
  if (by_name) with.format = known_extension(path, {".ply", ".las", ".laz"});
  return with.format == ".ply" ? create_ply(path, info, with) : create_las(path, info, with);
}

}  // namespace ray
