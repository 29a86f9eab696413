#include "file_kind.h"

#include <raycloud/core/error.h>
#include <raycloud/io/las_cloud.h>
#include <raycloud/io/ply_cloud.h>
#include <raycloud/io/ray_cloud_file.h>

namespace ray {

std::unique_ptr<RaySource> open_ray_cloud(const std::filesystem::path& path, const ReadOptions& options) {
  const std::string extension = lower_extension(path);
  if (extension == ".ply") return open_ply(path, options);
  if (extension == ".las" || extension == ".laz") return open_las(path, options);
  throw Error(ErrorCode::wrong_content,
              path.string() + ": not a ray cloud (.ply, .las or .laz): make one with rayimport");
}

std::unique_ptr<RaySink> create_ray_cloud(const std::filesystem::path& path, const CloudInfo& info,
                                          const WriteOptions& options) {
  const bool ply = known_extension(path, {".ply", ".las", ".laz"}) == ".ply";
  return ply ? create_ply(path, info, options) : create_las(path, info, options);
}

}  // namespace ray
