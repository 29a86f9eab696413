#include "file_kind.h"

#include <raycloud/io/las_cloud.h>
#include <raycloud/io/ply_cloud.h>
#include <raycloud/io/point_file.h>
#include <raycloud/io/text_points.h>

namespace ray {

std::unique_ptr<RaySource> open_points(const std::filesystem::path& path, const ReadOptions& options) {
  const auto kind = known_extension(path, {".ply", ".las", ".laz", ".xyz", ".txt", ".csv", ".asc", ".pts"});
  if (kind == ".ply") return open_ply_points(path, options);
  if (kind == ".las" || kind == ".laz") return open_las_points(path, options);
  return open_text_points(path, options);
}

std::unique_ptr<RaySink> create_points(const std::filesystem::path& path, const CloudInfo& info,
                                       const WriteOptions& options) {
  const auto kind = known_extension(path, {".ply", ".las", ".laz", ".xyz", ".txt", ".csv"});
  if (kind == ".ply") return create_ply_points(path, info, options);
  if (kind == ".las" || kind == ".laz") return create_las_points(path, info, options);
  return create_text_points(path, info, options);
}

}  // namespace ray
